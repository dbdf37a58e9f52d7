// SPDX-License-Identifier: Apache-2.0
// The star stage beside the reference.
#pragma once

#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>

namespace cadt::test {

using Reals = std::span<const double>;

/// The reference: insertion by one thread of the host.
inline Triangulation with_locks(PointsView points) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  options.tuning.strategy = Strategy::locks;
  return triangulate(points, options);
}

inline testing::AssertionResult same_arrays(const Triangulation& mesh, const Triangulation& expected) {
  const auto differ = [](const char* what) { return testing::AssertionFailure() << what << " differ"; };
  if (!std::ranges::equal(mesh.triangles(), expected.triangles())) return differ("triangles");
  if (!std::ranges::equal(mesh.neighbors(), expected.neighbors())) return differ("neighbors");
  if (!std::ranges::equal(mesh.hull(), expected.hull())) return differ("hulls");
  if (!std::ranges::equal(mesh.duplicates(), expected.duplicates())) return differ("duplicates");
  if (mesh.dimension() != expected.dimension()) return differ("dimensions");
  return testing::AssertionSuccess();
}

class Stars : public BackendTest {
 protected:
  void SetUp() override {
    BackendTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::stars;
    stars_.emplace(options);
  }
  void TearDown() override { stars_.reset(); }

  Triangulator& stars() { return *stars_; }

  /// The mesh with stars, compared with the reference.
  Triangulation expect_same(const std::string& what, const Points& xy) {
    SCOPED_TRACE(what);
    const Triangulation expected = with_locks(Reals(xy));
    Triangulation mesh = stars().triangulate(Reals(xy));
    EXPECT_TRUE(same_arrays(mesh, expected));
    EXPECT_EQ(mesh.hash(), expected.hash());
    if (mesh.dimension() == 2) {
      EXPECT_TRUE(mesh.statistics().certified);
      EXPECT_EQ(mesh.statistics().certified_edges, 3 * mesh.statistics().distinct - 3);
    }
    EXPECT_LE(mesh.statistics().proven_stars, mesh.statistics().distinct);
    // One thread leaves no edge to the legality sweep, so any repair is of a star that was wrongly proven.
    if (GetParam().backend == Backend::host && GetParam().threads == 1) {
      EXPECT_EQ(mesh.statistics().sweep_repairs, 0u);
    }
    return mesh;
  }

 private:
  std::optional<Triangulator> stars_;
};

}  // namespace cadt::test
