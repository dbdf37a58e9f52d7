// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/constraints/segment_sets.hpp"

#include "common/verify/host/exact_sign.hpp"

#include <cmath>
#include <limits>
#include <random>

namespace cadt::test {
namespace {

using verifier::orientation;
using verifier::Point;

/// The bits of a generator alone, as distributions differ between standard libraries.
class SetRandom {
 public:
  explicit SetRandom(std::uint64_t seed) : bits_(seed) {}
  [[nodiscard]] double unit() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  [[nodiscard]] int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(n)); }

 private:
  std::mt19937_64 bits_;
};

/// Segments between any of the points.
void join(SegmentSet& set, SetRandom& random, std::size_t count) {
  const int n = static_cast<int>(set.xy.size() / 2);
  for (std::size_t i = 0; i < count; ++i) set.segments.push_back({random.below(n), random.below(n)});
}

SegmentSet ends_of_range(std::uint64_t seed) {
  SegmentSet set{"subnormal, small and largest coordinates", {}, {}};
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  const std::vector<double> values = {0.0, -0.0, least, -least, 3 * least, 0x1p-1022,
                                      1.0, -1.0, 1e-30, most,   -most,     most / 2};
  SetRandom random(seed);
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 2; ++k) set.xy.push_back(values[static_cast<std::size_t>(random.below(12))]);
  join(set, random, 20);
  return set;
}

/// Segments that differ from one another by a few last places.
SegmentSet almost_parallel(std::uint64_t seed) {
  SegmentSet set{"almost parallel", {}, {}};
  SetRandom random(seed);
  for (int i = 0; i < 40; ++i) {
    const double ends[4] = {0.1, 0.3, 1.7, 2.9};
    for (const double end : ends) {
      double v = end;
      for (int k = random.below(4); k > 0; --k) v = std::nextafter(v, 10.0);
      set.xy.push_back(v);
    }
    set.segments.push_back({2 * i, 2 * i + 1});
  }
  return set;
}

/// Segments through one place, which is a point or not; some are on the same line.
SegmentSet concurrent(std::uint64_t seed, bool point) {
  SegmentSet set{point ? "concurrent at a point" : "concurrent", {}, {}};
  SetRandom random(seed);
  if (point) set.xy = {0.0, 0.0};
  for (int i = 0; i < 30; ++i) {
    const int x = random.below(7) - 3, y = random.below(7) - 3, a = 1 + random.below(3), b = 1 + random.below(3);
    if (x == 0 && y == 0) continue;
    const auto n = static_cast<std::int32_t>(set.xy.size() / 2);
    set.xy.insert(set.xy.end(), {1.0 * x * a, 1.0 * y * a, -1.0 * x * b, -1.0 * y * b});
    set.segments.push_back({n, n + 1});
  }
  return set;
}

SegmentSet on_one_line(std::uint64_t seed) {
  SegmentSet set{"on one line", {}, {}};
  SetRandom random(seed);
  for (int i = 0; i < 30; ++i) {
    const int k = random.below(100);
    set.xy.insert(set.xy.end(), {1.0 * k, 3.0 * k});
  }
  set.xy.insert(set.xy.end(), {50.5, 0.0, 51.0, 300.0, 20.0, 60.0, 20.0, 61.0});
  join(set, random, 60);
  return set;
}

}  // namespace

SegmentSet lattice_segments(std::uint64_t seed, int side, std::size_t count, double x_unit, double y_unit) {
  SegmentSet set{"lattice of " + std::to_string(side) + ", seed " + std::to_string(seed), {}, {}};
  SetRandom random(seed);
  const std::size_t points = count + count / 2;
  for (std::size_t i = 0; i < points; ++i) {
    set.xy.push_back(random.below(side) * x_unit);
    set.xy.push_back(random.below(side) * y_unit);
  }
  join(set, random, count);
  return set;
}

SegmentSet random_segments(std::uint64_t seed, std::size_t count, double length) {
  SegmentSet set{"random, length " + std::to_string(length), {}, {}};
  SetRandom random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.unit(), y = random.unit();
    set.xy.insert(set.xy.end(), {x, y, x + length * (2 * random.unit() - 1), y + length * (2 * random.unit() - 1)});
    set.segments.push_back({static_cast<std::int32_t>(2 * i), static_cast<std::int32_t>(2 * i + 1)});
  }
  return set;
}

std::vector<SegmentSet> small_segment_sets() {
  std::vector<SegmentSet> sets;
  sets.push_back({"none", {}, {}});
  sets.push_back({"two points", {0.0, 0.0, 1.0, 1.0}, {{0, 1}, {1, 0}, {0, 0}}});
  sets.push_back({"a cross", {0.0, 0.0, 2.0, 2.0, 0.0, 2.0, 2.0, 0.0}, {{0, 1}, {3, 2}}});
  sets.push_back({"a cross at a point", {0.0, 0.0, 2.0, 2.0, 0.0, 2.0, 2.0, 0.0, 1.0, 1.0}, {{0, 1}, {3, 2}}});
  sets.push_back(
      {"vertical and horizontal", {0.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 0.0, 0.0, 3.0}, {{0, 4}, {2, 3}, {1, 0}}});
  for (std::uint64_t seed = 0; seed < 60; ++seed)
    sets.push_back(lattice_segments(seed, 3 + static_cast<int>(seed % 6), 10 + seed % 17, 1, 1));
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    sets.push_back(lattice_segments(seed, 5, 25, 0.1, 1.0 / 3));
    sets.push_back(lattice_segments(seed, 4, 25, std::numeric_limits<double>::denorm_min(), 1e307));
    sets.push_back(lattice_segments(seed, 30, 60, 1, 1));
    sets.push_back(ends_of_range(seed));
    sets.push_back(almost_parallel(seed));
    sets.push_back(concurrent(seed, seed % 2 != 0));
    sets.push_back(on_one_line(seed));
    sets.push_back(random_segments(seed, 100, 0.3));
  }
  return sets;
}

std::vector<std::array<std::int32_t, 2>> crossings_by_brute_force(const SegmentSet& set) {
  const auto point = [&](std::int32_t i) {
    const auto k = 2 * static_cast<std::size_t>(i);
    return Point{set.xy[k], set.xy[k + 1]};
  };
  const auto points = static_cast<std::int32_t>(set.xy.size() / 2);
  const auto count = static_cast<std::int32_t>(set.segments.size());
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (std::int32_t i = 0; i < count; ++i) {
    const auto [ia, ib] = set.segments[static_cast<std::size_t>(i)];
    const Point a = point(ia), b = point(ib);
    for (std::int32_t j = i + 1; j < count; ++j) {
      const auto [ic, id] = set.segments[static_cast<std::size_t>(j)];
      const Point c = point(ic), d = point(id);
      if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x)) continue;
      if (orientation(a, b, c) * orientation(a, b, d) >= 0 || orientation(c, d, a) * orientation(c, d, b) >= 0)
        continue;
      bool at_a_point = false;
      for (std::int32_t k = 0; k < points && !at_a_point; ++k)
        at_a_point = orientation(a, b, point(k)) == 0 && orientation(c, d, point(k)) == 0;
      if (!at_a_point) pairs.push_back({i, j});
    }
  }
  return pairs;
}

}  // namespace cadt::test
