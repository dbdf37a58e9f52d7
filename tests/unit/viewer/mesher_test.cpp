// SPDX-License-Identifier: Apache-2.0
#include "viewer/mesh/mesher.hpp"

#include "tests/unit/viewer/with_display.hpp"

#include <cadt/cadt.hpp>

#include <algorithm>
#include <array>
#include <random>

namespace cadt::viewer {
namespace {

using Triangle = std::array<std::int32_t, 3>;

/// Each with its smallest index first, ascending.
std::vector<Triangle> sorted(std::span<const std::int32_t> indices) {
  std::vector<Triangle> all(indices.size() / 3);
  for (std::size_t t = 0; t < all.size(); ++t) {
    std::copy_n(indices.begin() + static_cast<std::ptrdiff_t>(3 * t), 3, all[t].begin());
    std::ranges::rotate(all[t], std::ranges::min_element(all[t]));
  }
  std::ranges::sort(all);
  return all;
}

std::vector<double> random_points(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-3.0, 5.0);
  std::vector<double> xy(2 * n);
  for (double& value : xy) value = coordinate(random);
  return xy;
}

std::vector<Triangle> triangles_of(const MeshBuffers& mesh) {
  return sorted(mesh.triangles.read_values<std::int32_t>(3 * mesh.triangle_count));
}

std::vector<Triangle> expected_for(std::span<const double> xy) { return sorted(cadt::triangulate(xy).triangles()); }

class MesherTest : public WithDisplay {};

TEST_F(MesherTest, CopyEqualsTheLibraryForMeshesThatGrowAndShrink) {
  Options options;
  options.backend = Backend::host;
  Mesher mesher(options, Interop::copy);
  EXPECT_EQ(mesher.interop(), Interop::copy);
  for (const std::size_t n : {3u, 5000u, 40u, 20'000u, 2u, 1u, 0u, 100u}) {
    const std::vector<double> xy = random_points(n, 7);
    MeshBuffers mesh = MeshBuffers::with_room(n);
    mesh.write_points(xy);
    const std::size_t before = mesh.bytes_through_host;
    mesher.triangulate(mesh);
    EXPECT_EQ(triangles_of(mesh), expected_for(xy)) << n;
    EXPECT_EQ(mesh.bytes_through_host - before, 16 * n + 12 * mesh.triangle_count);
  }
}

TEST_F(MesherTest, WithStatisticsTheMeshIsTheSame) {
  Options options;
  options.backend = Backend::host;
  Mesher mesher(options, Interop::automatic);
  const std::vector<double> xy = random_points(3000, 8);
  MeshBuffers mesh = MeshBuffers::with_room(3000);
  mesh.write_points(xy);
  Statistics statistics;
  mesher.triangulate(mesh, &statistics);
  EXPECT_EQ(triangles_of(mesh), expected_for(xy));
  EXPECT_EQ(statistics.points, 3000u);
  EXPECT_GT(statistics.incircle_tests, 0u);
}

TEST_F(MesherTest, ThePointsAreThoseOfTheBuffer) {
  Options options;
  options.backend = Backend::host;
  Mesher mesher(options, Interop::automatic);
  const std::vector<double> first = random_points(500, 1), second = random_points(500, 2);
  MeshBuffers mesh = MeshBuffers::with_room(500);
  mesh.write_points(first);
  mesh.points.write_values(std::span<const double>(second));  // as if a device had
  mesher.triangulate(mesh);
  EXPECT_EQ(triangles_of(mesh), expected_for(second));
}

TEST_F(MesherTest, AfterAnErrorThereAreNoTrianglesAndTheNextCallWorks) {
  Options options;
  options.backend = Backend::host;
  Mesher mesher(options, Interop::copy);
  std::vector<double> xy = random_points(100, 3);
  MeshBuffers mesh = MeshBuffers::with_room(100);
  mesh.write_points(xy);
  mesher.triangulate(mesh);
  const double good = xy[17];
  xy[17] = std::numeric_limits<double>::quiet_NaN();
  mesh.write_points(xy);
  EXPECT_THROW(mesher.triangulate(mesh), InputError);
  EXPECT_EQ(mesh.triangle_count, 0u);
  xy[17] = good;
  mesh.write_points(xy);
  mesher.triangulate(mesh);
  EXPECT_EQ(triangles_of(mesh), expected_for(xy));
}

TEST_F(MesherTest, SaysWhyAFasterWayIsNotPossible) {
  Options options;
  options.backend = Backend::host;
  const Mesher mesher(options, Interop::automatic);
  EXPECT_EQ(mesher.interop(), Interop::copy);
  EXPECT_EQ(mesher.device().backend, Backend::host);
  EXPECT_NE(mesher.reason().find("cuda: the mesh is computed by the back end 'host'"), std::string::npos)
      << mesher.reason();
  EXPECT_NE(mesher.reason().find("opencl: the mesh is computed by the back end 'host'"), std::string::npos)
      << mesher.reason();
}

TEST_F(MesherTest, WhatIsNamedIsTakenOrRefused) {
  for (const Interop interop : {Interop::cuda, Interop::opencl}) {
    try {
      const Mesher mesher(Options{}, interop);
      EXPECT_EQ(mesher.interop(), interop);
      EXPECT_TRUE(mesher.reason().empty()) << mesher.reason();
      EXPECT_FALSE(driver().software);
    } catch (const DisplayError& error) {
      const std::string text = error.what(),
                        start = "--interop " + std::string(to_string(interop)) + " is not possible: ";
      EXPECT_EQ(text.rfind(start, 0), 0u) << text;
      EXPECT_GT(text.size(), start.size() + 60) << text;  // a reason, and what to do
    }
  }
}

/// scripts/check_viewer says so: it runs where the card that computes draws, too.
bool interop_is_required() { return std::getenv("CADT_REQUIRE_INTEROP") != nullptr; }

TEST_F(MesherTest, WithoutTheHostNothingGoesThroughIt) {
  Mesher mesher(Options{}, Interop::automatic);
  if (mesher.interop() == Interop::copy) {
    if (interop_is_required()) FAIL() << mesher.reason();
    GTEST_SKIP() << mesher.reason();
  }
  std::vector<double> xy = random_points(50'000, 5);
  MeshBuffers mesh = MeshBuffers::with_room(50'000);
  mesh.write_points(xy);
  const std::vector<Triangle> expected = expected_for(xy);
  std::ranges::fill(xy, std::numeric_limits<double>::quiet_NaN());  // whoever reads the host's copy fails
  mesh.bytes_through_host = 0;
  Statistics statistics;
  mesher.triangulate(mesh, &statistics);
  EXPECT_EQ(triangles_of(mesh), expected);
  mesher.triangulate(mesh);
  EXPECT_EQ(triangles_of(mesh), expected);
  EXPECT_EQ(mesh.bytes_through_host, 0u);
  // The words that steer the call, not the points: those are 800,000 bytes.
  EXPECT_LT(statistics.bytes_to_device + statistics.bytes_from_device, 65'536u);
}

TEST_F(MesherTest, LargeBuffersAreMovedToLargePagesWithTheirContents) {
  constexpr std::size_t n = 5'000'000;  // 80 MB
  Mesher mesher(Options{}, Interop::automatic);
  if (mesher.interop() != Interop::cuda) {
    if (interop_is_required()) FAIL() << mesher.reason();
    GTEST_SKIP() << mesher.reason();
  }
  const std::vector<double> xy = random_points(n, 6);
  MeshBuffers mesh = MeshBuffers::with_room(n);
  mesh.write_points(xy);
  const std::uint64_t before = mesh.points.serial();
  for (int call = 0; call < 2; ++call) {
    mesher.triangulate(mesh);
    EXPECT_EQ(mesher.reason(), "");
    EXPECT_EQ(triangles_of(mesh), expected_for(xy));
  }
  EXPECT_NE(mesh.points.serial(), before);
  EXPECT_EQ(mesh.points.read_values<double>(2 * n), xy);
  const std::vector<double> fewer = random_points(n / 2, 9);
  mesh.write_points(fewer);
  mesher.triangulate(mesh);
  EXPECT_EQ(triangles_of(mesh), expected_for(fewer)) << "the moved buffer can be written";
  mesh = MeshBuffers::with_room(n);  // other buffers, perhaps with the same ids
  mesh.write_points(fewer);
  mesher.triangulate(mesh);
  EXPECT_EQ(triangles_of(mesh), expected_for(fewer));
}

}  // namespace
}  // namespace cadt::viewer
