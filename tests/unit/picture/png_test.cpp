// SPDX-License-Identifier: Apache-2.0
#include "io/picture/scene.hpp"
#include "io/picture/viewport.hpp"
#include "tests/unit/picture/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace {

using namespace cadt::io::picture;
using cadt::io::PictureOptions;
using cadt::test::decode;
using cadt::test::Image;
using cadt::test::Mesh;

Image draw(const Mesh& mesh, const PictureOptions& options = {.width = 400}) {
  return decode(png_bytes(mesh.scene(), options));
}

/// Least light within one pixel of a place in the plane.
int darkest(const Image& image, const Viewport& view, double x, double y) {
  const auto p = view.map(x, y);
  int least = 765;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      least = std::min(least, image.light(static_cast<int>(p.x) + dx, static_cast<int>(p.y) + dy));
    }
  }
  return least;
}

int light_at(const Image& image, const Viewport& view, double x, double y) {
  const auto p = view.map(x, y);
  return image.light(static_cast<int>(p.x), static_cast<int>(p.y));
}

TEST(Png, StrokesLieOnTheEdgesOnly) {
  const Mesh mesh = cadt::test::lattice(3);
  const Viewport view(mesh.xy, 400, 4000);
  const Image image = draw(mesh);
  ASSERT_EQ(image.width, view.width());
  ASSERT_EQ(image.height, view.height());
  const int ground = light_at(image, view, 0.6, 0.2);
  EXPECT_GT(ground, 500);
  for (const auto& [x, y] :
       std::vector<std::pair<double, double>>{{1, 0.4}, {0.4, 1}, {0.3, 0.3}, {1.6, 1.6}, {0, 1.5}}) {
    EXPECT_LT(darkest(image, view, x, y), ground - 150) << x << ' ' << y;
  }
  EXPECT_GT(darkest(image, view, 0.3, 0.7), ground - 30) << "the other diagonal is no edge";
  for (int i = 0; i < 400; ++i) {
    EXPECT_TRUE(image.is_paper(i, 0) && image.is_paper(0, i) && image.is_paper(i, 399) && image.is_paper(399, i)) << i;
  }
}

TEST(Png, OutsideOfTheHullIsPaper) {
  Mesh mesh;
  mesh.xy = {0, 0, 1, 0, 0, 1};
  mesh.triangles = {0, 1, 2};
  mesh.hull = {0, 1, 2};
  const Viewport view(mesh.xy, 400, 4000);
  const Image image = draw(mesh);
  const auto outside = view.map(0.8, 0.8);
  EXPECT_TRUE(image.is_paper(static_cast<int>(outside.x), static_cast<int>(outside.y)));
  const auto inside = view.map(0.2, 0.2);
  EXPECT_FALSE(image.is_paper(static_cast<int>(inside.x), static_cast<int>(inside.y)));
}

TEST(Png, WithoutShadeTheGroundIsPaper) {
  const Mesh mesh = cadt::test::lattice(3);
  const Viewport view(mesh.xy, 400, 4000);
  const Image image = draw(mesh, {.width = 400, .shade = false});
  const auto p = view.map(0.6, 0.2);
  EXPECT_TRUE(image.is_paper(static_cast<int>(p.x), static_cast<int>(p.y)));
  EXPECT_LT(darkest(image, view, 1, 0.4), 550);
}

TEST(Png, SlopesFacingTheUpperLeftAreLight) {
  for (const int m : {15, 150}) {
    Mesh mesh = cadt::test::lattice(m);
    const double middle = 0.5 * (m - 1);
    for (std::size_t i = 0; i < mesh.xy.size(); i += 2) {
      mesh.height.push_back(-std::fabs(mesh.xy[i] - middle));  // a ridge from top to bottom
    }
    const Viewport view(mesh.xy, 400, 4000);
    const Image image = draw(mesh);
    // Off the diagonals: inside the faces. Both sides have the same height.
    const int left = light_at(image, view, 0.5 * middle + 0.25, middle + 0.1);
    const int right = light_at(image, view, 1.5 * middle - 0.25, middle + 0.1);
    EXPECT_GT(left, right + 80) << m;
  }
}

TEST(Png, SameBytesForMeshesThatDifferByScaleAndShift) {
  const Mesh mesh = cadt::test::lattice(9);
  const std::string expected = png_bytes(mesh.scene(), {.width = 300});
  for (const auto& [scale, shift] :
       std::vector<std::pair<double, double>>{{0x1p-1000, 0.0}, {0x1p1000, 0.0}, {1.0, 0x1p50}, {0x1p-1074, 0.0}}) {
    EXPECT_TRUE(png_bytes(cadt::test::moved(mesh, scale, shift).scene(), {.width = 300}) == expected) << scale;
  }
}

TEST(Png, PointsAreDrawnWhereThereIsNoTriangle) {
  Mesh few;
  for (int i = 0; i <= 10; ++i) few.xy.insert(few.xy.end(), {i * 3.0, i * 2.0});
  Mesh many;
  for (int i = 0; i <= 50'000; ++i) many.xy.insert(many.xy.end(), {i * 3.0, i * 2.0});
  for (const Mesh* mesh : {&few, &many}) {
    const Viewport view(mesh->xy, 400, 4000);
    const Image image = draw(*mesh);
    const double x = mesh->xy[mesh->xy.size() / 4 * 2], y = mesh->xy[mesh->xy.size() / 4 * 2 + 1];
    EXPECT_LT(darkest(image, view, x, y), 600);
    EXPECT_TRUE(image.is_paper(5, 5));
  }
}

TEST(Png, NoPointOnePointAndPointsThatAreNotFinite) {
  const Image none = draw({});
  EXPECT_EQ(none.width, 400);
  EXPECT_TRUE(none.is_paper(none.width / 2, none.height / 2));
  Mesh one;
  one.xy = {1e300, -1e-300};
  const Image single = draw(one);
  EXPECT_FALSE(single.is_paper(single.width / 2, single.height / 2));

  Mesh broken = cadt::test::lattice(4);
  broken.xy[10] = std::numeric_limits<double>::quiet_NaN();
  const Image image = draw(broken);
  const Viewport view(broken.xy, 400, 4000);
  EXPECT_LT(darkest(image, view, 2.0, 2.4), 500);
}

TEST(Png, SkewedMeshesFinish) {
  Mesh flat = cadt::test::fan(5'000, 1.0);
  EXPECT_EQ(draw(flat, {.width = 2000}).width, 2000);
  // All but one point in a cell of 1e-12.
  Mesh tiny = cadt::test::moved(cadt::test::lattice(200), 1e-12 / 200.0, 0.5);
  tiny.xy.insert(tiny.xy.end(), {0.0, 0.0});
  EXPECT_EQ(draw(tiny).width, 400);
}

}  // namespace
