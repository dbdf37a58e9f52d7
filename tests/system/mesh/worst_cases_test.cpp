// SPDX-License-Identifier: Apache-2.0
// Sets that take the most flips or hold the most locks, and very many small ones. Every mesh is verified.
//
// CADT_HUB, CADT_ROTATIONS and CADT_SMALL_MESHES make them larger (docs/reliability.md).
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/support/same_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

std::size_t number_from(const char* variable, std::size_t otherwise) {
  const char* text = std::getenv(variable);
  const long value = text != nullptr ? std::atol(text) : 0;
  return value > 0 ? static_cast<std::size_t>(value) : otherwise;
}

class WorstCases : public BackendTest {
 protected:
  [[nodiscard]] static Options with_locks() {
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::locks;
    return options;
  }
};

// A sweep over the points needs n^2 / 8 flips, 123,504 for a thousand (tests/unit/insertion/flip_cascades_test.cpp
// makes them).
TEST_P(WorstCases, AxesInsideOut) {
  const Points xy = axis_cross(250);
  const ExpectedMesh expected = expected_mesh(xy);
  for (const unsigned grain : {0U, 1U, 1000U}) {
    Options options = with_locks();
    options.tuning.grain = grain;
    const Triangulation mesh = triangulate(std::span<const double>(xy), options);
    ASSERT_TRUE(same_mesh(mesh, expected));
    ASSERT_TRUE(verified(xy, mesh));
    EXPECT_LT(mesh.statistics().flips, 10U * 1000) << "the order of insertion is to spare most of them";
    RecordProperty("flips_" + std::to_string(grain), std::to_string(mesh.statistics().flips));
  }
  // ten times as many: a hundred times the flips for a sweep
  const Points larger = axis_cross(2500);
  const Triangulation mesh = triangulate(std::span<const double>(larger), with_locks());
  ASSERT_TRUE(verified(larger, mesh));
  EXPECT_LT(mesh.statistics().flips, 10U * 10000);
  RecordProperty("flips_larger", std::to_string(mesh.statistics().flips));
}

// Each flip locks a triangle at the high-degree vertex, and so do most insertions.
TEST_P(WorstCases, Hub) {
  const std::size_t degree = number_from("CADT_HUB", 20000);
  const Points xy = hub_points(static_cast<int>(degree));
  Options options = with_locks();
  for (const unsigned grain : {0U, 1U}) {
    options.tuning.grain = grain;
    const Triangulation mesh = triangulate(std::span<const double>(xy), options);
    ASSERT_TRUE(verified(xy, mesh));
    // Rounded, some of the points are not corners of the hull, but all are neighbours of the hub.
    std::size_t around = 0;
    for (const std::int32_t vertex : mesh.triangles()) around += vertex == 0 ? 1 : 0;
    EXPECT_EQ(around, degree);
    EXPECT_TRUE(mesh.statistics().certified);
  }
}

// Each flip owes the checks of all edges that it can make illegal. With those opposite of the new point alone, a card
// leaves 4 % of uniform points with an illegal edge, and of a parabola flip cascades of tens of thousands of flips.
TEST_P(WorstCases, LeaveHardlyAnIllegalEdgeToTheSweep) {
  constexpr std::size_t n = 200000;
  for (const Points& xy : {uniform_points(n), parabola_points(n), two_clusters(n)}) {
    const Triangulation mesh = triangulate(std::span<const double>(xy), with_locks());
    EXPECT_LE(mesh.statistics().sweep_repairs, n / 1000);
    EXPECT_LE(mesh.statistics().legality_sweeps, 2U);
  }
}

