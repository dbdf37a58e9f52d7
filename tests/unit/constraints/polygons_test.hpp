// SPDX-License-Identifier: Apache-2.0
// Polygons of a call against the constrained triangulation of each.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <map>

#include "tests/support/backends.hpp"
#include "tests/unit/constraints/polygon_sets.hpp"

namespace cadt::test {

class Polygons : public BackendTest {
 protected:
  [[nodiscard]] PolygonsResult triangulate(const PolygonSet& set) const {
    return set.triangulate(GetParam().options());
  }

  /// Each polygon becomes what it should; how many have each status.
  std::map<PolygonStatus, std::size_t> expect_equal(const PolygonSet& set) const {
    const PolygonsResult result = triangulate(set);
    std::map<PolygonStatus, std::size_t> counts;
    EXPECT_EQ(result.size(), set.size());
    std::size_t problem = 0;
    for (std::size_t p = 0; p < set.size() && !testing::Test::HasFailure(); ++p) {
      const Expected expected = expected_of(set, p);
      ++counts[expected.status];
      EXPECT_EQ(to_string(result.status()[p]), to_string(expected.status)) << "polygon " << p;
      EXPECT_EQ(as_set(set, result.triangles(p)), expected.triangles) << "polygon " << p;
      if (expected.status == PolygonStatus::ok || testing::Test::HasFailure()) continue;
      const PolygonProblem& found = result.problems()[problem++];
      EXPECT_EQ(found.polygon, p);
      EXPECT_EQ(found.status, expected.status);
      EXPECT_EQ(found.first, expected.first) << "polygon " << p;
      EXPECT_EQ(found.second, expected.second) << "polygon " << p;
    }
    EXPECT_EQ(result.problems().size(), problem);
    return counts;
  }
};

}  // namespace cadt::test
