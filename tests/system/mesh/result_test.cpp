// SPDX-License-Identifier: Apache-2.0
// What a result promises beyond its set of triangles: equal between runs, back ends, orders and input layouts.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;
using Floats = std::span<const float>;

std::vector<std::int32_t> copy(std::span<const std::int32_t> values) { return {values.begin(), values.end()}; }

Options serial() {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  return options;
}

// Cocircular points, equal points and points on the hull's edges in one set.
Points mixed_points() {
  Points xy = shuffled(grid_points(30, 30), 2);
  const Points circle = regular_polygon(100, 15, 15, 9), more = uniform_points(500, 8);
  xy.insert(xy.end(), circle.begin(), circle.end());
  for (const double value : more) xy.push_back(29.0 * value);
  xy.insert(xy.end(), xy.begin() + 100, xy.begin() + 200);
  return xy;
}

class Result : public BackendTest {};

TEST_P(Result, EqualsSerialHostInEveryArray) {
  const Points xy = mixed_points();
  const Triangulation reference = triangulate(Reals(xy), serial());
  for (int run = 0; run < 5; ++run) {
    const Triangulation mesh = triangulate(Reals(xy), GetParam().options());
    ASSERT_EQ(copy(mesh.triangles()), copy(reference.triangles()));
    ASSERT_EQ(copy(mesh.neighbors()), copy(reference.neighbors()));
    ASSERT_EQ(copy(mesh.hull()), copy(reference.hull()));
    ASSERT_TRUE(std::ranges::equal(mesh.duplicates(), reference.duplicates()));
    ASSERT_EQ(mesh.hash(), reference.hash());
    ASSERT_EQ(mesh.hash().to_string(), reference.hash().to_string());
  }
}

TEST_P(Result, CountsFollowTheFormula) {
  const Points xy = mixed_points();
  const Triangulation mesh = triangulate(Reals(xy), GetParam().options());
  const std::size_t distinct = xy.size() / 2 - mesh.duplicates().size();
  EXPECT_EQ(mesh.number_of_points(), xy.size() / 2);
  EXPECT_EQ(mesh.number_of_triangles(), 2 * distinct - 2 - mesh.hull().size());
}

// Vertices of so many triangles that all work-items cooperate to sort them, several such vertices in turn and with
// others between.
TEST_P(Result, CanonicalOrderAroundHubs) {
  for (const std::size_t hubs : {1U, 7U}) {
    Points xy, rings;
    for (std::size_t hub = 0; hub < hubs; ++hub) {
      const double x = 10.0 * static_cast<double>(hub % 3), y = 10.0 * static_cast<double>(hub / 3);
      xy.insert(xy.end(), {x, y});
      const Points ring = regular_polygon(300 + 50 * static_cast<int>(hub), x, y, 1);
      rings.insert(rings.end(), ring.begin(), ring.end());
    }
    const Points noise = uniform_points(rings.size() / 2, 4);
    for (std::size_t i = 0; i < rings.size(); ++i) rings[i] += 1e-7 * noise[i];
    rings = shuffled(rings, 8);
    xy.insert(xy.end(), rings.begin(), rings.end());
    Options options = GetParam().options();
    options.tuning.kernel_times = true;
    const Triangulation mesh = triangulate(Reals(xy), options);
    EXPECT_EQ(copy(mesh.triangles()), canonical_set(mesh.triangles())) << hubs << " hubs";
    EXPECT_EQ(copy(mesh.neighbors()), neighbors_of(mesh.triangles())) << hubs << " hubs";
    EXPECT_EQ(mesh.hash(), triangulate(Reals(xy), serial()).hash());
    EXPECT_TRUE(std::ranges::any_of(mesh.statistics().kernels,
                                    [](const KernelTime& kernel) { return kernel.name == "cadt_long_numbers"; }));
  }
}

TEST_P(Result, FastOrderIsTheSameSet) {
  const Points xy = mixed_points();
  Options options = GetParam().options();
  const Triangulation canonical = triangulate(Reals(xy), options);
  options.order = Order::fast;
  const Triangulation fast = triangulate(Reals(xy), options);
  EXPECT_EQ(canonical_set(fast.triangles()), copy(canonical.triangles()));
  EXPECT_EQ(copy(fast.neighbors()), neighbors_of(fast.triangles()));
  EXPECT_EQ(copy(fast.hull()), copy(canonical.hull()));
  EXPECT_TRUE(std::ranges::equal(fast.duplicates(), canonical.duplicates()));
  EXPECT_EQ(fast.hash(), canonical.hash());
  EXPECT_TRUE(verified(xy, fast));
  const std::vector<std::int32_t> at = fast.vertex_triangle(), stands_for = representatives(xy);
  ASSERT_EQ(at.size(), stands_for.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    ASSERT_GE(at[i], 0);
    const auto vertices = fast.triangles().subspan(3 * static_cast<std::size_t>(at[i]), 3);
    ASSERT_NE(std::ranges::find(vertices, stands_for[i]), vertices.end()) << "point " << i;
  }
}

