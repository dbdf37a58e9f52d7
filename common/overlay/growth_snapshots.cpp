// SPDX-License-Identifier: Apache-2.0
#include "common/overlay/growth_snapshots.hpp"

#include <algorithm>
#include <vector>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

void show_snapshot(Context& ctx, const Allocation& locked, const SortedPoints& order) {
  const auto input_ids = ctx.device.read_values<std::int32_t>(*order.input_ids, order.distinct);
  std::vector<std::int32_t> triangles;
  std::size_t live = 0;
  for (const auto& triangle : ctx.device.read_values<cadt_locked_triangle>(*locked, 2 * order.distinct)) {
    if (triangle.word[CADT_WORD_LOCK] == 0) continue;
    ++live;
    if (std::find(triangle.word, triangle.word + 3, CADT_GHOST) != triangle.word + 3) continue;
    for (int k = 0; k < 3; ++k) triangles.push_back(input_ids[triangle.word[k]]);
  }
  ctx.options.tuning.watch({live / 2 + 1, triangles});  // with ghosts, n points have 2n - 2 triangles
}

}  // namespace cadt
