// SPDX-License-Identifier: Apache-2.0
// The boundaries between labels, against every single edge of every pixel.
#include <cadt/label_image.hpp>

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "tests/unit/labels/label_checks.hpp"

namespace cadt::test {
namespace {

TEST(LabelSegments, OfOnePixelAreItsSides) {
  const std::vector<std::int32_t> one{7};
  const LabelSegments found = label_segments(one, 1, 1);
  EXPECT_EQ(found.xy, (std::vector<double>{0, 1, 1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(found.segments, (std::vector<Segment>{{0, 1}, {0, 2}, {2, 3}, {1, 3}}));
  EXPECT_EQ(found.sides, (std::vector<std::array<std::int32_t, 2>>{
                             {outside_label, 7}, {7, outside_label}, {7, outside_label}, {outside_label, 7}}));
}

TEST(LabelSegments, JoinStraightRunsAndStopWhereAThirdLabelMeets) {
  // 1 1 1 1
  // 1 1 1 1
  // 2 2 3 3
  const std::vector<std::int32_t> labels{1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 3, 3};
  const LabelSegments found = label_segments(labels, 4, 3);
  EXPECT_EQ(found.xy.size() / 2, 8U);
  EXPECT_EQ(found.segments.size(), 10U);  // 7 on the border and 3 inside
  EXPECT_EQ(why_wrong(labels, 4, 3, found), "");
}

TEST(LabelSegments, HaveEveryEdgeOnceInRandomImages) {
  std::mt19937 random(5);
  for (int run = 0; run < 3000; ++run) {
    const std::size_t width = 1 + random() % 9, height = 1 + random() % 9;
    const unsigned kinds = 1 + random() % 4;
    std::vector<std::int32_t> labels(width * height);
    for (std::int32_t& label : labels) label = static_cast<std::int32_t>(random() % kinds) - 1;
    const LabelSegments found = label_segments(labels, width, height);
    ASSERT_EQ(why_wrong(labels, width, height, found), "") << width << " x " << height << ", run " << run;
  }
}

TEST(LabelSegments, RefuseWhatIsNoImage) {
  const std::vector<std::int32_t> six{1, 2, 3, 4, 5, 6};
  EXPECT_THROW(static_cast<void>(label_segments(six, 2, 2)), InputError);
  EXPECT_THROW(static_cast<void>(label_segments(six, 4, 2)), InputError);
  EXPECT_THROW(static_cast<void>(label_segments(six, 6, 0)), InputError);
  EXPECT_THROW(static_cast<void>(label_segments({}, 0, 0)), InputError);
  EXPECT_THROW(static_cast<void>(label_segments(six, std::size_t{1} << 63, 2)), InputError);
  const std::vector<std::int32_t> reserved{1, 2, outside_label, 4};
  try {
    static_cast<void>(label_segments(reserved, 2, 2));
    ADD_FAILURE() << "no error";
  } catch (const InputError& e) {
    EXPECT_EQ(e.index(), 2U);
  }
}

TEST(TriangleLabels, AreThoseOfThePixelsBelow) {
  const std::vector<std::int32_t> labels{1, 2, 3, 4};  // 1 2 above 3 4
  const std::vector<double> xy{0, 0, 1, 0, 0, 1, 1, 1, 2, 1, 1, 2, 2, 2};
  const std::vector<std::int32_t> triangles{0, 1, 2, 3, 4, 5, 4, 6, 5};
  EXPECT_EQ(triangle_labels(xy, triangles, labels, 2, 2), (std::vector<std::int32_t>{3, 2, 2}));
  const std::vector<std::int32_t> wrong{0, 1, 7};
  EXPECT_THROW(static_cast<void>(triangle_labels(xy, wrong, labels, 2, 2)), InputError);
  EXPECT_THROW(static_cast<void>(triangle_labels(xy, triangles, labels, 3, 2)), InputError);
  const std::vector<double> far{-9, -9, 99, 99, -9, 99};
  const std::vector<std::int32_t> one{0, 1, 2};
  EXPECT_EQ(triangle_labels(far, one, labels, 2, 2), (std::vector<std::int32_t>{2}));
  constexpr double most = std::numeric_limits<double>::max();
  const std::vector<double> large{most, most, most, most, most, -most};  // their sum is no double
  EXPECT_EQ(triangle_labels(large, one, labels, 2, 2), (std::vector<std::int32_t>{2}));
  const std::vector<double> odd{0, 0, 1, 0, 0, 1, 5};
  const std::vector<std::int32_t> part{0, 1, 2, 0};
  EXPECT_THROW(static_cast<void>(triangle_labels(odd, one, labels, 2, 2)), InputError);
  EXPECT_THROW(static_cast<void>(triangle_labels(xy, part, labels, 2, 2)), InputError);
  for (const double wrong_place : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const std::vector<double> not_finite{0, 0, 1, 0, 0, wrong_place};
    EXPECT_THROW(static_cast<void>(triangle_labels(not_finite, one, labels, 2, 2)), InputError);
  }
}

}  // namespace
}  // namespace cadt::test