TEST_P(Result, HashTellsMeshesApart) {
  const Points xy = mixed_points();
  const Hash128 hash = triangulate(Reals(xy), GetParam().options()).hash();
  Points moved_point = xy;
  moved_point[700] += 3.25;
  EXPECT_NE(triangulate(Reals(moved_point), GetParam().options()).hash(), hash);
  const Points without_last(xy.begin(), xy.end() - 2);
  EXPECT_NE(triangulate(Reals(without_last), GetParam().options()).hash(), hash);
  EXPECT_EQ(hash.to_string().size(), 32u);
  EXPECT_EQ(hash.to_string().find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST_P(Result, LayoutsAgree) {
  const std::vector<double> wide = uniform_points(3000, 21);
  std::vector<float> narrow(wide.size()), narrow_x, narrow_y;
  std::vector<double> xy(wide.size()), x, y;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    narrow[i] = static_cast<float>(wide[i]);
    xy[i] = static_cast<double>(narrow[i]);
    (i % 2 == 0 ? narrow_x : narrow_y).push_back(narrow[i]);
    (i % 2 == 0 ? x : y).push_back(xy[i]);
  }
  const Options options = GetParam().options();
  const ExpectedMesh expected = expected_mesh(xy);
  EXPECT_TRUE(same_mesh(triangulate(Reals(xy), options), expected)) << "interleaved doubles";
  EXPECT_TRUE(same_mesh(triangulate(Floats(narrow), options), expected)) << "interleaved floats";
  EXPECT_TRUE(same_mesh(triangulate(PointsView(Reals(x), Reals(y)), options), expected)) << "separate doubles";
  EXPECT_TRUE(same_mesh(triangulate(PointsView(Floats(narrow_x), Floats(narrow_y)), options), expected))
      << "separate floats";
  struct Record {
    int id;
    double y, x;
  };
  struct Sample {
    float y, height, x;
  };
  std::vector<Record> records;
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < x.size(); ++i) {
    records.push_back({static_cast<int>(i), y[i], x[i]});
    samples.push_back({narrow_y[i], 0, narrow_x[i]});
  }
  EXPECT_TRUE(same_mesh(triangulate(records, options), expected)) << "doubles among other members";
  EXPECT_TRUE(same_mesh(triangulate(samples, options), expected)) << "floats among other members";
}

TEST_P(Result, TinySets) {
  const Options options = GetParam().options();
  const Triangulation none = triangulate({}, options);
  EXPECT_EQ(none.dimension(), -1);
  EXPECT_EQ(none.number_of_points(), 0u);
  EXPECT_TRUE(none.triangles().empty() && none.neighbors().empty() && none.hull().empty() && none.duplicates().empty());
  EXPECT_TRUE(none.vertex_triangle().empty());

  const std::vector<double> one = {1.5, -2.0};
  EXPECT_EQ(triangulate(Reals(one), options).dimension(), 0);
  EXPECT_EQ(triangulate(Reals(one), options).vertex_triangle(), std::vector<std::int32_t>{-1});

  const std::vector<double> two = {0, 0, 1, 0};
  EXPECT_EQ(triangulate(Reals(two), options).dimension(), 1);
  EXPECT_EQ(triangulate(Reals(two), options).number_of_triangles(), 0u);

  const std::vector<double> clockwise = {0, 0, 0, 1, 1, 0};
  const Triangulation three = triangulate(Reals(clockwise), options);
  EXPECT_EQ(three.dimension(), 2);
  EXPECT_EQ(copy(three.triangles()), (std::vector<std::int32_t>{0, 2, 1}));
  EXPECT_EQ(copy(three.neighbors()), (std::vector<std::int32_t>{-1, -1, -1}));
  EXPECT_EQ(copy(three.hull()), (std::vector<std::int32_t>{0, 2, 1}));
  EXPECT_EQ(three.vertex_triangle(), (std::vector<std::int32_t>{0, 0, 0}));
}

TEST_P(Result, StatisticsDescribeTheRun) {
  const Points xy = mixed_points();
  Options options = GetParam().options();
  options.tuning.strategy = Strategy::locks;
  const Triangulation mesh = triangulate(Reals(xy), options);
  const Statistics& s = mesh.statistics();
  EXPECT_EQ(s.backend, to_string(GetParam().backend)) << "the back end that was asked for did not run";
  EXPECT_FALSE(s.device.empty());
  EXPECT_GT(s.threads, 0u);
  if (GetParam().threads > 0) {
    EXPECT_EQ(s.threads, GetParam().threads);
  }
  EXPECT_EQ(s.points, xy.size() / 2);
  EXPECT_EQ(s.distinct, xy.size() / 2 - mesh.duplicates().size());
  EXPECT_GT(s.launches, 0u);
  EXPECT_GT(s.splits + s.edge_splits, s.distinct / 2);
  EXPECT_GT(s.edge_splits, 0u) << "grid points lie on edges of earlier ones";
  EXPECT_LE(s.splits + s.edge_splits, s.distinct);
  EXPECT_GT(s.flips, 0u);
  EXPECT_GT(s.ties, 0u);
  EXPECT_GE(s.legality_sweeps, 1u);
  EXPECT_GE(s.certified_edges, 3 * s.distinct - 3 - 2 * mesh.hull().size()) << "interior edges, each examined";
  EXPECT_GT(s.bytes_device_peak, 0u);
  EXPECT_FALSE(s.milliseconds.empty());
  for (const auto& [phase, time] : s.milliseconds) EXPECT_GE(time, 0.0) << phase;
}

TEST_P(Result, MovesLeaveAnEmptyOrEqualObject) {
  const Points xy = mixed_points();
  Triangulation mesh = triangulate(Reals(xy), GetParam().options());
  const auto triangles = copy(mesh.triangles());
  Triangulation other = std::move(mesh);
  EXPECT_EQ(copy(other.triangles()), triangles);
  mesh = std::move(other);
  EXPECT_EQ(copy(mesh.triangles()), triangles);
}
CADT_ON_EVERY_BACKEND(Result);

}  // namespace
}  // namespace cadt::test
