// SPDX-License-Identifier: Apache-2.0
// Each mutation of a valid mesh must be rejected by the check that is made for it. Where the mutation breaks only one
// property, no other check may complain.
#include "rejection.hpp"
#include "truth.hpp"

#include <algorithm>
#include <climits>
#include <functional>

namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

/// Flips the first interior edge for which `wanted` holds and which is the diagonal of a convex quadrilateral.
bool flip_one(TestMesh& m, const std::function<bool(int incircle)>& wanted) {
  using cadt::verifier::Point;
  const auto point = [&](std::int32_t v) { return Point{m.xy[2 * index(v)], m.xy[2 * index(v) + 1]}; };
  for (std::size_t e = 0; e < m.triangles.size(); ++e) {
    const std::int32_t s = m.neighbors[e];
    if (s < 0) continue;
    const std::size_t t = e / 3;
    const std::int32_t a = m.triangles[e], b = m.triangles[3 * t + (e + 1) % 3], c = m.triangles[3 * t + (e + 2) % 3];
    std::int32_t d = -1;
    for (std::size_t j = 0; j < 3; ++j)
      if (const std::int32_t v = m.triangles[3 * index(s) + j]; v != b && v != c) d = v;
    if (truth::orientation(point(a), point(b), point(d)) <= 0 || truth::orientation(point(a), point(d), point(c)) <= 0)
      continue;
    if (!wanted(truth::incircle(point(a), point(b), point(c), point(d)))) continue;
    std::ranges::copy(std::array{a, b, d}, m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t));
    std::ranges::copy(std::array{a, d, c}, m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * index(s)));
    m.complete();
    return true;
  }
  return false;
}

void drop(TestMesh& m, std::size_t t) {
  const auto first = m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t);
  m.triangles.erase(first, first + 3);
}

/// First triangle with `sides` edges on the boundary.
std::size_t triangle_with(const TestMesh& m, int sides) {
  for (std::size_t t = 0; t < m.size(); ++t)
    if (std::count(m.neighbors.begin() + static_cast<std::ptrdiff_t>(3 * t),
                   m.neighbors.begin() + static_cast<std::ptrdiff_t>(3 * t + 3), -1) == sides)
      return t;
  ADD_FAILURE() << "no triangle with " << sides << " boundary edges";
  return 0;
}

class Kill : public testing::Test {
 protected:
  TestMesh random = brute_force_delaunay(random_points(30, 5));
  TestMesh grid = lattice(5, 4);
  TestMesh doubled = [] {
    std::vector<double> xy = random_points(12, 9);
    for (const std::size_t i : {3U, 7U, 3U, 0U}) xy.insert(xy.end(), {xy[2 * i], xy[2 * i + 1]});
    return brute_force_delaunay(xy);
  }();

  void SetUp() override {
    for (const TestMesh* m : {&random, &grid, &doubled}) {
      ASSERT_TRUE(verify_full(*m).ok) << verify_full(*m).summary();
      ASSERT_TRUE(verify_bare(*m).ok) << verify_bare(*m).summary();
    }
  }
};

TEST_F(Kill, TwoVerticesSwapped) {
  for (std::size_t t = 0; t < random.size(); ++t) {
    TestMesh m = random;
    std::swap(m.triangles[3 * t], m.triangles[3 * t + 1]);
    expect_killed_by(verify_full(m), "orientation");
    expect_killed_by(verify_full(m), "neighbors");
    expect_killed_by(verify_bare(m), "orientation");
    EXPECT_EQ(check_of(verify_bare(m), "orientation").first, static_cast<std::int64_t>(t));
  }
}

TEST_F(Kill, TripleRotatedWithoutItsNeighbours) {
  for (std::size_t t = 0; t < random.size(); ++t) {
    TestMesh m = random;
    const auto first = m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t);
    std::rotate(first, first + 1, first + 3);
    EXPECT_EQ(failed(verify_full(m)), Names{"neighbors"});
    EXPECT_TRUE(verify_bare(m).ok) << "the order within a triangle is free";
  }
}

TEST_F(Kill, LegalEdgeFlipped) {
  TestMesh m = random;
  ASSERT_TRUE(flip_one(m, [](int side) { return side < 0; }));
  EXPECT_EQ(failed(verify_full(m)), Names{"delaunay"});
  EXPECT_EQ(failed(verify_bare(m)), Names{"delaunay"});
  EXPECT_EQ(check_of(verify_full(m), "delaunay").failures, 1U);
}

