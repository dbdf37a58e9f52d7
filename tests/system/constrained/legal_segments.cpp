// SPDX-License-Identifier: Apache-2.0
#include "tests/system/constrained/legal_segments.hpp"

#include <cadt/verify.hpp>

#include <algorithm>
#include <array>

namespace cadt::test {
namespace {

using Place = std::array<double, 2>;

Place at(const Points& xy, std::int32_t i) {
  const auto k = static_cast<std::size_t>(i);
  return {xy[2 * k], xy[2 * k + 1]};
}

/// Whether r lies between the ends of the segment, on it.
bool lies_inside(const Place& p, const Place& q, const Place& r) {
  return exact_orientation(p, q, r) == 0 && (p < q ? p < r && r < q : q < r && r < p);
}

}  // namespace

bool crosses(const Points& xy, const Segment& s, const Segment& t) {
  const Place a = at(xy, s[0]), b = at(xy, s[1]), c = at(xy, t[0]), d = at(xy, t[1]);
  if (exact_orientation(a, b, c) * exact_orientation(a, b, d) >= 0) return false;
  if (exact_orientation(c, d, a) * exact_orientation(c, d, b) >= 0) return false;
  for (std::size_t i = 0; i < xy.size() / 2; ++i) {
    const Place p = {xy[2 * i], xy[2 * i + 1]};
    if (lies_inside(a, b, p) && lies_inside(c, d, p)) return false;
  }
  return true;
}

std::vector<Segment> legal_segments(const Points& xy, std::size_t count, std::uint64_t seed) {
  std::vector<Segment> segments;
  const std::size_t n = xy.size() / 2;
  if (n < 2) return segments;
  Random random(seed);
  for (std::size_t tried = 0; tried < count; ++tried) {
    const std::size_t i = random.below(n);
    const std::size_t j = tried % 2 == 0 ? random.below(n) : (i + 1 + random.below(std::min<std::size_t>(n, 8))) % n;
    const Segment segment = {static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)};
    if (std::ranges::none_of(segments, [&](const Segment& other) { return crosses(xy, segment, other); }))
      segments.push_back(segment);
  }
  return segments;
}

}  // namespace cadt::test