TEST_P(WorstCases, RotationsOfALattice) {
  const std::size_t rotations = number_from("CADT_ROTATIONS", 1000), side = 32, per_batch = 250;
  Triangulator triangulator(GetParam().options());
  for (std::size_t begin = 0; begin < rotations; begin += per_batch) {
    const std::size_t end = std::min(rotations, begin + per_batch);
    std::vector<Points> sets;
    Points all;
    std::vector<std::size_t> offsets = {0};
    for (std::size_t r = begin; r < end; ++r) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(r) / static_cast<double>(rotations);
      const double c = same_cos(angle), s = same_sin(angle);
      Points xy;
      for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j) {
          const double x = static_cast<double>(i), y = static_cast<double>(j);
          xy.insert(xy.end(), {c * x - s * y, s * x + c * y});
        }
      all.insert(all.end(), xy.begin(), xy.end());
      offsets.push_back(all.size() / 2);
      sets.push_back(std::move(xy));
    }
    const TriangulationBatch batch = triangulator.triangulate_batch(std::span<const double>(all), offsets);
    ASSERT_EQ(batch.size(), sets.size());
    for (std::size_t s = 0; s < sets.size(); ++s)
      ASSERT_TRUE(verified(sets[s], batch.triangulation(s))) << "rotation " << begin + s << " of " << rotations;
  }
}

// 3 to 64 points: in the plane, on a small lattice (ties and equal points), near a line, on a circle.
Points small_set(Random& random) {
  const std::size_t n = 3 + random.below(62);
  const std::size_t kind = random.below(5), cells = 2 + random.below(9);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    double x = random.uniform(), y = random.uniform();
    if (kind == 1 || kind == 2) {
      x = static_cast<double>(random.below(cells));
      y = static_cast<double>(random.below(cells));
    } else if (kind == 3) {
      y = x + 1e-15 * static_cast<double>(random.below(4));
    } else if (kind == 4) {
      const double angle = static_cast<double>(random.below(48)) * (std::numbers::pi / 24);
      x = same_cos(angle);
      y = same_sin(angle);
    }
    if (kind == 2) x *= 0.1;
    xy.insert(xy.end(), {x, y});
  }
  return xy;
}

// Many in one batch, on CPUs without locks, against each individually with locks.
TEST_P(WorstCases, SmallMeshes) {
  const std::size_t meshes = number_from("CADT_SMALL_MESHES", 10000), per_batch = 1000;
  Random random(static_cast<std::uint64_t>(64 + meshes));
  Options alone;
  alone.backend = Backend::host;
  alone.threads = 1;
  alone.tuning.strategy = Strategy::locks;
  Triangulator one(alone), many(GetParam().options());
  for (std::size_t begin = 0; begin < meshes; begin += per_batch) {
    std::vector<Points> sets;
    Points all;
    std::vector<std::size_t> offsets = {0};
    for (std::size_t s = begin; s < std::min(meshes, begin + per_batch); ++s) {
      sets.push_back(small_set(random));
      all.insert(all.end(), sets.back().begin(), sets.back().end());
      offsets.push_back(all.size() / 2);
    }
    const TriangulationBatch batch = many.triangulate_batch(std::span<const double>(all), offsets);
    ASSERT_EQ(batch.size(), sets.size());
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const Triangulation mesh = batch.triangulation(s);
      ASSERT_TRUE(verified(sets[s], mesh)) << "set " << begin + s;
      ASSERT_EQ(mesh.hash(), one.triangulate(std::span<const double>(sets[s])).hash()) << "set " << begin + s;
    }
  }
}
CADT_ON_MAIN_BACKENDS(WorstCases);

// Launches with locks in which threads conflict, of sets so small that all triangles are contended.
TEST_P(WorstCases, SmallMeshesInDispute) {
  const std::size_t meshes = number_from("CADT_SMALL_MESHES", 10000) / 10;
  Random random(static_cast<std::uint64_t>(65 + meshes));
  Options options = with_locks();
  options.tuning.grain = 1;
  Triangulator disputed(options);
  Options serial;
  serial.backend = Backend::host;
  serial.threads = 1;
  Triangulator one(serial);
  for (std::size_t s = 0; s < meshes; ++s) {
    const Points xy = small_set(random);
    const Triangulation mesh = disputed.triangulate(std::span<const double>(xy));
    ASSERT_TRUE(verified(xy, mesh)) << "set " << s;
    ASSERT_EQ(mesh.hash(), one.triangulate(std::span<const double>(xy)).hash()) << "set " << s;
  }
}

}  // namespace
}  // namespace cadt::test