TEST_F(Kill, TieFlippedTheOtherWay) {
  ASSERT_TRUE(flip_one(grid, [](int side) { return side == 0; }));
  const VerifyReport strict = verify_full(grid), lenient = verify_full(grid, false);
  EXPECT_EQ(failed(strict), Names{"ties"});
  EXPECT_EQ(strict.unusual_ties, 1U);
  EXPECT_TRUE(lenient.ok);
  EXPECT_EQ(lenient.unusual_ties, 1U);
  EXPECT_EQ(lenient.ties, strict.ties);
  EXPECT_NE(check_of(lenient, "ties").what.find("1 of "), std::string::npos);
}

TEST_F(Kill, InnerTriangleDropped) {
  TestMesh m = random;
  drop(m, triangle_with(m, 0));
  expect_killed_by(verify_bare(m), "boundary");
}

TEST_F(Kill, HullCut) {
  TestMesh m = random;
  drop(m, triangle_with(m, 1));
  m.complete();
  expect_killed_by(verify_full(m), "hull");
}

TEST_F(Kill, CornerCutOff) {
  drop(grid, triangle_with(grid, 2));
  grid.complete();
  EXPECT_EQ(failed(verify_full(grid)), Names{"vertices"});
  EXPECT_EQ(failed(verify_bare(grid)), Names{"vertices"});
}

TEST_F(Kill, TriangleTwice) {
  TestMesh m = random;
  for (std::size_t k = 0; k < 3; ++k) m.triangles.push_back(m.triangles[k]);
  EXPECT_EQ(failed(verify_bare(m)), Names{"neighbors"});
  for (int k = 0; k < 3; ++k) m.neighbors.push_back(-1);
  expect_killed_by(verify_full(m), "boundary");
  expect_killed_by(verify_full(m), "euler");
}

TEST_F(Kill, NeighbourAliased) {
  for (std::size_t e = 0; e < random.neighbors.size(); ++e) {
    TestMesh m = random;
    m.neighbors[e] = (m.neighbors[e] + 2) % static_cast<std::int32_t>(m.size());
    EXPECT_EQ(failed(verify_full(m)), Names{"neighbors"}) << e;
    m.neighbors[e] = static_cast<std::int32_t>(e / 3);
    EXPECT_EQ(failed(verify_full(m)), Names{"neighbors"}) << e << ", its own neighbour";
  }
}

TEST_F(Kill, NeighbourMissingOnOneSide) {
  TestMesh m = random;
  *std::ranges::find_if(m.neighbors, [](std::int32_t s) { return s >= 0; }) = -1;
  EXPECT_EQ(failed(verify_full(m)), Names{"neighbors"});
}

TEST_F(Kill, Slit) {
  for (std::size_t e = 0; e < random.neighbors.size(); ++e) {
    TestMesh m = random;
    const std::int32_t s = m.neighbors[e];
    if (s < 0) continue;
    for (std::size_t j = 0; j < 3; ++j)
      if (m.neighbors[3 * index(s) + j] == static_cast<std::int32_t>(e / 3)) m.neighbors[3 * index(s) + j] = -1;
    m.neighbors[e] = -1;
    expect_killed_by(verify_full(m), "boundary");
  }
}

TEST_F(Kill, HullListWrong) {
  const auto mutate = [&](const std::function<void(std::vector<std::int32_t>&)>& change) {
    TestMesh m = random;
    change(m.hull);
    EXPECT_EQ(failed(verify_full(m)), Names{"hull"});
  };
  mutate([](auto& h) { h.pop_back(); });
  mutate([](auto& h) { h.push_back(h.front()); });
  mutate([](auto& h) { std::rotate(h.begin(), h.begin() + 1, h.end()); });
  mutate([](auto& h) { std::reverse(h.begin() + 1, h.end()); });
  mutate([](auto& h) { h.back() = INT_MAX; });
}

