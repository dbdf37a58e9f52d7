// SPDX-License-Identifier: Apache-2.0
#include "io/picture/colour.hpp"
#include "io/picture/measure.hpp"
#include "io/picture/sheets.hpp"
#include "tests/unit/picture/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace cadt::io::picture;
using cadt::test::Mesh;

TEST(Colour, EveryGreySurvivesLinearLight) {
  for (std::uint32_t i = 0; i < 256; ++i) {
    const std::uint32_t grey = i << 16 | i << 8 | i;
    EXPECT_EQ(to_srgb(from_srgb(grey)), grey);
  }
}

TEST(Colour, RampsHitTheirEndsAndLargeTrianglesAreLighter) {
  EXPECT_EQ(to_srgb(size_ramp()(0.0f)), 0x6f9fc0u);
  EXPECT_EQ(to_srgb(size_ramp()(1.0f)), 0xf6f1e1u);
  float before = 0.0f;
  for (int i = 0; i <= 100; ++i) {
    const Rgb c = size_ramp()(static_cast<float>(i) / 100.0f);
    const float light = 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
    EXPECT_GE(light, before);
    before = light;
  }
  const Rgb clamped = terrain_ramp()(std::nanf(""));
  EXPECT_EQ(to_srgb(clamped), to_srgb(terrain_ramp()(0.0f)));
}

TEST(Colour, LevelGroundKeepsItsColour) { EXPECT_NEAR(hill_shade(0, 0), 1.0f, 1e-5f); }

TEST(Heights, QuantilesMapToZeroAndOne) {
  Mesh mesh = cadt::test::lattice(50);
  for (int i = 0; i < 2500; ++i) mesh.height.push_back(1000.0 + i);
  mesh.height[7] = 1e300;  // an outlier does not flatten the rest
  const auto h = relative_heights(mesh.scene());
  ASSERT_EQ(h.size(), 2500u);
  EXPECT_NEAR(h[1250], 0.5f, 0.02f);
  EXPECT_NEAR(h[20], 0.0f, 0.02f);
  EXPECT_EQ(h[7], 2.0f);
}

TEST(Heights, ExtremesAndConstants) {
  Mesh mesh = cadt::test::lattice(10);
  mesh.height.assign(100, 5.0);
  EXPECT_TRUE(relative_heights(mesh.scene()).empty());
  for (int i = 0; i < 100; ++i) {
    mesh.height[static_cast<std::size_t>(i)] = (i % 2 == 0 ? 1.0 : -1.0) * std::numeric_limits<double>::max();
  }
  const auto h = relative_heights(mesh.scene());
  ASSERT_EQ(h.size(), 100u);
  EXPECT_EQ(h[0], 1.0f);
  EXPECT_EQ(h[1], 0.0f);
  mesh.height.pop_back();
  EXPECT_TRUE(relative_heights(mesh.scene()).empty()) << "one height a point, or none";
}

TEST(Sheets, BackOfABodyTakesTheHeightOfItsFront) {
  Mesh mesh = cadt::test::lattice(40);
  std::vector<float> front, mixed;
  for (int i = 0; i < 1600; ++i) {
    const float x = static_cast<float>(i % 40) / 39.0f - 0.5f, y = static_cast<float>(i / 40) / 39.0f - 0.5f;
    const float up = 1.0f - 0.5f * (x * x + y * y);
    front.push_back(up);
    mixed.push_back((i * 7919) % 13 < 6 ? 1.0f - up : up);
  }
  std::vector<float> shown = mixed;
  show_upper_sheet(mesh.scene(), shown);
  // Up to a common scale and shift the shown heights are those of the front.
  const auto [low, high] = std::minmax_element(front.begin(), front.end());
  int wrong = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float expected = (front[i] - *low) / (*high - *low);
    if (std::fabs(shown[i] - expected) > 0.2f) ++wrong;
  }
  EXPECT_LT(wrong, 16) << "of 1600";
}

TEST(Sheets, TerrainStaysAsItIs) {
  Mesh mesh = cadt::test::lattice(40);
  std::vector<float> h;
  for (int i = 0; i < 1600; ++i) {
    h.push_back(0.5f +
                0.5f * std::sin(0.3f * static_cast<float>(i % 40)) * std::cos(0.2f * static_cast<float>(i / 40)));
  }
  h[820] = 3.0f;  // a tower
  std::vector<float> shown = h;
  show_upper_sheet(mesh.scene(), shown);
  EXPECT_EQ(shown, h);
}

TEST(Areas, EvenMeshHasOneMiddleColour) {
  const Mesh mesh = cadt::test::lattice(20);
  const std::vector<Point2f> position = [&] {
    std::vector<Point2f> p;
    for (std::size_t i = 0; i < mesh.xy.size(); i += 2) {
      p.push_back({static_cast<float>(mesh.xy[i]), static_cast<float>(mesh.xy[i + 1])});
    }
    return p;
  }();
  const AreaScale scale(mesh.scene(), position);
  EXPECT_NEAR(scale(position[0], position[1], position[21]), 0.5f, 0.01f);
  EXPECT_EQ(scale({0, 0}, {100, 0}, {0, 100}), 1.0f);
  EXPECT_EQ(scale({0, 0}, {0, 0}, {0, 0}), 0.0f);
  const EdgeLengths edges = edge_lengths(mesh.scene(), position);
  EXPECT_NEAR(edges.median, 1.0f, 1e-5f);
  EXPECT_NEAR(edges.total, 19 * 19 * (2 + std::sqrt(2.0)), 1.0) << "but for half of the hull";
}

}  // namespace
