// SPDX-License-Identifier: Apache-2.0
#include "viewer/live/live_points.hpp"

#include "tests/unit/viewer/with_display.hpp"
#include "viewer/mesh/mesher.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace cadt::viewer {
namespace {

using Point = std::array<double, 2>;

std::vector<Point> points_of(const MeshBuffers& mesh) { return mesh.points.read_values<Point>(mesh.point_count); }

std::vector<double> random_points(std::size_t n) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  std::vector<double> xy(2 * n);
  for (double& value : xy) value = 400'000 + 100 * coordinate(random);  // as UTM's
  for (std::size_t i = 1; i < xy.size(); i += 2) xy[i] = 5'000'000 + 50 * coordinate(random);
  return xy;
}

MeshBuffers mesh_of(std::span<const double> xy) {
  MeshBuffers mesh = MeshBuffers::with_room(xy.size() / 2);
  mesh.write_points(xy);
  return mesh;
}

bool lies_in(const Extent& box, Point p) {
  return p[0] >= box.low[0] && p[1] >= box.low[1] && p[0] <= box.high[0] && p[1] <= box.high[1];
}

class LiveTest : public WithDisplay {};

TEST_F(LiveTest, PointsAtRandomFillTheBoxEvenly) {
  MeshBuffers mesh;
  mesh.box = {{-2, 10}, {6, 14}};
  constexpr std::size_t n = 40'000;
  const LivePoints live(mesh, n, 5);
  ASSERT_EQ(mesh.point_count, n);
  std::array<int, 32> found{};
  for (const Point p : points_of(mesh)) {
    ASSERT_TRUE(lies_in(mesh.box, p));
    ++found[static_cast<std::size_t>(p[0] + 2) + 8 * static_cast<std::size_t>(p[1] - 10)];
  }
  for (const int count : found) EXPECT_NEAR(count, n / 32, 200);  // 5.7 standard deviations
  std::vector<Point> all = points_of(mesh);
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end()) << "53 bits each: no two are equal";
}

TEST_F(LiveTest, EachMotionMovesAllPointsWithinTheBoxAndNoneFar) {
  for (const Motion motion : {Motion::flow, Motion::bounce, Motion::orbit, Motion::particles}) {
    const std::vector<double> xy = random_points(2000);
    MeshBuffers mesh = mesh_of(xy);
    LivePoints live(mesh);
    Options options;
    options.backend = Backend::host;
    Mesher mesher(options, Interop::copy);
    const double width = mesh.box.high[0] - mesh.box.low[0];
    std::vector<Point> before = points_of(mesh);
    for (int frame = 0; frame < 20; ++frame) {
      mesher.triangulate(mesh);
      live.step(1.0 / 60, motion);
      const std::vector<Point> after = points_of(mesh);
      std::size_t moved = 0;
      for (std::size_t i = 0; i < after.size(); ++i) {
        ASSERT_TRUE(lies_in(mesh.box, after[i])) << to_string(motion) << " " << i;
        const double distance = std::hypot(after[i][0] - before[i][0], after[i][1] - before[i][1]);
        EXPECT_LT(distance, 0.15 * width) << to_string(motion);
        moved += distance > 0 ? 1u : 0u;
      }
      EXPECT_GT(moved, after.size() * 99 / 100) << to_string(motion);
      before = after;
    }
  }
}

TEST_F(LiveTest, TheFlowIsThatOfItsFormula) {
  const std::vector<double> xy = random_points(300);
  MeshBuffers mesh = mesh_of(xy);
  LivePoints live(mesh);
  constexpr double dt = 0.01, pi = 3.14159265358979;
  live.step(dt, Motion::flow);
  const double w = mesh.box.high[0] - mesh.box.low[0], h = mesh.box.high[1] - mesh.box.low[1];
  const std::vector<Point> after = points_of(mesh);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double x = (xy[2 * i] - mesh.box.low[0]) / w, y = (xy[2 * i + 1] - mesh.box.low[1]) / h;
    const double strength = 0.5 * std::cos(pi * dt / 8) * dt, sx = std::sin(pi * x), sy = std::sin(pi * y);
    EXPECT_NEAR(after[i][0], xy[2 * i] + w * strength * sx * sx * std::sin(2 * pi * y), 1e-6 * w);
    EXPECT_NEAR(after[i][1], xy[2 * i + 1] - h * strength * sy * sy * std::sin(2 * pi * x), 1e-6 * h);
  }
}

TEST_F(LiveTest, ThatBounceGoStraightOnBetweenTheWalls) {
  MeshBuffers mesh;
  mesh.box = {{0, 0}, {1, 1}};
  LivePoints live(mesh, 1000, 9);
  const std::vector<Point> a = points_of(mesh);
  live.step(0.1, Motion::bounce);
  const std::vector<Point> b = points_of(mesh);
  live.step(0.1, Motion::bounce);
  const std::vector<Point> c = points_of(mesh);
  std::size_t straight = 0, inner = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool far = std::ranges::all_of(a[i], [](double v) { return v > 0.05 && v < 0.95; });
    if (!far) continue;
    ++inner;
    straight +=
        std::abs(c[i][0] - 2 * b[i][0] + a[i][0]) < 1e-6 && std::abs(c[i][1] - 2 * b[i][1] + a[i][1]) < 1e-6 ? 1u : 0u;
  }
  EXPECT_GT(inner, 700u);
  EXPECT_EQ(straight, inner);
}