TEST_F(Kill, DuplicatesMisrecorded) {
  ASSERT_EQ(doubled.duplicates.size(), 4U);
  const auto mutate = [&](const std::function<void(std::vector<cadt::Duplicate>&)>& change) {
    TestMesh m = doubled;
    change(m.duplicates);
    EXPECT_EQ(failed(verify_full(m)), Names{"vertices"});
  };
  mutate([](auto& d) { d.pop_back(); });
  mutate([](auto& d) { d.clear(); });
  mutate([](auto& d) { d[0].representative = 4; });
  mutate([](auto& d) { d[2].representative = d[0].point; });  // equal, but not the lowest
  mutate([](auto& d) { d[0].representative = d[0].point; });
  mutate([](auto& d) { d[0].representative = -1; });
  mutate([](auto& d) { d[0].representative = INT_MAX; });
  mutate([](auto& d) { d[0].point = INT_MAX; });
  mutate([](auto& d) { d[0].point = -1; });
  mutate([](auto& d) { std::swap(d[0], d[1]); });
  mutate([](auto& d) { d[1] = d[0]; });
  mutate([](auto& d) { d.push_back(d[3]); });
  mutate([](auto& d) { d.insert(d.begin(), {2, 1}); });
}

TEST_F(Kill, DuplicateUsedInPlaceOfItsRepresentative) {
  const cadt::Duplicate d = doubled.duplicates[1];
  std::ranges::replace(doubled.triangles, d.representative, d.point);
  std::ranges::replace(doubled.hull, d.representative, d.point);
  expect_killed_by(verify_full(doubled), "vertices");
  EXPECT_TRUE(verify_bare(doubled).ok) << "another program may choose another of equal points";
  doubled.duplicates[1] = {d.representative, d.point};  // true, but the lowest must stand for the others
  std::ranges::sort(doubled.duplicates, {}, &cadt::Duplicate::point);
  expect_killed_by(verify_full(doubled), "vertices");
}

TEST_F(Kill, BothOfTwoEqualPointsUsed) {
  const cadt::Duplicate d = doubled.duplicates[1];
  *std::ranges::find(doubled.triangles, d.representative) = d.point;
  EXPECT_FALSE(verify_bare(doubled).ok);
  expect_killed_by(verify_full(doubled), "vertices");
}

TEST_F(Kill, PointLeftOut) {
  random.xy.insert(random.xy.end(), {0.5, 0.5});
  EXPECT_EQ(failed(verify_full(random)), Names{"vertices"});
  const VerifyReport report = verify_bare(random);
  EXPECT_EQ(failed(report), Names{"vertices"});
  EXPECT_EQ(check_of(report, "vertices").first, 30);
}

TEST_F(Kill, PointMoved) {
  TestMesh m = lattice(9, 9);
  m.xy[2 * 40] += 0.75;  // the centre, within its star
  EXPECT_EQ(failed(verify_full(m)), Names{"delaunay"});
  m.xy[2 * 40] += 2;
  expect_killed_by(verify_full(m), "orientation");
  m = lattice(9, 9);
  m.xy[1] -= 0x1p-40;  // the corner: the bottom of the hull is no longer convex at its neighbour
  expect_killed_by(verify_full(m), "hull");
}

TEST_F(Kill, IndexOutOfRange) {
  for (const std::int32_t bad : {-1, 30, INT_MIN, INT_MAX})
    for (std::size_t e = 0; e < random.triangles.size(); e += 7) {
      TestMesh m = random;
      m.triangles[e] = bad;
      EXPECT_EQ(failed(verify_full(m)), Names{"range"});
      EXPECT_EQ(failed(verify_bare(m)), Names{"range"});
      EXPECT_EQ(check_of(verify_bare(m), "range").first, static_cast<std::int64_t>(e / 3));
      for (const Check& c : verify_bare(m).checks) {
        if (c.name != "range" && c.name != "counts") {
          EXPECT_EQ(c.what.rfind("not examined: ", 0), 0U) << c.name;
        }
      }
    }
}

TEST_F(Kill, NeighbourOutOfRange) {
  for (const std::int32_t bad : {-2, static_cast<std::int32_t>(random.size()), INT_MIN, INT_MAX}) {
    TestMesh m = random;
    m.neighbors[8] = bad;
    EXPECT_EQ(failed(verify_full(m)), Names{"range"});
  }
}

TEST_F(Kill, VertexTwiceInATriangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    TestMesh m = random;
    m.triangles[k] = m.triangles[(k + 1) % 3];
    EXPECT_EQ(failed(verify_full(m)), Names{"range"});
  }
}

TEST_F(Kill, SizesThatDoNotFit) {
  TestMesh m = random;
  m.triangles.pop_back();
  EXPECT_EQ(failed(verify_bare(m)), Names{"counts"});
  m = random;
  m.neighbors.pop_back();
  EXPECT_EQ(failed(verify_full(m)), Names{"counts"});
}

}  // namespace
