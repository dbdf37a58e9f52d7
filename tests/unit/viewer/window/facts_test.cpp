// SPDX-License-Identifier: Apache-2.0
// What is said of a triangle, its circle, and Voronoi cells in view.
#include "viewer/window/facts.hpp"
#include "viewer/window/overlays.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cadt::viewer {
namespace {

Camera unit_camera() { return {Extent{{0, 0}, {1, 1}}, 800, 800}; }

TEST(Facts, OfARightTriangle) {
  const TriangleFacts facts = facts_of(5, {7, 8, 9}, {Place{0, 0}, Place{4, 0}, Place{0, 3}});
  ASSERT_TRUE(facts.circle);
  EXPECT_DOUBLE_EQ(facts.circle->centre[0], 2);
  EXPECT_DOUBLE_EQ(facts.circle->centre[1], 1.5);
  EXPECT_DOUBLE_EQ(facts.circle->radius, 2.5);
  EXPECT_DOUBLE_EQ(facts.area, 6);
  EXPECT_NEAR(facts.smallest_angle, std::atan2(3, 4) * 180 / 3.14159265358979, 1e-9);
}

TEST(Facts, OfTrianglesOfAnySize) {
  for (const double s : {1e-300, 1e-170, 1e-110, 1e110, 1e160, 4e307}) {
    const TriangleFacts facts = facts_of(0, {0, 1, 2}, {Place{-2 * s, 0}, Place{2 * s, 0}, Place{-2 * s, 3 * s}});
    ASSERT_TRUE(facts.circle) << s;
    EXPECT_NEAR(facts.circle->centre[0] / s, 0, 1e-12) << s;
    EXPECT_DOUBLE_EQ(facts.circle->centre[1], 1.5 * s);
    EXPECT_DOUBLE_EQ(facts.circle->radius, 2.5 * s);
    EXPECT_NEAR(facts.smallest_angle, std::atan2(3, 4) * 180 / 3.14159265358979, 1e-9) << s;
    if (s > 1e-150 && s < 1e150) {
      EXPECT_NEAR(facts.area / s / s, 6, 1e-12);
    }
  }
}

TEST(Facts, AreWrittenWithAllDigits) {
  TriangleFacts facts = facts_of(5, {7, 8, 9}, {Place{0.1, 0}, Place{500000.123456789, 0}, Place{0, 3}});
  auto lines = lines_of(facts);
  EXPECT_EQ(lines[0].second, "5");
  EXPECT_EQ(lines[1], std::pair(std::string("point 7"), std::string("0.1\n0")));
  EXPECT_EQ(lines[2].second, "500000.123456789\n0");
  EXPECT_EQ(lines[4], std::pair(std::string("neighbours"), std::string("known of the finished mesh")));
  facts.neighbours = {1, -1, 3};
  EXPECT_EQ(lines_of(facts)[4].second, "1, none, 3");
}

TEST(Facts, OfPointsOnALine) {
  const TriangleFacts facts = facts_of(0, {0, 1, 2}, {Place{0, 0}, Place{1, 1}, Place{2, 2}});
  EXPECT_FALSE(facts.circle);
  EXPECT_EQ(facts.area, 0);
  EXPECT_EQ(lines_of(facts)[5].second, "beyond the largest double");
}

/// Every place of the arc is on the circle, in pixels.
void expect_on_circle(const Circle& circle, double tolerance) {
  const Camera camera = unit_camera();
  const auto arc = visible_arc(circle, camera);
  ASSERT_FALSE(arc.empty());
  const Place middle = camera.pixel(circle.centre[0], circle.centre[1]);
  for (const auto& p : arc)
    EXPECT_NEAR(std::hypot(static_cast<double>(p[0]) - middle[0], static_cast<double>(p[1]) - middle[1]),
                circle.radius * camera.scale(), tolerance);
}

TEST(Arc, IsTheWholeCircleIfItIsSmall) {
  expect_on_circle({{0.5, 0.5}, 0.1}, 1e-3);
  const auto arc = visible_arc({{0.5, 0.5}, 0.1}, unit_camera());
  EXPECT_NEAR(arc.front()[0], arc.back()[0], 1e-3);
  EXPECT_NEAR(arc.front()[1], arc.back()[1], 1e-3);
}

TEST(Arc, OfAHugeCircleIsWhatIsSeen) {
  const Circle circle{{0.5 + 1e6, 0.5}, 1e6};  // through the middle, almost straight
  expect_on_circle(circle, 1);
  const Camera camera = unit_camera();
  std::size_t inside = 0;
  for (const auto& p : visible_arc(circle, camera)) inside += p[1] > 0 && p[1] < 800 ? 1 : 0;
  EXPECT_GT(inside, 20u) << "the part in the picture has many pieces";
}

TEST(Arc, IsEmptyWhereNothingIsSeen) {
  EXPECT_TRUE(visible_arc({{50, 50}, 0.1}, unit_camera()).empty());
  EXPECT_TRUE(visible_arc({{0.5, 0.5}, 1e-6}, unit_camera()).empty()) << "smaller than a pixel";
  EXPECT_TRUE(visible_arc({{1e300, 0}, 1e305}, unit_camera()).empty());
}

TEST(Voronoi, OfASquareWithItsMiddleHasFourEdgesAndFourRays) {
  const std::vector<double> xy{0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5};
  const Triangulation mesh = triangulate(xy);
  Options host;
  host.backend = Backend::host;
  const VoronoiDiagram diagram = MeshQueries(xy, mesh, host).voronoi();
  const VoronoiLines lines = voronoi_lines(xy, diagram, unit_camera(), 100);
  EXPECT_EQ(lines.in_view, 8u);
  std::size_t rays = 0;
  for (const auto& s : lines.segments) {
    const bool ends_outside = s[2] < -0.1 || s[2] > 1.1 || s[3] < -0.1 || s[3] > 1.1;
    rays += ends_outside ? 1 : 0;
    // Rays leave the square at right angles to its sides.
    if (!ends_outside) continue;
    EXPECT_TRUE(s[0] == s[2] || s[1] == s[3]);
    EXPECT_GT(std::hypot(s[2] - 0.5, s[3] - 0.5), std::hypot(s[0] - 0.5, s[1] - 0.5));
  }
  EXPECT_EQ(rays, 4u);
}

TEST(Voronoi, TooManyLinesAreCountedAndNotDrawn) {
  const std::vector<double> xy{0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5};
  Options host;
  host.backend = Backend::host;
  const VoronoiDiagram diagram = MeshQueries(xy, triangulate(xy), host).voronoi();
  const VoronoiLines lines = voronoi_lines(xy, diagram, unit_camera(), 7);
  EXPECT_EQ(lines.in_view, 8u);
  EXPECT_TRUE(lines.segments.empty());
  Camera elsewhere = unit_camera();
  elsewhere.zoom(1000, 20, 790);  // the lower left corner: its cell has no edge there
  EXPECT_EQ(voronoi_lines(xy, diagram, elsewhere, 7).in_view, 0u);
}

}  // namespace
}  // namespace cadt::viewer
