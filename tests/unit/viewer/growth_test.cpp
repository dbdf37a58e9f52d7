// SPDX-License-Identifier: Apache-2.0
// Recordings of a growing mesh, and positions in them. No OpenGL.
#include "viewer/growth/playback.hpp"
#include "viewer/growth/recording.hpp"

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

namespace cadt::viewer {
namespace {

std::vector<double> scattered(std::size_t n) {
  std::mt19937_64 random(5);
  std::vector<double> xy(2 * n);
  for (double& v : xy) v = static_cast<double>(random() >> 11) * 0x1p-53;
  return xy;
}

Options on_host() {
  Options options;
  options.backend = Backend::host;
  options.threads = 2;
  return options;
}

using Triangle = std::array<std::int32_t, 3>;
std::set<Triangle> triangles_of(std::span<const std::int32_t> indices) {
  std::set<Triangle> result;
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    Triangle v{indices[t], indices[t + 1], indices[t + 2]};
    std::rotate(v.begin(), std::ranges::min_element(v), v.end());
    result.insert(v);
  }
  return result;
}

TEST(Recording, EndsWithTheDelaunayTriangulation) {
  const std::vector<double> xy = scattered(2048);
  const Recording recording(xy, on_host());
  ASSERT_EQ(recording.size(), 12u) << "eleven levels, and the end";
  EXPECT_EQ(recording.dropped(), 0u);
  std::size_t points = 0, bytes = 0;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const GrowthCounters& c = recording.counters(i);
    EXPECT_GE(c.points, points);
    EXPECT_EQ(c.triangles, recording.triangles(i).size() / 3);
    EXPECT_EQ(c.complete, i + 1 == recording.size());
    points = c.points;
    bytes += c.triangles * (12 + 2);
  }
  EXPECT_EQ(recording.bytes(), bytes) << "no lost locks are recorded";
  const Triangulation mesh = triangulate(PointsView(std::span<const double>(xy)), on_host());
  EXPECT_EQ(triangles_of(recording.triangles(11)), triangles_of(mesh.triangles()));
  EXPECT_EQ(recording.illegal_edges(11), 0u);
}

TEST(Recording, HasStepsWithinLevels) {
  const std::vector<double> xy = scattered(4096);
  RecordingLimits limits;
  limits.steps = 64;
  const Recording recording(xy, on_host(), limits);
  EXPECT_GE(recording.size(), 64u);
  EXPECT_LE(recording.size(), 64u + 2 * 13);
  for (std::size_t i = 1; i < recording.size(); ++i)
    EXPECT_LE(recording.counters(i).points,
              recording.counters(i - 1).points + 64 + recording.counters(i - 1).waiting_points);
}

TEST(Recording, KnowsLevelsOfPoints) {
  std::vector<double> xy = scattered(1000);
  xy.insert(xy.end(), {xy[0], xy[1]});  // a duplicate
  const Recording recording(xy, on_host());
  const auto levels = recording.levels();
  ASSERT_EQ(levels.size(), 1001u);
  EXPECT_NE(std::isnan(levels[0]), std::isnan(levels[1000])) << "one of two equal points is in the mesh";
  EXPECT_EQ(std::ranges::count_if(levels, [](float l) { return std::isnan(l); }), 1);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(levels, 10.0f)), 500.0, 40.0) << "half of them come last";
  for (const std::int32_t v : recording.triangles(3))
    EXPECT_LE(levels[static_cast<std::size_t>(v)], static_cast<float>(recording.counters(3).level));
}

TEST(Recording, HasFlipsAndLostLocksOfTriangles) {
  const std::vector<double> xy = scattered(3000);
  Options options = on_host();
  const Recording counted(xy, options);
  const std::size_t last = counted.size() - 1;
  const auto flips = counted.values(last, GrowthValue::flips);
  ASSERT_EQ(flips.size(), counted.counters(last).triangles);
  EXPECT_GT(*std::ranges::max_element(flips), 3.0f);
  EXPECT_TRUE(counted.values(last, GrowthValue::lost_locks).empty());
  options.statistics = StatisticsDetail::timing;
  const Recording timed(xy, options);
  EXPECT_EQ(timed.values(timed.size() - 1, GrowthValue::lost_locks).size(), counted.counters(last).triangles);
}

