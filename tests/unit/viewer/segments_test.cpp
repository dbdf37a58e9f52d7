// SPDX-License-Identifier: Apache-2.0
// Pictures of meshes with segments: constrained edges, regions, and what is left out.
#include "viewer/still/still.hpp"

#include <cadt/constrained.hpp>
#include <cadt/io/generate.hpp>

#include "io/picture/colour.hpp"
#include "viewer/draw/palette.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

namespace cadt::viewer {
namespace {

constexpr int side = 101;  // pixels: one is in the middle

std::array<int, 3> middle(const Image& image) {
  const std::uint8_t* p = image.rgba.data() + std::ptrdiff_t{4} * (side * (side / 2) + side / 2);
  return {p[0], p[1], p[2]};
}

/// The largest difference of a channel.
int difference(const std::array<int, 3>& a, std::uint32_t rgb) {
  const std::array<int, 3> b{static_cast<int>(rgb >> 16), static_cast<int>(rgb >> 8 & 255),
                             static_cast<int>(rgb & 255)};
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// The pixel in the middle of a picture around a place.
std::array<int, 3> pixel_at(const io::RegionMesh& mesh, double x, double y, double magnification,
                            StillOptions options = {}) {
  options.width = options.height = side;
  options.view = View{x, y, magnification};
  return middle(draw_still(mesh, options));
}

/// A square with a square hole, and its constrained triangulation.
struct Plate {
  std::vector<double> xy{0, 0, 8, 0, 8, 8, 0, 8, 2, 2, 6, 2, 6, 6, 2, 6};
  ConstrainedTriangulation mesh;
  std::vector<std::int32_t> triangles, region;

  explicit Plate(Domain domain) {
    const std::vector<Segment> rings{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
    ConstraintOptions constraints;
    constraints.domain = domain;
    mesh = triangulate_constrained(std::span<const double>(xy), rings, constraints);
    triangles = mesh.triangles_inside();
    for (std::size_t t = 0; t < mesh.inside().size(); ++t)
      if (mesh.inside()[t] != 0) region.push_back(mesh.region()[t]);
  }
  [[nodiscard]] io::RegionMesh drawn() const {
    return {.xy = xy,
            .height = {},
            .triangles = triangles,
            .region = region,
            .region_name = {},
            .segments = mesh.constrained_edges(),
            .hull = mesh.mesh().hull()};
  }
};

TEST(SegmentPictures, ConstrainedEdgesAreSeenAtEachMagnification) {
  io::GenerateOptions many;
  many.n = 20'000;  // smaller than pixels when all are in view
  io::PointSet points = io::generate("uniform", many);
  const auto from = static_cast<std::int32_t>(points.size());
  points.xy.insert(points.xy.end(), {0.1, 0.5, 0.9, 0.5});
  const std::vector<Segment> segments{{from, from + 1}};
  const ConstrainedTriangulation mesh = triangulate_constrained(points.view(), segments);
  const io::RegionMesh drawn{points.xy, {}, mesh.mesh().triangles(), {}, {}, mesh.constrained_edges(), {}};
  const io::RegionMesh plain{points.xy, {}, mesh.mesh().triangles(), {}, {}, {}, {}};
  for (const bool dark : {false, true}) {
    StillOptions options;
    options.style.dark = dark;
    const std::uint32_t edge = palette(dark).edge;
    for (const double magnification : {0.25, 1.0, 30.0, 1e6}) {
      EXPECT_LE(difference(pixel_at(drawn, 0.43, 0.5, magnification, options), edge), 1) << magnification;
      EXPECT_GT(difference(pixel_at(plain, 0.43, 0.5, magnification, options), edge), 25) << magnification;
    }
  }
  StillOptions dots;
  dots.style.points_alone = true;
  EXPECT_GT(difference(pixel_at(drawn, 0.43, 0.5, 1e6, dots), palette(false).edge), 60) << "points alone";
}

TEST(SegmentPictures, WhatIsOutsideIsBackground) {
  const Plate all(Domain::hull), inside(Domain::even_odd);
  EXPECT_EQ(difference(pixel_at(inside.drawn(), 4, 4.5, 3), palette(false).background), 0);
  EXPECT_GT(difference(pixel_at(all.drawn(), 4, 4.5, 3), palette(false).background), 20);
  EXPECT_GT(difference(pixel_at(inside.drawn(), 1.1, 4.5, 30), palette(false).background), 5);
}

TEST(SegmentPictures, RegionsHaveColoursOfTheirOwn) {
  const Plate plate(Domain::hull);
  ASSERT_EQ(plate.mesh.number_of_regions(), 2U);
  StillOptions without_lines;
  without_lines.style.line_width = 0;
  const auto colour = [](std::size_t n) { return io::picture::to_srgb(io::picture::region_colour(n)); };
  // Regions are numbered by their lowest triangles: that of the outline is the first.
  EXPECT_LE(difference(pixel_at(plate.drawn(), 1.1, 4.5, 30, without_lines), colour(0)), 2);
  EXPECT_LE(difference(pixel_at(plate.drawn(), 4.3, 4.5, 30, without_lines), colour(1)), 2);
  without_lines.colour = ColourBy::nothing;
  EXPECT_LE(difference(pixel_at(plate.drawn(), 4.3, 4.5, 30, without_lines), palette(false).fill), 2);
  // Only what there is of numbers counts, so that pictures of all formats have the same colours.
  io::RegionMesh other = plate.drawn();
  std::vector<std::int32_t> far;
  for (const std::int32_t region : plate.region) far.push_back(1'000'000 * region + 7);
  other.region = far;
  without_lines.colour.reset();
  EXPECT_LE(difference(pixel_at(other, 4.3, 4.5, 30, without_lines), colour(1)), 2);
}

TEST(SegmentPictures, TheHullIsDrawnWhereItIsNoSegment) {
  const Plate plate(Domain::hull);
  io::RegionMesh drawn = plate.drawn();
  EXPECT_LE(difference(pixel_at(drawn, 4, 0, 10), palette(false).edge), 1);
  drawn.segments = drawn.segments.subspan(1);  // the lowest one, 0 1
  EXPECT_LE(difference(pixel_at(drawn, 4, 0, 10), palette(false).hull), 40);
  EXPECT_LE(difference(pixel_at(drawn, 8, 4, 10), palette(false).edge), 1);
}

TEST(SegmentPictures, SegmentsOnALineAreDrawnWithoutTriangles) {
  const std::vector<double> xy{0, 0, 1, 1, 2, 2};
  const std::vector<Segment> segments{{0, 1}};
  const io::RegionMesh drawn{xy, {}, {}, {}, {}, segments, {}};
  EXPECT_LE(difference(pixel_at(drawn, 0.5, 0.5, 1), palette(false).edge), 1);
  EXPECT_EQ(difference(pixel_at(drawn, 1.5, 1.5, 1), palette(false).background), 0);
}

}  // namespace
}  // namespace cadt::viewer
