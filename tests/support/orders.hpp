// SPDX-License-Identifier: Apache-2.0
// Orders in which points may be handed over. The mesh must not depend on them.
#pragma once

#include "tests/support/families.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace cadt::test {

struct PointOrder {
  std::string_view name;
  /// Element i of the result is the index in `xy` of the point that comes i-th.
  std::vector<std::size_t> (*of)(const Points& xy);
};

/// random; sorted and reversed (by x, then y); hilbert; radial (from the middle outwards).
[[nodiscard]] const std::vector<PointOrder>& point_orders();

/// With the corners of a triangle in front that all points are inside of: whoever inserts in this order has them all in
/// one triangle. Empty if such corners would be larger than the largest double, or there are no points.
[[nodiscard]] Points inside_first_triangle(const Points& xy);

}  // namespace cadt::test
