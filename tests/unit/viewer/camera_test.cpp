// SPDX-License-Identifier: Apache-2.0
#include "viewer/draw/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace cadt::viewer;

TEST(Camera, FitsTheBoxWithAMargin) {
  const Camera camera(Extent{{10, 20}, {30, 30}}, 400, 400);
  const auto low = camera.pixel(10, 20), high = camera.pixel(30, 30);
  EXPECT_NEAR(low[0], 6, 1e-9);  // 1.5 %
  EXPECT_NEAR(high[0], 394, 1e-9);
  EXPECT_NEAR(low[1], 200 + 97, 1e-9) << "y is up, the scale that of x";
  EXPECT_NEAR(high[1], 200 - 97, 1e-9);
  EXPECT_EQ(Camera::height_for(Extent{{10, 20}, {30, 30}}, 400, 4000), 206);
}

TEST(Camera, PlaceIsTheInverseOfPixel) {
  for (const Extent& box :
       {Extent{{0, 0}, {1, 1}}, Extent{{-1e300, -1e300}, {1e300, 1e300}}, Extent{{-1.7e308, 0}, {1.7e308, 1e308}},
        Extent{{0, 0}, {4e-320, 4e-320}}, Extent{{500000, 4100000}, {500100, 4100050}}}) {
    const Camera camera(box, 300, 200);
    for (const double s : {0.0, 0.25, 1.0}) {
      const double x = box.low[0] * (1 - s) + box.high[0] * s, y = box.low[1] * (1 - s) + box.high[1] * s;
      const auto p = camera.pixel(x, y);
      EXPECT_TRUE(p[0] > 0 && p[0] < 300 && p[1] > 0 && p[1] < 200) << box.high[0];
      const auto q = camera.place(p[0], p[1]);
      EXPECT_NEAR(camera.pixel(q[0], q[1])[0], p[0], 0.5) << box.high[0];
    }
  }
}

TEST(Camera, ZoomKeepsThePlaceUnderTheCursor) {
  Camera camera(Extent{{0, 0}, {1, 1}}, 300, 200);
  const auto before = camera.place(70, 150);
  for (const double factor : {2.0, 3.0, 10.0, 0.5}) {
    camera.zoom(factor, 70, 150);
    const auto after = camera.place(70, 150);
    EXPECT_NEAR(after[0], before[0], 1e-12);
    EXPECT_NEAR(after[1], before[1], 1e-12);
  }
  EXPECT_NEAR(camera.magnification(), 30, 1e-9);
}

TEST(Camera, PanMovesByPixels) {
  Camera camera(Extent{{0, 0}, {1, 1}}, 300, 200);
  const auto place = camera.place(100, 100);
  camera.pan(13, -7);
  const auto p = camera.pixel(place[0], place[1]);
  EXPECT_NEAR(p[0], 113, 1e-9);
  EXPECT_NEAR(p[1], 93, 1e-9);
  camera.pan(1e9, 1e9);
  EXPECT_GE(camera.pixel(0.5, 0.5)[0], 0) << "the points stay in reach";
}

TEST(Camera, SeesTheLargestDoublesFromAfar) {
  for (const double largest : {1.7e308, 4e307, 7e305}) {
    Camera camera(Extent{{-largest, -largest}, {largest, largest}}, 900, 200);
    const auto before = camera.pixel(largest, largest);
    camera.zoom(1.0 / 16, 450, 100);
    const auto p = camera.pixel(largest, largest);
    EXPECT_NEAR(p[0], 450 + (before[0] - 450) / 16, 1e-6) << largest;
    EXPECT_NEAR(p[1], 100 + (before[1] - 100) / 16, 1e-6) << largest;
  }
}

TEST(Camera, ZoomEndsWhereCoordinatesEnd) {
  Camera camera(Extent{{500000, 4100000}, {500100, 4100100}}, 300, 300);
  for (int i = 0; i < 200; ++i) camera.zoom(2, 150, 150);
  const auto p = camera.pixel(std::nextafter(500050.0, 1e9), 4100050);
  EXPECT_LE(std::fabs(p[0] - camera.pixel(500050, 4100050)[0]), 0.11);
  for (int i = 0; i < 200; ++i) camera.zoom(0.5, 150, 150);
  EXPECT_EQ(camera.magnification(), 1.0 / 16);
}

TEST(Camera, StretchesBoxesThatAreLinesOtherwise) {
  const Camera camera(Extent{{0, 0}, {1000, 1}}, 800, 800);
  const auto low = camera.pixel(0, 0), high = camera.pixel(1000, 1);
  EXPECT_NEAR((high[0] - low[0]) / (low[1] - high[1]), Camera::longest_aspect, 1e-9);
}

TEST(Camera, BoxOfNothingAndOfWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(box_of(std::vector<double>{}).low[0], 0);
  const Extent box = box_of(std::vector<double>{nan, 7, 1, 2, 3, -4});
  EXPECT_EQ(box.low[0], 1);
  EXPECT_EQ(box.low[1], -4);
  EXPECT_EQ(box.high[0], 3);
  const Camera point(Extent{{5, 5}, {5, 5}}, 100, 80);
  EXPECT_NEAR(point.pixel(5, 5)[0], 50, 1e-9);
  EXPECT_NEAR(point.pixel(5, 5)[1], 40, 1e-9);
}

}  // namespace
