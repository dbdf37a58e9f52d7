// SPDX-License-Identifier: Apache-2.0
// The parts of the oracle that need no CGAL.
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "tests/support/oracle.hpp"

namespace cadt::test {

std::vector<std::int32_t> representatives(std::span<const double> xy) {
  const auto n = static_cast<std::int32_t>(xy.size() / 2);
  const auto at = [&](std::int32_t i) {
    const auto k = 2 * static_cast<std::size_t>(i);
    return std::pair{xy[k], xy[k + 1]};  // comparison by value, so the sign of a zero does not count
  };
  std::vector<std::int32_t> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    const auto p = at(a), q = at(b);
    return p != q ? p < q : a < b;
  });
  std::vector<std::int32_t> result(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && at(order[i - 1]) == at(order[i]);
    result[static_cast<std::size_t>(order[i])] = repeats ? result[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return result;
}

void make_canonical(std::vector<Triangle>& triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
}

}  // namespace cadt::test
