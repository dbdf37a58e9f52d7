// SPDX-License-Identifier: Apache-2.0
// Places in a k-d tree: which of them may lie in a triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace cadt {

/// J. L. Bentley, "Multidimensional binary search trees used for associative searching", 1975. A node is a part of the
/// places, halved by its median of x or y in turn, so places far from all others cost nothing. \pre all are finite
class SeedTree {
 public:
  using Place = std::array<double, 2>;
  using Triangle = std::array<Place, 3>;

  /// `places` must outlive this object. O(n log n).
  explicit SeedTree(std::span<const Place> places) : places_(places), order_(places.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    for (std::size_t k = 0; k < 2 && !places.empty(); ++k) {
      const auto [low, high] = std::ranges::minmax(places, {}, [&](const Place& p) { return p[k]; });
      all_.low[k] = low[k];
      all_.high[k] = high[k];
    }
    divide(0, places.size(), 0);
  }

  /// Calls `use(i)` for each place i in the counterclockwise triangle, borders included, and for some in its box.
  /// Corners may be exact ones that were rounded to nearest.
  template <class Use>
  void each_in(const Triangle& triangle, const Use& use) const {
    Box box{triangle[0], triangle[0]};
    for (const Place& p : triangle)
      for (std::size_t k = 0; k < 2; ++k) {
        box.low[k] = std::min(box.low[k], p[k]);
        box.high[k] = std::max(box.high[k], p[k]);
      }
    visit({triangle, box}, 0, order_.size(), 0, all_, use);
  }

 private:
  struct Box {
    Place low{}, high{};
  };
  struct Query {
    const Triangle& triangle;
    Box box;
  };
  static constexpr std::size_t leaf = 8;

  void divide(std::size_t first, std::size_t last, std::size_t axis) {
    if (last - first <= leaf) return;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last),
                     [&](std::size_t i, std::size_t j) { return places_[i][axis] < places_[j][axis]; });
    divide(first, middle, 1 - axis);
    divide(middle + 1, last, 1 - axis);
  }

  template <class Use>
  void visit(const Query& query, std::size_t first, std::size_t last, std::size_t axis, const Box& cell,
             const Use& use) const {
    for (std::size_t k = 0; k < 2; ++k)
      if (query.box.high[k] < cell.low[k] || query.box.low[k] > cell.high[k]) return;
    for (std::size_t k = 0; k < 3; ++k)
      if (is_outside(query.triangle[k], query.triangle[(k + 1) % 3], cell)) return;
    const auto use_in_box = [&](std::size_t i) {
      const Place &p = places_[i], &low = query.box.low, &high = query.box.high;
      if (p[0] >= low[0] && p[0] <= high[0] && p[1] >= low[1] && p[1] <= high[1]) use(i);
    };
    if (last - first <= leaf) {
      for (std::size_t at = first; at < last; ++at) use_in_box(order_[at]);
      return;
    }
    const std::size_t middle = first + (last - first) / 2;
    use_in_box(order_[middle]);
    Box lower = cell, upper = cell;
    lower.high[axis] = upper.low[axis] = places_[order_[middle]][axis];
    visit(query, first, middle, 1 - axis, lower, use);
    visit(query, middle + 1, last, 1 - axis, upper, use);
  }

  /// Whether all of the cell is certainly right of a triangle's edge from a to b: its corner that is furthest to the
  /// left. The bound is for ends that were rounded, wherever in the cell a place is, and generous; if anything
  /// overflows it is not certain.
  [[nodiscard]] static bool is_outside(const Place& a, const Place& b, const Box& cell) {
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double x = (dy > 0 ? cell.low[0] : cell.high[0]) - a[0], y = (dx > 0 ? cell.high[1] : cell.low[1]) - a[1];
    double largest = 0, lengths = std::abs(dx) + std::abs(dy);
    for (const Place& p : {a, b, cell.low, cell.high}) largest = std::max({largest, std::abs(p[0]), std::abs(p[1])});
    for (std::size_t k = 0; k < 2; ++k)
      lengths += std::max(std::abs(cell.low[k] - a[k]), std::abs(cell.high[k] - a[k]));
    const double up = dx * y, down = dy * x;
    const double bound = 1e-14 * (std::abs(up) + std::abs(down)) + 1e-15 * largest * lengths + 1e-300;
    return up - down < -bound;
  }

  std::span<const Place> places_;
  Box all_;
  std::vector<std::size_t> order_;  // of the places in the tree
};

}  // namespace cadt
