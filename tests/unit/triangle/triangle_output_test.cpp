// SPDX-License-Identifier: Apache-2.0
// A mesh as Triangle arranges it.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <type_traits>

namespace cadt {
namespace {

using Indices = std::vector<std::int32_t>;
using Values = std::vector<double>;

/// A square with its middle, and the first corner once more. Attributes: x + y, 7. Markers by number of point.
const Values square = {0, 0, 2, 0, 2, 2, 0, 2, 1, 1, 0, 0};
const Values attributes = {0, 7, 2, 7, 4, 7, 2, 7, 2, 7, 100, 7};
const std::vector<int> numbers = {0, 5, 0, -1, 0, 9};

Triangulation mesh_of(const Values& xy) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  return triangulate(xy, options);
}

TriangleInput input_of(const Values& xy) {
  TriangleInput input;
  input.xy = xy;
  return input;
}

static_assert(!std::is_copy_constructible_v<TriangleOutput>);  // its views would point to the other's members

TEST(TriangleOutput, MarksTheHullUnlessThereIsAMarker) {
  const Triangulation mesh = mesh_of(square);
  TriangleInput input = input_of(square);
  EXPECT_EQ(triangle_output(input, mesh, {}).markers, (std::vector<int>{1, 1, 1, 1, 0, 0}));
  input.markers = numbers;
  EXPECT_EQ(triangle_output(input, mesh, {}).markers, (std::vector<int>{1, 5, 1, -1, 0, 9}));
}

TEST(TriangleOutput, HasWhatIsAskedForOnly) {
  const Triangulation mesh = mesh_of(square);
  const TriangleOutput plain = triangle_output(input_of(square), mesh, {});
  EXPECT_EQ(plain.number_of_edges, 8U);
  EXPECT_EQ(plain.segments, (Indices{0, 1, 1, 2, 2, 3, 3, 0}));
  EXPECT_EQ(plain.triangles.size(), 12U);
  EXPECT_TRUE(plain.edges.empty() && plain.centers.empty() && plain.rays.empty());
  TriangleSwitches edges;
  edges.edges = true;
  const TriangleOutput with_edges = triangle_output(input_of(square), mesh, edges);
  EXPECT_EQ(with_edges.edges.size(), 16U);
  EXPECT_TRUE(with_edges.centers.empty() && with_edges.rays.empty());
}

TEST(TriangleOutput, ContinuesAttributesToTheCenters) {
  const Triangulation mesh = mesh_of(square);
  TriangleInput input = input_of(square);
  input.attributes = attributes;
  input.attributes_per_point = 2;
  TriangleSwitches voronoi;
  voronoi.voronoi = true;
  const TriangleOutput out = triangle_output(input, mesh, voronoi);
  ASSERT_EQ(out.centers.size(), 8U);
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_EQ(out.center_attributes[2 * t], out.centers[2 * t] + out.centers[2 * t + 1]);
    EXPECT_EQ(out.center_attributes[2 * t + 1], 7);
  }
}

/// Every edge once, between its triangles, the first on the left; centres in the middle; rays outwards.
void expect_consistent(const Values& xy) {
  const Triangulation mesh = mesh_of(xy);
  TriangleSwitches voronoi;
  voronoi.voronoi = true;
  const TriangleOutput out = triangle_output(input_of(xy), mesh, voronoi);
  ASSERT_EQ(out.edges.size(), 2 * out.number_of_edges);
  ASSERT_EQ(out.edge_triangles.size(), 2 * out.number_of_edges);
  ASSERT_EQ(out.rays.size(), 2 * out.number_of_edges);
  const auto t = mesh.triangles();
  const auto has_side = [&](std::int32_t triangle, std::int32_t a, std::int32_t b) {
    const auto at = 3 * static_cast<std::size_t>(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[at + k] == a && t[at + (k + 1) % 3] == b) return true;
    }
    return false;
  };
  std::set<std::pair<std::int32_t, std::int32_t>> seen;
  std::size_t outside = 0;
  for (std::size_t e = 0; e < out.edges.size(); e += 2) {
    const std::int32_t a = out.edges[e], b = out.edges[e + 1], left = out.edge_triangles[e],
                       right = out.edge_triangles[e + 1];
    EXPECT_TRUE(seen.insert(std::minmax(a, b)).second);
    EXPECT_TRUE(has_side(left, a, b));
    const auto pa = 2 * static_cast<std::size_t>(a), pb = 2 * static_cast<std::size_t>(b);
    if (right >= 0) {
      EXPECT_TRUE(has_side(right, b, a));
      EXPECT_EQ(out.rays[e], 0);
      EXPECT_EQ(out.rays[e + 1], 0);
    } else {
      ++outside;
      EXPECT_EQ(out.rays[e], xy[pb + 1] - xy[pa + 1]);
      EXPECT_EQ(out.rays[e + 1], xy[pa] - xy[pb]);
    }
  }
  EXPECT_EQ(outside, mesh.hull().size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto v = 2 * static_cast<std::size_t>(t[i]), w = 2 * static_cast<std::size_t>(t[i / 3 * 3]), c = i / 3 * 2;
    const double r = std::hypot(out.centers[c] - xy[w], out.centers[c + 1] - xy[w + 1]);
    EXPECT_NEAR(std::hypot(out.centers[c] - xy[v], out.centers[c + 1] - xy[v + 1]), r, 1e-12 * (1 + r));
  }
}

