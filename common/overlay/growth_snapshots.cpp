// SPDX-License-Identifier: Apache-2.0
#include "common/overlay/growth_snapshots.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

std::size_t counted_lost_locks(const Options& options, const SortedPoints& order) noexcept {
  const bool timed = narrow_variant(options.statistics) == KernelVariant::timed && !order.wide;
  return options.tuning.watch && timed ? 2 * order.distinct : 0;
}

void show_snapshot(Context& ctx, const Allocation& locked, const SortedPoints& order, const Counters& counters,
                   Snapshot snapshot) {
  const auto input_ids = ctx.device.read_values<std::int32_t>(*order.input_ids, order.distinct);
  const std::vector<std::uint32_t> lost_of_slot = counters.lost_locks();
  std::vector<std::int32_t> triangles;
  std::vector<std::uint32_t> flips, changes, lost_locks;
  std::size_t live = 0, slot = 0;
  for (const auto& triangle : ctx.device.read_values<cadt_locked_triangle>(*locked, 2 * order.distinct)) {
    const std::size_t here = slot++;
    if (triangle.word[CADT_WORD_LOCK] == 0) continue;
    ++live;
    if (std::find(triangle.word, triangle.word + 3, CADT_GHOST) != triangle.word + 3) continue;
    std::uint32_t flips_of_edges = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      triangles.push_back(input_ids[triangle.word[k]]);
      flips_of_edges += triangle.word[CADT_WORD_FLIPS] >> (10 * k) & 1023;  // locked_mesh.dev.h
    }
    flips.push_back(flips_of_edges);
    changes.push_back(triangle.word[CADT_WORD_LOCK] / 2 - 1);  // a new triangle has version 2, each change adds 2
    if (!lost_of_slot.empty()) lost_locks.push_back(lost_of_slot[here]);
  }
  snapshot.points = live / 2 + 1;  // with ghosts, n points have 2n - 2 triangles
  snapshot.triangles = triangles;
  snapshot.flips = flips;
  snapshot.changes = changes;
  snapshot.lost_locks = lost_locks;
  snapshot.statistics = ctx.statistics;
  snapshot.statistics.certified = snapshot.complete && ctx.statistics.certified;
  counters.collect(snapshot.statistics);
  ctx.options.tuning.watch(snapshot);
}

}  // namespace cadt
