// SPDX-License-Identifier: Apache-2.0
#include "tests/support/orders.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace cadt::test {
namespace {

// The bounding box, of coordinates times 1/4: no width overflows.
struct Box {
  double min_x = std::numeric_limits<double>::infinity(), min_y = min_x, max_x = -min_x, max_y = -min_x;
  explicit Box(const Points& xy) {
    for (std::size_t i = 0; i < xy.size(); i += 2) {
      min_x = std::min(min_x, xy[i] / 4), max_x = std::max(max_x, xy[i] / 4);
      min_y = std::min(min_y, xy[i + 1] / 4), max_y = std::max(max_y, xy[i + 1] / 4);
    }
  }
  [[nodiscard]] double size() const { return std::max(max_x - min_x, max_y - min_y); }
};

// The indices, ascending by key(i); those of equal keys stay in their order.
template <class Key>
std::vector<std::size_t> ascending(std::size_t n, Key key) {
  using Value = decltype(key(std::size_t{0}));
  std::vector<std::pair<Value, std::size_t>> keyed(n);
  for (std::size_t i = 0; i < n; ++i) keyed[i] = {key(i), i};
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::size_t> order(n);
  std::transform(keyed.begin(), keyed.end(), order.begin(), [](const auto& entry) { return entry.second; });
  return order;
}

std::vector<std::size_t> by_random(const Points& xy) { return random_order(xy.size() / 2, 11); }

std::vector<std::size_t> sorted(const Points& xy) {
  return ascending(xy.size() / 2, [&](std::size_t i) { return std::pair(xy[2 * i], xy[2 * i + 1]); });
}

std::vector<std::size_t> last_first(const Points& xy) {
  std::vector<std::size_t> order = sorted(xy);
  std::reverse(order.begin(), order.end());
  return order;
}

// Place of a cell on the Hilbert curve over 2^16 x 2^16 cells (D. Hilbert, Math. Ann. 38, 1891): from the largest
// quadrants to the smallest, each turned as the curve runs in it.
std::uint64_t place_on_curve(std::uint32_t x, std::uint32_t y) {
  std::uint64_t place = 0;
  for (std::uint32_t half = 1U << 15; half > 0; half /= 2) {
    const std::uint32_t right = (x & half) != 0 ? 1 : 0, upper = (y & half) != 0 ? 1 : 0;
    place = 4 * place + ((3 * right) ^ upper);
    if (upper != 0) continue;
    if (right != 0) x = ~x, y = ~y;
    std::swap(x, y);
  }
  return place;
}

std::vector<std::size_t> along_curve(const Points& xy) {
  const Box box(xy);
  const double size = box.size();
  const auto cell = [&](double coordinate, double low) {
    return size > 0 ? static_cast<std::uint32_t>(std::min((coordinate / 4 - low) / size * 65535.0, 65535.0)) : 0U;
  };
  return ascending(xy.size() / 2, [&](std::size_t i) {
    return place_on_curve(cell(xy[2 * i], box.min_x), cell(xy[2 * i + 1], box.min_y));
  });
}

std::vector<std::size_t> outwards(const Points& xy) {
  const Box box(xy);
  const double x = (box.min_x + box.max_x) / 2, y = (box.min_y + box.max_y) / 2;
  return ascending(xy.size() / 2, [&](std::size_t i) { return std::hypot(xy[2 * i] / 4 - x, xy[2 * i + 1] / 4 - y); });
}

}  // namespace

const std::vector<PointOrder>& point_orders() {
  static const std::vector<PointOrder> orders = {
      {"random", by_random},    {"sorted", sorted},   {"reversed", last_first},
      {"hilbert", along_curve}, {"radial", outwards},
  };
  return orders;
}

Points inside_first_triangle(const Points& xy) {
  if (xy.empty()) return {};
  const Box box(xy);
  const double largest =
      std::max({std::fabs(box.min_x), std::fabs(box.min_y), std::fabs(box.max_x), std::fabs(box.max_y)});
  if (!(largest < std::numeric_limits<double>::max() / 64)) return {};
  // Of the size of the set, and so far away that no rounding brings it back in.
  const double x = 2 * (box.min_x + box.max_x), y = 2 * (box.min_y + box.max_y);
  const double reach = 16 * std::max({box.size(), largest * 1e-15, 4 * std::numeric_limits<double>::denorm_min()});
  Points all = {x - reach, y - reach, x + reach, y - reach, x, y + reach};
  all.insert(all.end(), xy.begin(), xy.end());
  return all;
}

}  // namespace cadt::test
