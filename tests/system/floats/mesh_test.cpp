// SPDX-License-Identifier: Apache-2.0
// The mesh of floats from a device without doubles: equal to the host's and to CGAL's, for everything that the other
// back ends are tested with, rounded to floats, and for what only floats have.
#include "tests/support/data_files.hpp"
#include "tests/support/families.hpp"
#include "tests/system/floats/floats.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace cadt::test {
namespace {

constexpr float largest = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();

class FloatFamilies : public FloatTest {};
TEST_F(FloatFamilies, AllRoundedToFloats) {
  for (const FamilyGroup& group : family_groups())
    for (const Family& family : group.families()) check(floats_of(family.make()), family.name);
}

class FloatMesh : public FloatTest {};

TEST_F(FloatMesh, Uniform) {
  check(floats_of(uniform_points(40000, 3)), "uniform");
  Options small_groups = float_options();
  small_groups.tuning.work_group_size = 16;
  small_groups.tuning.strategy = Strategy::locks;
  check(floats_of(uniform_points(20000, 5)), "groups of 16", small_groups);
  check(floats_of(moved(uniform_points(20000, 4), 500000, 5000000)), "far from the origin: duplicates and lattices");
}

TEST_F(FloatMesh, GaussianWithHeavyTails) {
  Random random(7);
  Floats xy, tails;
  for (int i = 0; i < 40000; ++i) {
    xy.push_back(static_cast<float>(random.normal()));
    tails.push_back(static_cast<float>(std::exp(20 * random.normal())));
  }
  check(xy, "gaussian");
  check(tails, "log-normal");
}

TEST_F(FloatMesh, LatticesAndCirclesAreTies) {
  const Floats grid = floats_of(grid_points(120, 100));
  check(grid, "grid");
  const Triangulation mesh = triangulate(FloatSpan(grid), float_options());
  EXPECT_GT(mesh.statistics().ties, 1000u);
  Points circle;  // whole numbers on a circle
  for (int x = -325; x <= 325; ++x)
    for (int y = -325; y <= 325; ++y)
      if (x * x + y * y == 325 * 325) circle.push_back(x), circle.push_back(y);
  check(floats_of(circle), "cocircular");
  for (const int exponent : {-149, -140, 100}) check(floats_of(scaled(circle, exponent)), "cocircular, scaled");
  check(floats_of(regular_polygon(1000, 0.1, 0.2, 3)), "rounded polygon");
}

TEST_F(FloatMesh, Duplicates) {
  Points xy = uniform_points(3000, 9);
  const Points again = xy;
  xy.insert(xy.end(), again.begin(), again.end());
  for (int i = 0; i < 64; ++i) xy.insert(xy.end(), {0.25, 0.5, -0.0, 0.0, 0.0, -0.0});
  check(floats_of(xy), "twice");
  const Floats tiny = {least, 0, 0, least, least, 0, 0, 0, -0.0F, 0, 2 * least, least, 0, least};
  check(tiny, "subnormal");
  EXPECT_EQ(triangulate(FloatSpan(tiny), float_options()).duplicates().size(), 3u);
}

TEST_F(FloatMesh, SmallAndFlat) {
  check({}, "none");
  check({1, 2}, "one");
  check({1, 2, 1, 3}, "two");
  check({0, 0, 1, 0, 0, 1}, "three");
  check({0, 0, 1, 0, 1, 1, 0, 1}, "square");
  Floats line, upright;
  for (int i = 0; i < 500; ++i)
    line.insert(line.end(), {static_cast<float>(i % 100), static_cast<float>(3 * (i % 100))});
  for (int i = 0; i < 50; ++i) upright.insert(upright.end(), {7, static_cast<float>(i) * least});
  check(line, "line");
  check(upright, "upright");
  EXPECT_EQ(triangulate(FloatSpan(upright), float_options()).dimension(), 1);
  line[1] = least;  // (0, least): off the line by the least there is
  check(line, "all but a line");
}

TEST_F(FloatMesh, EveryFiniteFloat) {
  const float m = largest, u = least;
  check({m, m, -m, m, -m, -m, m, -m}, "corners");
  check({m, m, -m, m, -m, -m, m, -m, 0, 0, 1, 1, m / 2, -m / 3, u, -u, 3 * u, 0x1p-126F}, "corners and small ones");
  check({u, u, -u, u, -u, -u, u, -u, 0, 0, 2 * u, 0, 0, -2 * u}, "smallest");
  check({0x1p-126F, 0, 0x1p-126F - u, u, 0, 0x1p-126F, 0, 0}, "where subnormal numbers begin");
  check({0, 0, 1, 0, 0, 1, u, u, 1, u, .5F, .5F}, "smallest beside 1");
  check({-m, 0, m, 0, 0, u}, "off the line by the least");
  check({-1, 0, 1, 0, 0, u, 0, -u}, "off the line by the least, both sides");
  const float a = 1e-30F, b = 1e30F;
  check({a, a, -a, a, -a, -a, a, -a, b, b, -b, b, -b, -b, b, -b, 0, 0, 1, 0, 0, 1, -1, 0, 0, -1}, "1e-30 to 1e30");
  for (const int span : {20, 60, 126}) {
    Floats xy;
    Random random(static_cast<std::uint64_t>(span));
    for (int i = 0; i < 600; ++i) {
      const double exponent = std::floor(random.uniform(-span, span));
      xy.push_back(static_cast<float>((random.below(2) ? 1 : -1) * (1 + random.uniform()) * std::exp2(exponent)));
    }
    check(xy, "exponents from -" + std::to_string(span));
  }
}

TEST_F(FloatMesh, APowerOfTwoChangesNothing) {
  Points xy = grid_points(5, 5);
  Random random(3);
  for (int i = 0; i < 40; ++i) xy.push_back(static_cast<double>(random.below(256)));
  const Hash128 hash = triangulate(FloatSpan(floats_of(xy)), host_options()).hash();
  for (int exponent = -149; exponent <= 119; exponent += 4)
    EXPECT_EQ(triangulate(FloatSpan(floats_of(scaled(xy, exponent))), float_options()).hash(), hash) << exponent;
}

TEST_F(FloatMesh, OverfullCellsAndLongBoxes) {
  Points crowd = skewed_points(6000);
  check(floats_of(crowd), "skewed");
  const Points again = crowd;
  crowd.insert(crowd.end(), again.begin(), again.end());
  check(floats_of(crowd), "skewed, twice");
  Floats subnormal;  // one over-full cell for the keys, which see zeros
  for (int i = 0; i < 2000; ++i)
    subnormal.insert(subnormal.end(), {static_cast<float>(i % 41) * least, static_cast<float>(i % 37 - 20) * least});
  check(subnormal, "subnormal crowd");
  subnormal.insert(subnormal.end(), {1, 1, -1, 1});
  check(subnormal, "subnormal crowd beside 1");
  check(floats_of(two_clusters(6000)), "two clusters");
  Points flat = uniform_points(20000, 8);  // keys of more bits along an axis than a float has
  for (std::size_t i = 1; i < flat.size(); i += 2) flat[i] *= 1e-12;
  check(floats_of(flat), "long box");
}

// So many points on a line get keys of 25 bits along it. The last cell must not be rounded up to the one behind it,
// whose key would be sorted as that of the first: equal points would not be adjacent.
TEST_F(FloatMesh, KeysOfMoreBitsThanAFloatHas) {
  Floats xy;
  Random random(4);
  for (int i = 0; i < (1 << 20) + 1000; ++i) {
    const float end = i % 64 == 0 ? 1.0F : 0.0F;
    xy.insert(xy.end(), {i % 32 == 0 ? end : static_cast<float>(random.uniform()), 0});
  }
  const Triangulation mesh = triangulate(FloatSpan(xy), float_options()),
                      host = triangulate(FloatSpan(xy), host_options());
  EXPECT_EQ(mesh.dimension(), 1);
  EXPECT_GT(mesh.duplicates().size(), 30000u);
  EXPECT_EQ(mesh.duplicates().size(), host.duplicates().size());
  EXPECT_EQ(mesh.hash(), host.hash());
}

class FloatHardSets : public FloatTest {
 protected:
  void SetUp() override {
    FloatTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (!data_folder()) GTEST_SKIP() << "no data folder: CADT_DATA_DIR is not set and the default is not there";
  }
};

TEST_F(FloatHardSets, Files) {
  std::size_t exact = 0;
  for (const ExactCounts& counts : expected_of_files()) {
    if (counts.not_finite) continue;
    const Points xy = hard_file(counts.name);
    check(floats_of(xy), counts.name);
    if (!are_floats(xy)) continue;  // others are new sets once rounded
    ++exact;
    const Triangulation mesh = triangulate(FloatSpan(floats_of(xy)), float_options());
    EXPECT_EQ(mesh.duplicates().size(), counts.duplicates) << counts.name;
    EXPECT_EQ(mesh.number_of_triangles(), counts.triangles) << counts.name;
  }
  EXPECT_GE(exact, 10u);
}

TEST_F(FloatHardSets, Catalogue) {
  for (const ExactCounts& counts : expected_of_catalogue())
    if (!counts.not_finite) check(floats_of(catalogue_set(counts.name)), counts.name);
}

}  // namespace
}  // namespace cadt::test
