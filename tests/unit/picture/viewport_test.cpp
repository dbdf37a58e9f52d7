// SPDX-License-Identifier: Apache-2.0
#include "io/picture/viewport.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace {

using cadt::io::picture::Viewport;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

TEST(Viewport, UnitSquareFillsThePictureWithYUp) {
  const std::vector<double> xy{0, 0, 1, 1};
  const Viewport view(xy, 1000, 4000);
  EXPECT_EQ(view.width(), 1000);
  EXPECT_EQ(view.height(), 1000);
  const double m = view.margin();
  EXPECT_GT(m, 0.0);
  EXPECT_NEAR(view.map(0, 0).x, m, 1e-9);
  EXPECT_NEAR(view.map(0, 0).y, 1000 - m, 1e-9);
  EXPECT_NEAR(view.map(1, 1).x, 1000 - m, 1e-9);
  EXPECT_NEAR(view.map(1, 1).y, m, 1e-9);
  EXPECT_NEAR(view.map(0.25, 0.5).x, m + 0.25 * (1000 - 2 * m), 1e-9);
}

TEST(Viewport, KeepsTheAspect) {
  const std::vector<double> xy{10, 10, 14, 12};  // twice as wide as high
  const Viewport view(xy, 800, 4000);
  const double per_unit_x = view.map(14, 10).x - view.map(10, 10).x;
  const double per_unit_y = view.map(10, 10).y - view.map(10, 12).y;
  EXPECT_NEAR(per_unit_x / 4.0, per_unit_y / 2.0, 0.002 * per_unit_x);
}

TEST(Viewport, TallBoxKeepsToTheLargestHeight) {
  const std::vector<double> xy{0, 0, 1, 5};
  const Viewport view(xy, 1600, 1000);
  EXPECT_EQ(view.height(), 1000);
  EXPECT_DOUBLE_EQ(view.margin(), 0.015 * 1600);
  EXPECT_EQ(view.width(), 238);  // (1000 - 2 * 24) / 5 + 2 * 24 = 238.4
}

TEST(Viewport, WidthAndHeightExactlyWithTheBoxInTheMiddle) {
  const std::vector<double> xy{10, 10, 14, 12};  // twice as wide as high
  for (const auto& [width, height] : {std::pair{900, 100}, std::pair{100, 900}, std::pair{16, 16}}) {
    const Viewport view(xy, width, 4000, height);
    EXPECT_EQ(view.width(), width);
    EXPECT_EQ(view.height(), height);
    const auto low = view.map(10, 10), high = view.map(14, 12);
    EXPECT_NEAR(low.x + high.x, width, 1e-9 * width);
    EXPECT_NEAR(low.y + high.y, height, 1e-9 * height);
    EXPECT_NEAR(high.x - low.x, 2 * (low.y - high.y), 1e-9 * width);
    EXPECT_GT(std::min(low.x, high.y), 0);
    EXPECT_LT(std::min(low.x, high.y), 0.1 * std::min(width, height) + 1e-9);
  }
}

struct Box {
  const char* name;
  double x0, y0, x1, y1;
};

class ViewportExtremes : public testing::TestWithParam<Box> {};

TEST_P(ViewportExtremes, CornersLandOnTheMarginsAndTheMiddleBetweenThem) {
  const Box b = GetParam();
  const std::vector<double> xy{b.x0, b.y0, b.x1, b.y1};
  const Viewport view(xy, 500, 500);
  const double left = view.margin(), right = view.width() - view.margin();
  const double top = view.margin(), bottom = view.height() - view.margin();
  const auto low = view.map(b.x0, b.y0);
  const auto high = view.map(b.x1, b.y1);
  if (b.x0 == b.x1) {
    EXPECT_NEAR(low.x, 0.5 * (left + right), 0.01);
  } else {
    EXPECT_NEAR(low.x, left, 0.01);
    EXPECT_NEAR(high.x, right, 0.01);
  }
  if (b.y0 == b.y1) {
    EXPECT_NEAR(low.y, 0.5 * (top + bottom), 0.01);
  } else {
    EXPECT_NEAR(low.y, bottom, 0.01);
    EXPECT_NEAR(high.y, top, 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(AabbTree, ViewportExtremes,
                         testing::Values(Box{"tiny", 0, 0, 1e-300, 1e-300}, Box{"huge", -1e300, 0, 1e300, 1e300},
                                         Box{"all", -largest, -largest, largest, largest},
                                         Box{"subnormal", 0, 0, smallest, smallest},
                                         Box{"subnormals", -smallest, smallest, 4 * smallest, 5 * smallest},
                                         Box{"far", 1e15, -1e15, 1e15 + 1, -1e15 + 1}, Box{"point", 3, 4, 3, 4},
                                         Box{"horizontal", -1, 7, 1, 7}, Box{"vertical", 1e15, 0, 1e15, 1e-300},
                                         Box{"needle", 0, 0, 1, 1e-200}, Box{"mixed", 0, 0, smallest, largest}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Viewport, LeavesOutWhatIsNotFinite) {
  const std::vector<double> xy{0, 0, infinity, 5, 1, 1, std::nan(""), 2};
  const Viewport view(xy, 100, 100);
  EXPECT_NEAR(view.map(1, 1).x, 100 - view.margin(), 1e-9);
  EXPECT_FALSE(std::isfinite(view.map_all(xy)[1].x));
}

TEST(Viewport, NoPointsStillMakeAPicture) {
  const Viewport view({}, 300, 300);
  EXPECT_EQ(view.width(), 300);
  EXPECT_GE(view.height(), 8);
}

}  // namespace
