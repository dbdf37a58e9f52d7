// SPDX-License-Identifier: Apache-2.0
#include "common/overlay/growth_snapshots.hpp"

#include <algorithm>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

GrowthSnapshots::GrowthSnapshots(Device& device, const SortedPoints& order)
    : device_(device), input_ids_(order.distinct) {
  device_.read(*order.input_ids, 0, input_ids_.data(), input_ids_.size() * sizeof input_ids_[0]);
}

void GrowthSnapshots::show(const Buffer& locked, const std::function<void(const Snapshot&)>& watch) {
  std::vector<cadt_locked_triangle> all(2 * input_ids_.size());
  device_.read(locked, 0, all.data(), all.size() * sizeof all[0]);
  std::vector<std::int32_t> triangles;
  std::size_t live = 0;
  for (const cadt_locked_triangle& triangle : all) {
    if (triangle.word[CADT_WORD_LOCK] == 0) continue;
    ++live;
    if (std::find(triangle.word, triangle.word + 3, CADT_GHOST) != triangle.word + 3) continue;
    for (int k = 0; k < 3; ++k) triangles.push_back(static_cast<std::int32_t>(input_ids_[triangle.word[k]]));
  }
  watch({live / 2 + 1, triangles});  // with ghosts, n points have 2n - 2 triangles
}

}  // namespace cadt
