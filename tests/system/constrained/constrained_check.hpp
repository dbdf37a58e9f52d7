// SPDX-License-Identifier: Apache-2.0
// What every test of constrained triangulations asks of a mesh.
#pragma once

#include <cadt/constrained.hpp>

#include <string>
#include <vector>

#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"

namespace cadt::test {

class ConstrainedTest : public BackendTest {
 protected:
  [[nodiscard]] ConstrainedTriangulation triangulated(const Points& xy, const std::vector<Segment>& segments,
                                                      const ConstraintOptions& constraints = {}) const;
  /// The mesh, verified, its chains compared with the points on the segments, and triangles and constrained edges with
  /// CGAL's, where that is installed and there are at most `most_for_cgal` points.
  ConstrainedTriangulation check(const Points& xy, const std::vector<Segment>& segments,
                                 std::size_t most_for_cgal = 100000) const;
};

/// Points and segments, as they are made for a test.
struct Drawing {
  Points xy;
  std::vector<Segment> segments;

  /// Its index.
  std::int32_t add(double x, double y);
  void join(std::int32_t from, std::int32_t to) { segments.push_back({from, to}); }
  /// Segments between consecutive points.
  void join(const std::vector<std::int32_t>& along);
  [[nodiscard]] std::size_t points() const { return xy.size() / 2; }
};

}  // namespace cadt::test
