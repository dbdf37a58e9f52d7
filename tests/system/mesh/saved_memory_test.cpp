// SPDX-License-Identifier: Apache-2.0
// The star stage with the compact plan: triangles are put in order in two parts, and vertices replace the stars in
// place. The meshes are those of the serial host, array by array.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/same_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

class SavedMemory : public BackendTest {
 protected:
  /// The least that a call with points of the host's takes, and `more`.
  static Options bounded(std::size_t n, std::size_t more) {
    Options with = GetParam().options();
    with.tuning.strategy = Strategy::stars;
    with.tuning.kernel_times = true;
    with.max_memory = 2 * 65536 + 83 * n + more;
    return with;
  }
  static std::uint64_t launches(const Triangulation& mesh, const std::string& kernel) {
    for (const KernelTime& time : mesh.statistics().kernels)
      if (time.name == kernel) return time.launches;
    return 0;
  }
  static void expect_same(const Triangulation& mesh, const Triangulation& expected) {
    EXPECT_TRUE(std::ranges::equal(mesh.triangles(), expected.triangles())) << "triangles differ";
    EXPECT_TRUE(std::ranges::equal(mesh.neighbors(), expected.neighbors())) << "neighbours differ";
    EXPECT_TRUE(std::ranges::equal(mesh.hull(), expected.hull())) << "hulls differ";
    EXPECT_EQ(mesh.hash(), expected.hash());
  }
  static Triangulation on_serial_host(const Points& xy) {
    Options serial;
    serial.backend = Backend::host;
    serial.threads = 1;
    return triangulate(Reals(xy), serial);
  }
};

/// Point 0 in the middle of an empty circle has 500 neighbours, whose numbers are spread over all there are.
Points hub_of_all_numbers(std::size_t n) {
  constexpr std::size_t around = 500;
  constexpr double radius = 0.1;
  Points xy = {0.5, 0.5};
  Random random(61);
  for (std::size_t i = 1; i < n; ++i) {
    if (i % (n / around) == 1) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      xy.insert(xy.end(), {0.5 + radius * same_cos(angle), 0.5 + radius * same_sin(angle)});
      continue;
    }
    double x = 0.5, y = 0.5;
    while ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) < 1.5 * radius * radius)
      x = random.uniform(), y = random.uniform();
    xy.insert(xy.end(), {x, y});
  }
  return xy;
}

/// The triangles whose smallest vertex is the high-degree one are more than one work-item sorts. Their second vertices
/// have numbers beyond those of the part of the order that is made.
TEST_P(SavedMemory, LongBuckets) {
  const Points xy = hub_of_all_numbers(100'000);
  const Triangulation expected = on_serial_host(xy);
  EXPECT_GE(std::ranges::count(expected.triangles(), 0), 500);
  for (const std::size_t more : {std::size_t{0}, 65536 + xy.size() / 2, 100 * xy.size()}) {
    SCOPED_TRACE(more);
    const Triangulation mesh = triangulate(Reals(xy), bounded(xy.size() / 2, more));
    expect_same(mesh, expected);
    const bool saves = more < 100 * xy.size();
    EXPECT_EQ(launches(mesh, "cadt_star_vertices"), saves ? 4U : 1U);
    EXPECT_EQ(launches(mesh, "cadt_number_buckets"), saves ? 2U : 1U);
    EXPECT_EQ(launches(mesh, "cadt_long_numbers"), 1U);
  }
}

/// The same with the high-degree vertex and its neighbours behind all others, so that its triangles are in the second
/// part of the order.
TEST_P(SavedMemory, LongBucketsOfTheSecondPart) {
  constexpr std::size_t around = 500;
  const Points mixed = hub_of_all_numbers(50'000);
  Points xy, last = {mixed[0], mixed[1]};
  const std::size_t n = mixed.size() / 2;
  for (std::size_t i = 1; i < n; ++i) {
    Points& to = i % (n / around) == 1 ? last : xy;
    to.insert(to.end(), {mixed[2 * i], mixed[2 * i + 1]});
  }
  xy.insert(xy.end(), last.begin(), last.end());
  const Triangulation expected = on_serial_host(xy);
  for (const std::size_t more : {std::size_t{0}, 65536 + xy.size() / 2, 100 * xy.size()}) {
    SCOPED_TRACE(more);
    const Triangulation mesh = triangulate(Reals(xy), bounded(xy.size() / 2, more));
    expect_same(mesh, expected);
    EXPECT_EQ(launches(mesh, "cadt_number_buckets"), more < 100 * xy.size() ? 2U : 1U);
    EXPECT_EQ(launches(mesh, "cadt_long_numbers"), 1U);
  }
}

/// Columns on both sides of the middle, the closer the nearer to it, so that the triangles of `most` points of either
/// side lie between the two. The left half comes first, and those triangles belong to it.
Points two_halves(std::size_t most) {
  Points xy;
  double away = 0;
  for (double count = static_cast<double>(most); count > 20; count /= 1.2) {
    const auto rows = static_cast<std::size_t>(count);
    const double step = 1 / static_cast<double>(rows);
    const Points shift = uniform_points(2 * rows, rows);
    for (std::size_t i = 0; i < 2 * rows; ++i) {
      const double x = away + step * (0.25 + 0.5 * shift[2 * i]);
      xy.push_back(i < rows ? 0.5 - x : 0.5 + x);
      xy.push_back(step * (static_cast<double>(i % rows) + 0.25 + 0.5 * shift[2 * i + 1]));
    }
    away += step;
  }
  xy.insert(xy.end(), {0, 0, 1, 1});
  return xy;
}

/// Vertices must not be written where a star is that is still to be read: from few triangles between the halves, so
/// that there is room, to many, so that there is none.
TEST_P(SavedMemory, VerticesInThePlaceOfStars) {
  std::size_t in_place = 0, elsewhere = 0;
  for (const std::size_t most : {1000, 1200, 1400, 2000, 2200, 2400, 2600, 4400}) {
    SCOPED_TRACE(most);
    const Points xy = two_halves(most);
    const Triangulation mesh = triangulate(Reals(xy), bounded(xy.size() / 2, 17 * xy.size() / 2));
    EXPECT_EQ(mesh.hash(), on_serial_host(xy).hash());
    EXPECT_GT(mesh.statistics().proven_stars, xy.size() / 3);
    ++(launches(mesh, "cadt_star_vertices") == 1 ? elsewhere : in_place);
  }
  EXPECT_EQ(in_place, 3U);
  EXPECT_EQ(elsewhere, 5U);
}

CADT_ON_MAIN_BACKENDS(SavedMemory);

}  // namespace
}  // namespace cadt::test
