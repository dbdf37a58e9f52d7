// SPDX-License-Identifier: Apache-2.0
#include "rectangle.hpp"

#include "failure.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace cadt::cli {

std::optional<Box> parse_rectangle(const std::string& option, const std::string& text) {
  if (text.empty()) return {};
  std::array<double, 4> sides{};
  if (!parse_numbers(text, sides))
    throw Failure(exit_usage, fmt::format("{} {}: four numbers with commas are needed: x0,y0,x1,y1", option, text));
  const Box box{sides[0], sides[1], sides[2], sides[3]};
  if (!(box.min_x < box.max_x && box.min_y < box.max_y)) {
    throw Failure(exit_usage, fmt::format("{} {}: it is empty; the lower left corner comes first: x0 < x1 and y0 < y1",
                                          option, text));
  }
  return box;
}

Box rectangle_around(const io::PointSet& points) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Box box{far, far, -far, -far};
  for (std::size_t i = 0; i < points.xy.size(); i += 2) {
    box.min_x = std::min(box.min_x, points.xy[i]);
    box.max_x = std::max(box.max_x, points.xy[i]);
    box.min_y = std::min(box.min_y, points.xy[i + 1]);
    box.max_y = std::max(box.max_y, points.xy[i + 1]);
  }
  return box;
}

}  // namespace cadt::cli
