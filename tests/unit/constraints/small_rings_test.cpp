// SPDX-License-Identifier: Apache-2.0
// Small rings, which are triangulated without a sweep: equal to what the sweep makes of them, and in the same order on
// every device.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/support/backends.hpp"
#include "tests/unit/constraints/polygon_sets.hpp"

namespace cadt::test {
namespace {

using Random = std::mt19937_64;

double number(Random& random, std::uint64_t below) { return static_cast<double>(random() % below); }

Ring random_ring(Random& random, std::size_t n, std::uint64_t size) {
  Ring ring;
  for (std::size_t i = 0; i < n; ++i) ring.push_back({number(random, size), number(random, size)});
  return ring;
}

/// Random points, and sides that are exchanged until no two of them cross: bays, and bases with obstructed apexes.
Ring untangled_ring(Random& random, std::size_t n, std::uint64_t size) {
  Ring ring = random_ring(random, n, size);
  const auto side = [&](std::size_t a, std::size_t b, std::size_t c) {
    const double area = twice_area(Ring{ring[a % n], ring[b % n], ring[c % n]});
    return (area > 0) - (area < 0);
  };
  const auto cross = [&](std::size_t i, std::size_t j) {
    return side(i, i + 1, j) * side(i, i + 1, j + 1) < 0 && side(j, j + 1, i) * side(j, j + 1, i + 1) < 0;
  };
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 2; j < n; ++j)
        if (cross(i, j)) {
          std::reverse(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                       ring.begin() + static_cast<std::ptrdiff_t>(j) + 1);
          again = true;
        }
  }
  return ring;
}

/// Places of a lattice on one circle: only ties decide.
Ring round_ring(Random& random, std::size_t n) {
  std::vector<std::array<double, 2>> all;
  for (int x = -65; x <= 65; ++x)
    for (int y = -65; y <= 65; ++y)
      if (x * x + y * y == 65 * 65) all.push_back({static_cast<double>(x), static_cast<double>(y)});
  std::ranges::shuffle(all, random);
  all.resize(std::min(n, all.size()));
  std::ranges::sort(all, {}, [](const auto& p) { return std::atan2(p[1], p[0]); });
  return all;
}

/// A comb with teeth of random height, on a line, and a gap between the lines or none.
Ring comb(Random& random, std::size_t n) {
  Ring ring = {{number(random, 3), -number(random, 3)}};
  for (std::size_t i = 1; i < n; ++i) {
    const auto x = static_cast<double>(i);
    ring.push_back({x, i % 2 == 0 ? number(random, 3) : 3 + number(random, 40)});
  }
  return ring;
}

/// A strip that turns to the right again and again, with walls on both sides.
Ring spiral(Random& random, std::size_t n) {
  Ring out, back;
  for (std::size_t i = 0; i < n / 2; ++i) {
    const double r = static_cast<double>(8 * (i + 1)), s = r - 1 - number(random, 3);
    const std::array<double, 2> turn[] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    out.push_back({turn[i % 4][0] * r, turn[i % 4][1] * r});
    back.push_back({turn[i % 4][0] * s, turn[i % 4][1] * s});
  }
  out.insert(out.end(), back.rbegin(), back.rend());
  return out;
}

/// Points next to a line; the last one is not.
Ring flat_ring(Random& random, std::size_t n) {
  Ring ring;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double x = 0.1 * static_cast<double>(i), y = 0.3 * x;
    ring.push_back({x, std::nextafter(y, y + number(random, 3) - 1)});
  }
  ring.push_back({number(random, 2), 1 + number(random, 2)});
  return ring;
}

