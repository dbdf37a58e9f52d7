// SPDX-License-Identifier: Apache-2.0
// A mesh of points and segments as Triangle arranges it: switch p.
#include <cadt/triangle.hpp>

#include <gtest/gtest.h>
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace cadt {
namespace {

using Indices = std::vector<std::int32_t>;
using Ints = std::vector<int>;

/// A square of width 4 with a square hole of width 2 and a point in it; a wall from the outer to the inner square; and
/// a dangling segment outside of all.
struct Plate {
  std::vector<double> xy{0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 3, 1, 3, 3, 1, 3, 2, 2, 6, 0, 6, 1};
  std::vector<double> attributes{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  Ints point_markers{0, 0, -3, 0, 0, 0, 0, 0, 0, 0, 0};
  std::vector<Segment> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5},  {5, 6},
                                {6, 7}, {7, 4}, {0, 4}, {2, 6}, {9, 10}, {5, 4}};
  Ints segment_markers{7, 0, 0, 0, 0, 0, 0, 0, 0, 5, 8, 6};
  std::vector<std::array<double, 2>> holes{{2.0, 2.5}};
  std::vector<Region> regions{{3.5, 0.5, 11}, {0.5, 3.5, 22}};

  [[nodiscard]] TriangleInput input() const { return {xy, attributes, 1, point_markers}; }
  [[nodiscard]] TriangleSegments constraints() const { return {segments, segment_markers, holes, regions}; }
  [[nodiscard]] TriangleOutput run(const char* letters) const {
    const TriangleSwitches switches = parse_triangle_switches(letters);
    Options options;
    options.backend = Backend::host;
    options.threads = 1;
    return triangle_output(input(), constraints(), triangulate_as_triangle(input(), constraints(), switches, options),
                           switches);
  }
};

double area(const TriangleOutput& out) {
  double sum = 0;
  for (std::size_t t = 0; t < out.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) { return &out.xy[2 * static_cast<std::size_t>(out.triangles[t + k])]; };
    const double *a = at(0), *b = at(1), *c = at(2);
    const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    EXPECT_GT(twice, 0);
    sum += twice / 2;
  }
  return sum;
}

/// Markers by the ends of segments or edges.
std::map<Segment, int> by_ends(const Indices& pairs, const Ints& markers) {
  EXPECT_EQ(pairs.size(), 2 * markers.size());
  std::map<Segment, int> result;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    result[{std::min(pairs[2 * i], pairs[2 * i + 1]), std::max(pairs[2 * i], pairs[2 * i + 1])}] = markers[i];
  }
  EXPECT_EQ(result.size(), markers.size());
  return result;
}

TEST(TriangleSegments, HolesAndWhatIsOutsideAreEaten) {
  const Plate plate;
  const TriangleOutput out = plate.run("pne");
  EXPECT_EQ(area(out), 12);
  EXPECT_EQ(out.triangles.size() / 3, 8U);
  EXPECT_EQ(out.number_of_edges, 16U);
  EXPECT_EQ(out.edges.size(), 32U);
  EXPECT_EQ(out.xy.size(), plate.xy.size());
  ASSERT_EQ(out.neighbors.size(), out.triangles.size());
  std::size_t outside = 0;
  for (std::size_t i = 0; i < out.neighbors.size(); ++i) {
    const std::int32_t other = out.neighbors[i];
    if (other < 0) {
      ++outside;
      continue;
    }
    const auto row = out.neighbors.subspan(3 * static_cast<std::size_t>(other), 3);
    EXPECT_NE(std::find(row.begin(), row.end(), static_cast<std::int32_t>(i / 3)), row.end());
  }
  EXPECT_EQ(outside, 8U);
}

TEST(TriangleSegments, HaveTheMarkersOfTheInput) {
  const Plate plate;
  const TriangleOutput out = plate.run("pe");
  const std::map<Segment, int> segments = by_ends(out.segments, out.segment_markers);
  EXPECT_EQ(segments, (std::map<Segment, int>{{{0, 1}, 7},
                                              {{1, 2}, 1},
                                              {{2, 3}, 1},
                                              {{0, 3}, 1},
                                              {{4, 5}, 6},  // the second of two segments there; the first has 0
                                              {{5, 6}, 1},
                                              {{6, 7}, 1},
                                              {{4, 7}, 1},
                                              {{0, 4}, 0},
                                              {{2, 6}, 5}}));
  for (const auto& [ends, marker] : by_ends(out.edges, out.edge_markers)) {
    const auto segment = segments.find(ends);
    EXPECT_EQ(marker, segment == segments.end() ? 0 : segment->second) << ends[0] << " " << ends[1];
  }
  EXPECT_EQ(out.markers, (Ints{7, 7, -3, 1, 6, 6, 5, 1, 0, 8, 8}));
}

