// SPDX-License-Identifier: Apache-2.0
// The verifier of vertices that crossings have made: whatever is changed in correct ones fails "constraints".
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/constraints/mesh_copy.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

namespace cadt::test {
namespace {

using Data = ConstrainedTriangulation::Data;
using Pair = std::array<std::int32_t, 2>;

class Crossed : public ::testing::Test {
 protected:
  Crossed() {
    options.crossing = Crossing::exact;
    Options host;
    host.backend = Backend::host;
    host.threads = 1;
    mesh = triangulate_constrained(set.xy, set.segments, options, host);
  }

  /// What "constraints" says once the arrays are changed, or "".
  std::string after(const std::function<void(Data&)>& change) {
    const std::shared_ptr<Data> data = copy_of(mesh);
    change(*data);
    const VerifyReport report = verify(set.xy, set.segments, ConstrainedTriangulation(data), options);
    for (const Check& check : report.checks)
      if (check.name == "constraints" && !check.passed) return check.what;
    return report.ok ? "" : report.summary();
  }
  void expect(const std::string& part, const std::function<void(Data&)>& change) {
    const std::string what = after(change);
    EXPECT_NE(what.find(part), std::string::npos) << what;
  }

  SegmentSet set = random_segments(4, 40, 0.4);
  ConstraintOptions options;
  ConstrainedTriangulation mesh;
};

TEST_F(Crossed, CorrectOnesPass) {
  EXPECT_GT(mesh.added_parents().size(), 10U);
  EXPECT_EQ(after([](Data&) {}), "");
}

TEST_F(Crossed, PlacesAreRoundedToNearest) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.added_points().size(); ++i)
    for (const double to : {-infinity, infinity})
      expect("is not where", [&](Data& data) { data.added[i] = std::nextafter(data.added[i], to); });
}

TEST_F(Crossed, PairsAreThoseThatCrossThere) {
  const std::size_t last = mesh.added_parents().size() - 1;
  const auto segments = static_cast<std::int32_t>(set.segments.size());
  expect("has no pair", [&](Data& data) { std::swap(data.parents[3][0], data.parents[3][1]); });
  expect("has no pair", [&](Data& data) { data.parents[0] = {-1, 2}; });
  expect("has no pair", [&](Data& data) { data.parents[last][1] = segments; });
  expect("there are pairs", [&](Data& data) { data.parents.pop_back(); });
  expect("not in the order", [&](Data& data) { data.parents[3] = data.parents[2]; });
  expect("do not cross", [&](Data& data) {
    const Pair pair = {0, 1};  // below the first that do
    ASSERT_LT(pair, data.parents[0]);
    data.parents[0] = pair;
  });
  // Another one of the same segment's crossings.
  std::size_t two = 0;
  while (two < last && mesh.added_parents()[two][0] != mesh.added_parents()[two + 1][0]) ++two;
  ASSERT_LT(two, last);
  expect("is not where", [&](Data& data) {
    std::swap(data.added[2 * two], data.added[2 * two + 2]);
    std::swap(data.added[2 * two + 1], data.added[2 * two + 3]);
  });
}

/// Chains of edges of the mesh that lead from end to end, but not straight on.
TEST_F(Crossed, ChainsAreOnTheirSegments) {
  const std::size_t n = set.xy.size() / 2;
  const auto is_added = [&](std::int32_t v) { return static_cast<std::size_t>(v) >= n; };
  int steps = 0;
  for (std::size_t s = 0; s < set.segments.size(); ++s) {
    const auto begin = mesh.chain_offsets()[s], end = mesh.chain_offsets()[s + 1];
    for (auto k = begin + 1; k + 1 < end; ++k) {
      const std::int32_t v = mesh.chain_vertices()[static_cast<std::size_t>(k)],
                         w = mesh.chain_vertices()[static_cast<std::size_t>(k + 1)];
      if (!is_added(v) || !is_added(w)) continue;  // others are noticed in any case
      ++steps;
      expect("turns back", [&](Data& data) {  // v w v w
        data.chain_vertices.insert(data.chain_vertices.begin() + k + 2, {v, w});
        for (std::size_t i = s + 1; i < data.chain_offsets.size(); ++i) data.chain_offsets[i] += 2;
      });
    }
  }
  EXPECT_GT(steps, 10);
}

/// A triangle of crossings: the chain of a segment goes along the other two.
TEST(VerifyCrossings, ChainOnAnotherWay) {
  const std::vector<double> xy = {0, 0, 12, 0, 2, -3, 8, 9, 10, -3, 4, 9};
  const std::vector<Segment> segments = {{0, 1}, {2, 3}, {4, 5}, {0, 1}};
  ConstraintOptions options;
  options.crossing = Crossing::exact;
  const ConstrainedTriangulation mesh = triangulate_constrained(xy, segments, options);
  ASSERT_EQ(mesh.added_parents().size(), 3U);
  ASSERT_TRUE(verify(xy, segments, mesh, options).ok);
  const std::shared_ptr<Data> data = copy_of(mesh);
  // Crossings 6 and 7 with the first segment, 8 of the other two: 6, 8, 7 instead of 6, 7.
  const auto of_last = data->chain_vertices.end() - 4;
  ASSERT_EQ(std::vector<std::int32_t>(of_last, data->chain_vertices.end()), (std::vector<std::int32_t>{0, 6, 7, 1}));
  data->chain_vertices.insert(data->chain_vertices.end() - 2, 8);
  ++data->chain_offsets.back();
  const VerifyReport report = verify(xy, segments, ConstrainedTriangulation(data), options);
  EXPECT_NE(report.summary().find("does not lie on"), std::string::npos) << report.summary();
}

TEST(VerifyCrossings, PointsThatAreNotFiniteAreRefused) {
  const SegmentSet set = random_segments(4, 40, 0.4);
  for (const Crossing crossing : {Crossing::exact, Crossing::grid}) {
    ConstraintOptions options;
    options.crossing = crossing;
    options.grid = 1.0 / 256;
    const ConstrainedTriangulation mesh = triangulate_constrained(set.xy, set.segments, options);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      std::vector<double> xy = set.xy;
      xy[7] = bad;
      try {
        (void)verify(xy, set.segments, mesh, options);
        ADD_FAILURE() << "no error";
      } catch (const InputError& error) {
        EXPECT_EQ(error.index(), 3U);
      }
    }
  }
}

}  // namespace
}  // namespace cadt::test
