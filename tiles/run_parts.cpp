// SPDX-License-Identifier: Apache-2.0
#include "tiles/run_parts.hpp"

#include <cadt/errors.hpp>

#include "tiles/machine.hpp"
#include "tiles/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace cadt::tiles {

unsigned threads_of(const RunOptions& options) { return options.devices.empty() ? 0 : options.devices.front().threads; }

bool takes_arrays(const RunOptions& options) { return !options.output.empty() || options.collect; }

Options device_options(Options chosen, const RunOptions& options, cadt::stop_token stop) {
  // Without arrays on the host nobody sees the order.
  chosen.order = takes_arrays(options) || options.consumer ? Order::canonical : Order::fast;
  chosen.keep_points = KeepPoints::no;
  chosen.stop = std::move(stop);
  return chosen;
}

TreePass plan_pass(const PointSource& source, std::uint64_t begin, std::uint64_t end, const RunOptions& options,
                   const TreeBuilder& builder, Hash128* content, const std::function<void(std::uint64_t)>& progress) {
  const unsigned threads = threads_for((end - begin + block_points - 1) / block_points, threads_of(options));
  PerThread<TreePass> passes(threads, [&] { return builder.new_pass(); });
  std::vector<Hash128> hashes(threads);
  std::atomic<std::uint64_t> done{0};
  BlockWork work;
  work.look = [&](unsigned thread, std::uint64_t first, std::span<const double> xy) {
    if (content != nullptr) add_block_hash(hashes[thread], first, xy);
    if (!builder.done()) builder.look_at(passes.of(thread), first, xy);
    done += xy.size() / 2;
    if (thread == 0) progress(done);
  };
  each_block(source, begin, end, threads, options.stop, work);
  if (content != nullptr)
    for (const Hash128& hash : hashes) content->high += hash.high, content->low += hash.low;
  TreePass sum = builder.new_pass();
  passes.each([&](const TreePass& pass) { sum += pass; });
  return sum;
}

std::uint64_t leaf_memory(const PointSource& source, const RunOptions& options, unsigned writers) {
  constexpr std::uint64_t read_bytes = 24;  // of a point
  const std::uint64_t points = std::min(source.size(), options.tile_points), devices = options.devices.size();
  const std::uint64_t written = takes_arrays(options) ? devices + std::max<std::uint64_t>(devices, writers) : 0;
  return points * (devices * 2 * read_bytes + written * written_bytes);
}

std::uint64_t shuffle_memory(const RunOptions& options, std::uint64_t available, std::uint64_t leaves) {
  if (options.host_memory != 0) return options.host_memory;
  return available > leaves ? std::max<std::uint64_t>((available - leaves) / 2, 1) : 1;
}

void require_tile_points(const RunOptions& options) {
  if (options.tile_points > max_points())
    throw LimitError("a tile takes at most as many points as one triangulation: make --tile-points smaller",
                     static_cast<std::size_t>(options.tile_points), max_points());
}

std::uint64_t output_bytes(const PointSource& source, const RunOptions& options) {
  if (options.output.empty()) return 0;
  const std::uint64_t there = options.resume ? bytes_in_folder(options.output) : 0;
  const std::uint64_t written = directory_bytes(source.size());
  return written > there ? written - there : 0;
}

NodeReport report_of(const NodeRecord& record) {
  return {.times = {},
          .points = record.sums.points,
          .triangles = record.triangles,
          .open = record.open,
          .device = 0,
          .resumed = true,
          .statistics = {}};
}

}  // namespace cadt::tiles