TEST(TriangleSegments, RegionsHaveAttributes) {
  const Plate plate;
  const TriangleOutput out = plate.run("pA");
  ASSERT_EQ(out.triangle_attributes.size(), out.triangles.size() / 3);
  for (std::size_t t = 0; t < out.triangle_attributes.size(); ++t) {
    double x = 0, y = 0;
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) {
      x += out.xy[2 * static_cast<std::size_t>(out.triangles[k])];
      y += out.xy[2 * static_cast<std::size_t>(out.triangles[k]) + 1];
    }
    EXPECT_EQ(out.triangle_attributes[t], x > y ? 11 : 22);
  }
  EXPECT_TRUE(plate.run("p").triangle_attributes.empty());
  EXPECT_EQ(out.holes.size(), 1U);
  EXPECT_EQ(out.regions.size(), 2U);
}

TEST(TriangleSegments, TheLastRegionThereCounts) {
  Plate plate;
  plate.regions = {{3.5, 0.5, 11}, {0.5, 3.5, 22}, {3.5, 3, 33}};
  const TriangleOutput out = plate.run("pA");
  EXPECT_EQ(std::set<double>(out.triangle_attributes.begin(), out.triangle_attributes.end()),
            (std::set<double>{22, 33}));
  EXPECT_EQ(out.regions[0].attribute, 11);
  plate.regions[1].y = std::numeric_limits<double>::infinity();
  try {
    static_cast<void>(plate.run("pA"));
    FAIL() << "a region at infinity";
  } catch (const OptionError& e) {
    EXPECT_NE(std::string(e.what()).find("place 1 is not finite"), std::string::npos) << e.what();
  }
}

TEST(TriangleSegments, MarkThePointsOfThoseThatAreEaten) {
  Plate plate;
  plate.xy = {0, 0, 4, 0, 4, 4, 0, 4, 9, 9};
  plate.attributes = {0, 0, 0, 0, 0};
  plate.point_markers = {0, 0, 0, 0, 0};
  plate.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 4}};
  plate.segment_markers = {0, 0, 0, 0, 7};
  plate.holes = {};
  plate.regions = {};
  const TriangleOutput out = plate.run("p");
  EXPECT_EQ(out.markers, (Ints{1, 1, 7, 1, 7}));
  EXPECT_EQ(out.segment_markers, (Ints{1, 1, 1, 1}));
}

/// Not that of the edge with the lower points.
TEST(TriangleSegments, MarkTheirPointsByTheFirstOneThatHasAMarker) {
  Plate plate;
  plate.xy = {0, 0, 4, 0, 4, 4, 0, 4};
  plate.attributes = {0, 0, 0, 0};
  plate.point_markers = {};
  plate.segments = {{2, 3}, {3, 0}, {1, 2}, {0, 1}};
  plate.segment_markers = {0, 5, 6, 7};
  plate.holes = {};
  plate.regions = {};
  EXPECT_EQ(plate.run("p").markers, (Ints{5, 6, 6, 5}));
}

/// The last two cross so close to the end of the first that their crossing is rounded across it.
TEST(TriangleSegments, ThatCrossTooCloseToOthersAreNamed) {
  Plate plate;
  plate.xy = {1031.9802955665025, 332, 968, 332, 1024, 512, 1033, 309, 0, 0, 2000, 0, 2000, 2000, 500, -1, 500, 1};
  plate.attributes = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  plate.point_markers = {};
  plate.segments = {{4, 5}, {5, 6}, {6, 4}, {0, 1}, {7, 8}, {2, 3}};
  plate.segment_markers = {};
  plate.holes = {};
  plate.regions = {};
  try {
    static_cast<void>(plate.run("p"));
    FAIL() << "a triangle is turned over";
  } catch (const CrossingError& e) {
    EXPECT_EQ(e.pairs(), (std::vector<std::array<std::int32_t, 2>>{{3, 5}}));
    EXPECT_NE(std::string(e.what()).find("segments 3 and 5, counted from 0,"), std::string::npos) << e.what();
  }
}

TEST(TriangleSegments, HolesCanBeIgnored) {
  const Plate plate;
  EXPECT_EQ(area(plate.run("pO")), 16);
}