TEST_F(LiveTest, ParticlesThatOverlapArePushedApart) {
  // Pairs at a tenth of the diameter.
  std::vector<double> xy;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) xy.insert(xy.end(), {i * 1.0, j * 1.0, i + 0.05, j + 0.02});
  MeshBuffers mesh = mesh_of(xy);
  LivePoints live(mesh);
  Options options;
  options.backend = Backend::host;
  Mesher mesher(options, Interop::copy);
  const auto mean_distance = [&] {
    const std::vector<Point> p = points_of(mesh);
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); i += 2) sum += std::hypot(p[i][0] - p[i + 1][0], p[i][1] - p[i + 1][1]);
    return sum / static_cast<double>(p.size() / 2);
  };
  const double before = mean_distance();
  for (int frame = 0; frame < 10; ++frame) {
    mesher.triangulate(mesh);
    live.step(1e-5, Motion::particles);  // hardly any time: what moves them are pushes
  }
  EXPECT_GT(mean_distance(), 5 * before);
}

TEST_F(LiveTest, NearestEqualsThatOfTheHost) {
  const std::vector<double> xy = random_points(3000);
  MeshBuffers mesh = mesh_of(xy);
  LivePoints live(mesh);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  for (int k = 0; k < 40; ++k) {
    const double x = 400'000 + 100 * share(random), y = 5'000'000 + 50 * share(random);
    std::size_t best = 0;
    const auto distance = [&](std::size_t i) { return std::hypot(xy[2 * i] - x, xy[2 * i + 1] - y); };
    for (std::size_t i = 1; i < 3000; ++i)
      if (distance(i) < distance(best)) best = i;
    const auto found = live.nearest(x, y);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(distance(*found), distance(best), 1e-6 * distance(best));
  }
}

TEST_F(LiveTest, DragMovesOnePoint) {
  std::vector<double> xy = random_points(1000);
  MeshBuffers mesh = mesh_of(xy);
  LivePoints live(mesh);
  live.drag(321, 400'001.5, 5'000'002.25);
  xy[2 * 321] = 400'001.5;
  xy[2 * 321 + 1] = 5'000'002.25;
  EXPECT_EQ(mesh.points.read_values<double>(2000), xy);
}

TEST_F(LiveTest, PaintAddsPointsInTheDiscBehindTheOthers) {
  const std::vector<double> xy = random_points(1000);
  MeshBuffers mesh = mesh_of(xy);
  LivePoints live(mesh);
  live.paint(400'050, 5'000'025, 3, 500);
  live.paint(400'020, 5'000'010, 2, 3000);
  ASSERT_EQ(mesh.point_count, 4500u);
  ASSERT_GE(mesh.points.bytes(), 4500 * sizeof(Point));
  ASSERT_GE(mesh.triangles.bytes(), 4500 * 24u) << "there is room for its triangles";
  const std::vector<Point> all = points_of(mesh);
  for (std::size_t i = 0; i < 1000; ++i) ASSERT_EQ(all[i], (Point{xy[2 * i], xy[2 * i + 1]}));
  double outer = 0;
  for (std::size_t i = 1000; i < 1500; ++i) {
    const double r = std::hypot(all[i][0] - 400'050, all[i][1] - 5'000'025);
    ASSERT_LE(r, 3 * (1 + 1e-6));
    outer += r > 3 * std::sqrt(0.5) ? 1.0 : 0.0;  // half of the area
  }
  EXPECT_NEAR(outer, 250, 60);
  for (std::size_t i = 1500; i < 4500; ++i)
    ASSERT_LE(std::hypot(all[i][0] - 400'020, all[i][1] - 5'000'010), 2 * (1 + 1e-6));
  live.step(0.01, Motion::bounce);  // new points have velocities
  const std::vector<Point> moved = points_of(mesh);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NE(all[i], moved[i]);
}

TEST_F(LiveTest, EraseKeepsTheOthersInTheirOrder) {
  const std::vector<double> xy = random_points(30'000);
  MeshBuffers mesh = mesh_of(xy);
  LivePoints live(mesh);
  std::vector<Point> expected;
  for (std::size_t i = 0; i < 30'000; ++i)
    if (std::hypot(xy[2 * i] - 400'050, xy[2 * i + 1] - 5'000'025) > 10) expected.push_back({xy[2 * i], xy[2 * i + 1]});
  ASSERT_LT(expected.size(), 30'000u);
  EXPECT_EQ(live.erase(400'050, 5'000'025, 10), 30'000 - expected.size());
  EXPECT_EQ(points_of(mesh), expected);
  EXPECT_EQ(mesh.triangle_count, 0u);
  EXPECT_EQ(live.erase(400'050, 5'000'025, 10), 0u);
  EXPECT_EQ(live.erase(400'050, 5'000'025, 1000), expected.size());
  EXPECT_EQ(mesh.point_count, 0u);
  EXPECT_FALSE(live.nearest(0, 0).has_value());
  live.step(0.01, Motion::flow);
  live.paint(400'050, 5'000'025, 1, 10);
  EXPECT_EQ(mesh.point_count, 10u);
}

TEST_F(LiveTest, ABoxWithoutSizeOrTooLargeIsRefused) {
  MeshBuffers mesh = MeshBuffers::with_room(4);
  mesh.write_points(std::vector<double>{1, 1, 1, 1});
  EXPECT_THROW(LivePoints{mesh}, InputError);
  mesh.write_points(std::vector<double>{-1.7e308, 0, 1.7e308, 1});
  EXPECT_THROW(LivePoints{mesh}, InputError);
  mesh.write_points(std::vector<double>{0, 0, 1, 0, 0.5, 0});  // on a line
  LivePoints live(mesh);
  live.step(0.1, Motion::bounce);
  for (const Point p : points_of(mesh)) EXPECT_EQ(p[1], 0);
}

}  // namespace
}  // namespace cadt::viewer