/// A ring of some kind, and what may have happened to it.
Ring any_ring(Random& random) {
  const std::size_t n = 3 + random() % (random() % 2 != 0 ? 8 : 32);
  const std::uint64_t size = random() % 2 != 0 ? 12 : 1000000;
  Ring ring;
  switch (random() % 8) {
    case 0:
      ring = random_ring(random, std::min<std::size_t>(n, 7), 3 + random() % 5);
      break;
    case 1:
      ring = star(random, n, 0, 0, 3e8, 1e9);
      break;
    case 2:
      ring = star(random, n, 0, 0, 2, 8);
      break;
    case 3:
      ring = round_ring(random, n);
      break;
    case 4:
      ring = comb(random, n);
      break;
    case 5:
      ring = spiral(random, n);
      break;
    case 6:
      ring = flat_ring(random, n);
      break;
    default:
      ring = untangled_ring(random, n, size);
  }
  if (random() % 8 == 0) ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(random() % ring.size()), ring.back());
  if (random() % 8 == 0) ring[random() % ring.size()] = ring[random() % ring.size()];
  if (random() % 8 == 0) std::swap(ring[random() % ring.size()], ring[random() % ring.size()]);
  if (random() % 8 == 0) {  // a vertex on an edge, as far as it can be rounded
    const std::size_t i = random() % ring.size(), j = (i + 1) % ring.size();
    ring[random() % ring.size()] = {(ring[i][0] + ring[j][0]) / 2, (ring[i][1] + ring[j][1]) / 2};
  }
  if (random() % 4 == 0)
    for (auto& p : ring) p[0] += 500000, p[1] += 5000000;
  if (random() % 4 == 0)
    for (auto& p : ring) p[0] = std::ldexp(p[0], -40), p[1] = std::ldexp(p[1], -40);
  if (random() % 2 != 0) std::ranges::reverse(ring);
  std::ranges::rotate(ring, ring.begin() + static_cast<std::ptrdiff_t>(random() % ring.size()));
  if (random() % 2 != 0) ring.push_back(ring.front());
  return ring;
}

class SmallRings : public BackendTest {};

/// With a second ring far away, which only adds a triangle, a polygon is swept.
TEST_P(SmallRings, EqualTheSweep) {
  Random random(6);
  const std::size_t count = GetParam().backend == Backend::opencl ? 10000 : 40000;
  PolygonSet alone, with_other;
  for (std::size_t i = 0; i < count; ++i) {
    const Ring ring = any_ring(random);
    alone.add({ring});
    double far = 1;
    for (const auto& p : ring) far = std::max({far, 4 * std::abs(p[0]), 4 * std::abs(p[1])});
    with_other.add({ring, {{far, 0}, {2 * far, 0}, {far, far}}});
  }
  const PolygonsResult found = alone.triangulate(GetParam().options()),
                       swept = with_other.triangulate(GetParam().options());
  std::map<PolygonStatus, std::size_t> counts;
  std::size_t divided = 0, problem = 0, swept_problem = 0;
  for (std::size_t p = 0; p < count; ++p) {
    const auto first = static_cast<std::int32_t>(alone.rings[p]), end = static_cast<std::int32_t>(alone.rings[p + 1]),
               shift = static_cast<std::int32_t>(3 * p);
    std::vector<Triple> expected, triangles;
    for (const Triple& t : as_set(with_other, swept.triangles(p)))
      if (t[0] - shift < end) expected.push_back({t[0] - shift, t[1] - shift, t[2] - shift});
    const bool none = swept.status()[p] == PolygonStatus::ok && expected.empty();
    const PolygonStatus status = none ? PolygonStatus::zero_area : swept.status()[p];
    ASSERT_EQ(to_string(found.status()[p]), to_string(status)) << p;
    ASSERT_EQ(as_set(alone, found.triangles(p)), expected) << p;
    ++counts[status];
    if (status != PolygonStatus::ok) {
      const PolygonProblem& one = found.problems()[problem++];
      ASSERT_EQ(one.polygon, p);
      if (none) continue;
      const PolygonProblem& other = swept.problems()[swept_problem++];
      ASSERT_EQ(one.first, other.first - shift) << p;
      ASSERT_EQ(one.second, other.second - shift) << p;
      continue;
    }
    const auto one = found.triangles(p);
    if (one[0] == first || one[2] == first) ++divided;  // from the base between its first and last point on
  }
  EXPECT_GE(counts[PolygonStatus::ok], count / 2);
  EXPECT_GE(counts[PolygonStatus::self_crossing], count / 20);
  EXPECT_GE(counts[PolygonStatus::zero_area], 20U);
  EXPECT_GE(divided, count / 3);
  RecordProperty("divided", static_cast<int>(divided));
}

TEST_P(SmallRings, OrderIsThatOfTheHost) {
  Random random(7);
  PolygonSet set;
  for (std::size_t i = 0; i < 5000; ++i) {
    set.add({any_ring(random)});
    if (i % 4 == 0) set.add({star(random, 30, 0, 0, 5e8, 1e9), star(random, 3 + i % 5, 0, 0, 1e7, 2e7)});
    if (i % 16 == 0) set.add({star(random, 20 + i % 50, 0, 0, 5e8, 1e9)});
  }
  Options host;
  host.backend = Backend::host;
  host.threads = 1;
  EXPECT_TRUE(std::ranges::equal(set.triangulate(GetParam().options()).triangles(), set.triangulate(host).triangles()));
}
CADT_ON_MAIN_BACKENDS(SmallRings);

}  // namespace
}  // namespace cadt::test
