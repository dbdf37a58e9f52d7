// SPDX-License-Identifier: Apache-2.0
#include "bench/bandwidth.hpp"

#include "common/driver/launcher.hpp"
#include "common/driver/registry.hpp"

#include <algorithm>
#include <cstdint>

namespace cadt::bench {

double copy_bandwidth(const Options& options, std::size_t bytes) {
  constexpr int runs = 10;  // the first ones find cold pages and a slow clock
  constexpr std::size_t point = 16, word = 4;
  Options timed = options;
  timed.tuning.kernel_times = true;
  const std::unique_ptr<Device> device = open_device(timed);
  const std::size_t most = std::min<std::size_t>(device->free_bytes() / 4, device->info().largest_buffer_bytes);
  bytes = std::max(std::min(bytes, most) / point, std::size_t{1}) * point;
  Memory memory(*device, false);
  Launcher launch(*device, memory, 0);
  const Allocation from = memory.allocate(bytes), to = memory.allocate(bytes);
  for (const Allocation* buffer : {&from, &to}) device->fill(**buffer, 0, bytes, 1);  // so that there are pages
  double best = 0;
  for (int run = 0; run < runs; ++run) {
    launch.run<KernelId::cadt_copy_words>(from, to, 0U, launch.grid(bytes / word));
    launch.run<KernelId::cadt_import_doubles>(from, from, 0U, 1U, 2U, Allocation(), 1.0, 1.0, to,
                                              launch.grid(bytes / point));
    for (const KernelTime& kernel : launch.kernel_times())
      best = std::max(best, 2e3 * static_cast<double>(bytes) / std::max(kernel.milliseconds, 1e-6));
  }
  return best;
}

}  // namespace cadt::bench