TEST(TriangleSegments, TheHullCanBeASegment) {
  const Plate plate;
  const TriangleOutput out = plate.run("pc");
  EXPECT_EQ(area(out), 16 + 5 - 4);  // the square, what is right of it in the hull, and the hole
  const std::map<Segment, int> segments = by_ends(out.segments, out.segment_markers);
  EXPECT_EQ(segments.at({2, 10}), 1);
  EXPECT_EQ(segments.at({9, 10}), 8);
  EXPECT_EQ(segments.at({1, 2}), 0) << "inside now";
}

TEST(TriangleSegments, PointsThatAreEatenCanBeLeftOut) {
  const Plate plate;
  const TriangleOutput out = plate.run("pj");
  EXPECT_EQ(out.xy.size() / 2, 8U);
  EXPECT_EQ(out.attributes.size(), 8U);
  EXPECT_EQ(area(out), 12);
  EXPECT_EQ(out.markers, (Ints{7, 7, -3, 1, 6, 6, 5, 1}));
  EXPECT_EQ(by_ends(out.segments, out.segment_markers).size(), 10U);
}

TEST(TriangleSegments, NothingIsLeftOfOpenOnes) {
  Plate plate;
  plate.segments = {{0, 1}, {1, 2}};
  plate.segment_markers = {1, 1};
  const TriangleOutput out = plate.run("pne");
  EXPECT_TRUE(out.triangles.empty() && out.segments.empty() && out.edges.empty());
  EXPECT_EQ(out.number_of_edges, 0U);
}

TEST(TriangleSegments, RefuseWrongNumbersOfMarkers) {
  Plate plate;
  plate.segment_markers.pop_back();
  EXPECT_THROW(static_cast<void>(plate.run("p")), InputError);
}

TEST(TriangleSegments, GetAVertexWhereTheyCross) {
  Plate plate;
  plate.xy = {0, 0, 4, 0, 4, 4, 0, 4, 2, 0, 0, 2};
  plate.attributes = {0, 10, 20, 50, 7, 7};
  plate.point_markers = {};
  plate.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {4, 5}};
  plate.segment_markers = {0, 0, 0, 0, 4, 9};
  plate.holes = {};
  plate.regions = {};
  const TriangleOutput out = plate.run("p");
  ASSERT_EQ(out.xy.size(), 14U);
  EXPECT_EQ(out.xy[12], 1);
  EXPECT_EQ(out.xy[13], 1);
  EXPECT_EQ(out.attributes[6], 5) << "on the first of the two segments";
  EXPECT_EQ(out.triangles.size() / 3, 6U);
  EXPECT_EQ(area(out), 16);
  EXPECT_EQ(out.markers, (Ints{4, 1, 4, 1, 9, 9, 4}));
  const std::map<Segment, int> segments = by_ends(out.segments, out.segment_markers);
  EXPECT_EQ(segments.size(), 10U);
  EXPECT_EQ(segments.at({0, 6}), 4);
  EXPECT_EQ(segments.at({5, 6}), 9);
}

/// Between two points of the first segment, not between its ends.
TEST(TriangleSegments, HaveAttributesOfTheNearestPointsWhereTheyCross) {
  for (const double scale : {1.0, 1e307, 0x1p-1070}) {
    Plate plate;
    plate.xy = {-10, 0, 10, 0, 9, 0, 9.5, -1, 9.5, 1, -0.5, -1, -0.5, 1};
    for (double& v : plate.xy) v *= scale;
    plate.attributes = {0, 4, 0, 10, 100, 0, 7, 1, 7, 1, 7, 1, 7, 1};
    plate.point_markers = {};
    plate.segments = {{1, 0}, {3, 4}, {5, 6}};
    plate.segment_markers = {};
    plate.holes = {};
    plate.regions = {};
    const TriangleInput input{plate.xy, plate.attributes, 2, {}};
    const TriangleSwitches switches = parse_triangle_switches("pc");
    const TriangleOutput out = triangle_output(input, plate.constraints(),
                                               triangulate_as_triangle(input, plate.constraints(), switches), switches);
    ASSERT_EQ(out.xy.size(), 18U);
    EXPECT_EQ(out.xy[14], 9.5 * scale);
    EXPECT_NEAR(out.attributes[14], 50, 1e-9);
    EXPECT_NEAR(out.attributes[15], 5, 1e-9);
    EXPECT_EQ(out.xy[16], -0.5 * scale);
    EXPECT_NEAR(out.attributes[16], 50, 1e-9);
    EXPECT_NEAR(out.attributes[17], 2, 1e-9);
  }
}

}  // namespace
}  // namespace cadt