TEST(Recording, FindsEdgesThatAreNotDelaunay) {
  // With stabilised flips of the first kind edges wait for the end.
  const std::vector<double> xy = scattered(4000);
  Options options = on_host();
  options.tuning.stabilize = Stabilize::defer;
  options.tuning.flip_threshold = 0;
  const Recording recording(xy, options);
  ASSERT_GT(recording.size(), 5u);
  EXPECT_GT(recording.illegal_edges(recording.size() - 2), 0u);
  EXPECT_EQ(recording.illegal_edges(recording.size() - 1), 0u);
}

TEST(Recording, StaysWithinItsMemoryAndSaysWhatItDropped) {
  const std::vector<double> xy = scattered(20000);
  RecordingLimits limits;
  const std::size_t all = Recording(xy, on_host(), limits).size();
  limits.most_bytes = 900'000;  // the complete mesh takes 640,000
  const Recording small(xy, on_host(), limits);
  EXPECT_LE(small.bytes(), limits.most_bytes);
  EXPECT_GT(small.dropped(), 0u);
  EXPECT_EQ(small.size() + small.dropped(), all);
  EXPECT_TRUE(small.counters(small.size() - 1).complete);
  EXPECT_GT(small.size(), 8u) << "small ones have room";
  limits.most_bytes = 1;
  const Recording smallest(xy, on_host(), limits);
  EXPECT_EQ(smallest.size(), 1u);
  EXPECT_TRUE(smallest.counters(0).complete);
}

TEST(Recording, IsEmptyWithoutTriangles) {
  const std::vector<double> none, line{0, 0, 1, 1, 2, 2};
  EXPECT_EQ(Recording(none, on_host()).size(), 0u);
  EXPECT_EQ(Recording(line, on_host()).size(), 0u);
}

TEST(Recording, CanBeStopped) {
  const std::vector<double> xy = scattered(1000);
  Options options = on_host();
  cadt::stop_source source;
  options.stop = source.get_token();
  source.request_stop();
  EXPECT_THROW(Recording(xy, options), Cancelled);
}

TEST(Recording, HasAFrameForEachTime) {
  const std::vector<double> xy = scattered(2048);
  const Recording recording(xy, on_host());
  EXPECT_EQ(recording.frame_at(0), 0u);
  EXPECT_EQ(recording.frame_at(1), recording.size() - 1);
  EXPECT_EQ(recording.frame_at(7), recording.size() - 1);
  std::size_t before = 0;
  for (int i = 0; i <= 100; ++i) {
    const std::size_t frame = recording.frame_at(i / 100.0);
    EXPECT_GE(frame, before);
    before = frame;
  }
  EXPECT_LE(recording.counters(recording.frame_at(0.5)).points, 512u);
  EXPECT_NEAR(static_cast<double>(recording.counters(recording.frame_with_points(100)).points), 128.0, 3.0)
      << "three points are there from the start";
  EXPECT_EQ(recording.frame_with_points(1e9), recording.size() - 1);
}

TEST(Playback, PlaysStopsAndGoesBack) {
  Playback play(5);
  play.play(2);
  play.advance(0.75);
  EXPECT_EQ(play.frame(), 1u);
  EXPECT_DOUBLE_EQ(play.position(), 1.5);
  play.advance(10);
  EXPECT_EQ(play.frame(), 4u);
  EXPECT_FALSE(play.playing());
  play.play(0.5);  // slow motion, from the start
  EXPECT_EQ(play.frame(), 0u);
  play.advance(1);
  EXPECT_DOUBLE_EQ(play.position(), 0.5);
  play.play(-1);
  play.advance(0.25);
  EXPECT_DOUBLE_EQ(play.position(), 0.25);
  play.advance(1);
  EXPECT_DOUBLE_EQ(play.position(), 0);
  EXPECT_FALSE(play.playing());
}

TEST(Playback, StepsFromPictureToPicture) {
  Playback play(5);
  play.seek(1.5);
  play.step(1);
  EXPECT_DOUBLE_EQ(play.position(), 2);
  play.seek(1.5);
  play.step(-1);
  EXPECT_DOUBLE_EQ(play.position(), 1);
  play.step(-3);
  EXPECT_EQ(play.frame(), 0u);
  play.step(99);
  EXPECT_EQ(play.frame(), 4u);
}

TEST(Playback, HasNothingToShowOfNothing) {
  Playback play(0);
  play.play(1);
  play.advance(5);
  play.step(1);
  EXPECT_EQ(play.frame(), 0u);
}

}  // namespace
}  // namespace cadt::viewer
