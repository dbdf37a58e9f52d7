// SPDX-License-Identifier: Apache-2.0
#include "device_options.hpp"

#include "numbers.hpp"
#include "text.hpp"

namespace cadt::cli {

void add_device_options(CLI::App& command, DeviceOptions& o) {
  command
      .add_option("--backend", o.backend,
                  "where to compute: auto, host, opencl or cuda (default: auto, the fastest usable)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "host", "opencl", "cuda"}).description(""));
  command
      .add_option("--device", o.device, "device of the back end, its number or a part of its name (see: cadt devices)")
      ->type_name("DEVICE");
  command.add_option("--threads", o.threads, "host threads; 0 takes all cores (default: 0)")
      ->type_name("N")
      ->transform(whole_number(0, 4096));
}

void add_memory_option(CLI::App& command, DeviceOptions& o) {
  command
      .add_option("--max-memory", o.max_memory,
                  "refuse if more device memory is needed: 4G, 512M, 1.5GiB "
                  "(K M G T and KiB ... count 1024, KB ... 1000)")
      ->type_name("SIZE");
}

Options library_options(const DeviceOptions& o) {
  Options options;
  options.backend = backend_from_string(o.backend);
  options.device = o.device;
  options.threads = o.threads;
  if (!o.max_memory.empty()) options.max_memory = parse_bytes(o.max_memory);
  return options;
}

}  // namespace cadt::cli
