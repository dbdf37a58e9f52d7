// SPDX-License-Identifier: Apache-2.0
// Meshes of the hostile families, made by one thread of the host.
#pragma once

#include "tests/support/families.hpp"

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <utility>

namespace cadt::test {

[[nodiscard]] inline Options one_thread() {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  return options;
}

/// Calls `examine(points, mesh)` for no points, and for all families.
template <class Examine>
void for_each_mesh(const Examine& examine) {
  Triangulator triangulator(one_thread());
  examine(Points(), triangulator.triangulate(PointsView()));
  for (const FamilyGroup& group : family_groups())
    for (const Family& family : group.families()) {
      SCOPED_TRACE(family.name);
      const Points xy = family.make();
      examine(xy, triangulator.triangulate(PointsView(xy)));
      if (testing::Test::HasFailure()) return;
    }
}

}  // namespace cadt::test