TEST(TriangleOutput, EdgesAndVoronoiEdgesFit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> real(0, 1);
  Values xy(1000);
  for (double& v : xy) v = real(random);
  expect_consistent(xy);
  for (double& v : xy) v = std::floor(8 * v);  // a lattice with many duplicates
  expect_consistent(xy);
  expect_consistent({0, 0, 1, 0, 0, 1});
}

TEST(TriangleOutput, RaysOfTheLargestNumbersAreFinite) {
  const double m = std::numeric_limits<double>::max();
  const Values xy = {-m, -m, m, -m, m, m, -m, m};
  TriangleSwitches voronoi;
  voronoi.voronoi = true;
  const Triangulation mesh = mesh_of(xy);
  const TriangleOutput out = triangle_output(input_of(xy), mesh, voronoi);
  ASSERT_FALSE(out.edges.empty());
  for (std::size_t e = 0; e < out.edges.size(); e += 2) {
    EXPECT_TRUE(std::isfinite(out.rays[e]) && std::isfinite(out.rays[e + 1]));
    EXPECT_EQ(out.rays[e] != 0 || out.rays[e + 1] != 0, out.edge_triangles[e + 1] < 0);
  }
}

TEST(TriangleOutput, JettisonNumbersTheVerticesAnew) {
  // Point 1 equals point 0 and point 4 equals point 2.
  const Values xy = {0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1};
  const Values values = {10, 11, 12, 13, 14, 15};
  const std::vector<int> marks = {3, 4, 0, 6, 7, 8};
  TriangleInput input = input_of(xy);
  input.attributes = values;
  input.attributes_per_point = 1;
  input.markers = marks;
  TriangleSwitches use;
  use.jettison = use.edges = use.voronoi = true;
  const Triangulation mesh = mesh_of(xy);
  const TriangleOutput moved = triangle_output(input, mesh, use);
  TriangleOutput out;
  out = TriangleOutput(triangle_output(input, mesh, use));  // views survive a move
  EXPECT_EQ(Values(out.xy.begin(), out.xy.end()), (Values{0, 0, 1, 0, 0, 1, 1, 1}));
  EXPECT_EQ(Values(out.attributes.begin(), out.attributes.end()), (Values{10, 12, 13, 15}));
  EXPECT_EQ(out.markers, (std::vector<int>{3, 1, 6, 8}));
  EXPECT_EQ(out.segments, (Indices{0, 1, 1, 3, 3, 2, 2, 0}));
  const Triangulation alone = mesh_of({0, 0, 1, 0, 0, 1, 1, 1});
  EXPECT_TRUE(
      std::equal(out.triangles.begin(), out.triangles.end(), alone.triangles().begin(), alone.triangles().end()));
  EXPECT_EQ(out.edges, triangle_output(input_of({0, 0, 1, 0, 0, 1, 1, 1}), alone, use).edges);
  EXPECT_EQ(out.edge_triangles, moved.edge_triangles);
  EXPECT_EQ(out.centers, moved.centers);
}

TEST(TriangleOutput, OfALineIsEmpty) {
  const Values xy = {0, 0, 1, 1, 2, 2, 3, 3};
  TriangleSwitches use;
  use.edges = use.voronoi = true;
  const Triangulation mesh = mesh_of(xy);
  const TriangleOutput out = triangle_output(input_of(xy), mesh, use);
  EXPECT_EQ(out.number_of_edges, 0U);
  EXPECT_TRUE(out.edges.empty() && out.segments.empty() && out.centers.empty() && out.triangles.empty());
  EXPECT_EQ(out.markers, (std::vector<int>{0, 0, 0, 0}));
}

TEST(TriangleOutput, RefusesArraysThatDoNotFit) {
  const Triangulation mesh = mesh_of(square);
  const auto expect_refused = [&](const TriangleInput& input, const char* part) {
    try {
      static_cast<void>(triangle_output(input, mesh, {}));
      ADD_FAILURE() << part;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  TriangleInput input = input_of(square);
  input.xy = std::span(square).first(11);
  expect_refused(input, "no pairs");
  input.xy = std::span(square).first(10);
  expect_refused(input, "it has 6 points, not 5");
  input = input_of(square);
  input.attributes = attributes;
  input.attributes_per_point = 1;
  expect_refused(input, "12 attributes for 6 points with 1 each");
  input = input_of(square);
  input.markers = std::span(numbers).first(3);
  expect_refused(input, "3 markers for 6 points");
}

}  // namespace
}  // namespace cadt
