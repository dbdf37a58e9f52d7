// SPDX-License-Identifier: Apache-2.0
// Places in the cells of a grid over their box: which of them lie in the box of a triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt {

/// About as many cells as places. \pre all are finite
class SeedBuckets {
 public:
  using Place = std::array<double, 2>;

  /// `places` must outlive this object.
  explicit SeedBuckets(std::span<const Place> places)
      : places_(places),
        side_(std::max<std::size_t>(static_cast<std::size_t>(std::sqrt(static_cast<double>(places.size()))), 1)) {
    for (std::size_t k = 0; k < 2 && !places.empty(); ++k) {
      const auto [low, high] = std::ranges::minmax(places, {}, [&](const Place& p) { return p[k]; });
      low_[k] = low[k];
      high_[k] = high[k];
    }
    begins_.assign(side_ * side_ + 1, 0);
    for (const Place& p : places) ++begins_[cell(0, p[0]) + side_ * cell(1, p[1]) + 1];
    for (std::size_t c = 0; c < side_ * side_; ++c) begins_[c + 1] += begins_[c];
    order_.resize(places.size());
    std::vector<std::size_t> ends = begins_;
    for (std::size_t i = 0; i < places.size(); ++i)
      order_[ends[cell(0, places[i][0]) + side_ * cell(1, places[i][1])]++] = i;
  }

  /// Calls `use(i)` for each place i in the box from `low` to `high`, borders included.
  template <class Use>
  void each_in(const Place& low, const Place& high, const Use& use) const {
    if (places_.empty()) return;
    for (std::size_t k = 0; k < 2; ++k)
      if (high[k] < low_[k] || low[k] > high_[k]) return;
    const std::size_t left = cell(0, low[0]), right = cell(0, high[0]), top = cell(1, high[1]);
    for (std::size_t row = cell(1, low[1]); row <= top; ++row)
      for (std::size_t at = begins_[side_ * row + left]; at < begins_[side_ * row + right + 1]; ++at) {
        const Place& p = places_[order_[at]];
        if (p[0] >= low[0] && p[0] <= high[0] && p[1] >= low[1] && p[1] <= high[1]) use(order_[at]);
      }
  }

 private:
  /// The column (k = 0) or row of a coordinate; it does not descend where the coordinate ascends. Halves do not
  /// overflow.
  [[nodiscard]] std::size_t cell(std::size_t k, double v) const {
    const double width = high_[k] / 2 - low_[k] / 2, from = std::clamp(v, low_[k], high_[k]) / 2 - low_[k] / 2;
    if (!(width > 0)) return 0;
    return std::min(static_cast<std::size_t>(from / width * static_cast<double>(side_)), side_ - 1);
  }

  std::span<const Place> places_;
  std::size_t side_;
  Place low_{}, high_{};
  std::vector<std::size_t> begins_, order_;  // of each cell; the places of the cells
};

}  // namespace cadt
