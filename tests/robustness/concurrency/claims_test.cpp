// SPDX-License-Identifier: Apache-2.0
// Threads side by side insert segments that meet: pieces claim the same triangles and wait, and nothing of it shows.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"

#include <cadt/constrained.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

struct Sketch {
  Points xy;
  std::vector<Segment> segments;
  std::int32_t add(double x, double y) {
    xy.insert(xy.end(), {x, y});
    return static_cast<std::int32_t>(xy.size() / 2) - 1;
  }
};

/// Polylines as close to each other as points are: each segment crosses triangles of others.
Sketch polylines() {
  Sketch sketch{uniform_points(3000, 3), {}};
  Random random(5);
  const int rows = 50, columns = 20;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const std::int32_t v = sketch.add(static_cast<double>(column) / columns, (row + random.uniform(0.2, 0.8)) / rows);
      if (column != 0) sketch.segments.push_back({v - 1, v});
    }
  }
  return sketch;
}

/// More segments on a line than there is room for their pieces, so that those that are the same are sought.
Sketch overlapping() {
  Sketch sketch{uniform_points(300, 4), {}};
  Random random(6);
  for (int i = 0; i < 12; ++i) sketch.add(i / 11.0, 0.5);
  for (int i = 0; i < 4000; ++i) {
    const auto from = static_cast<std::int32_t>(random.below(12)), to = static_cast<std::int32_t>(random.below(12));
    sketch.segments.push_back({300 + from, 300 + to});
  }
  return sketch;
}

class Claims : public BackendTest {
 protected:
  /// Statistics of all runs, whose meshes are that of one thread.
  static Statistics run(const Sketch& sketch) {
    Options serial;
    serial.backend = Backend::host;
    serial.threads = 1;
    ConstraintOptions constraints;
    constraints.domain = Domain::layers;
    const ConstrainedTriangulation expected = triangulate_constrained(sketch.xy, sketch.segments, constraints, serial);
    const char* variable = std::getenv("CADT_CONFLICT_RUNS");
    const int asked = variable != nullptr ? std::atoi(variable) : 0, runs = 1 + (asked > 0 ? asked : 200) / 20;
    Statistics all;
    for (int i = 0; i < runs; ++i) {
      Options options = GetParam().options();
      options.tuning.grain = 1;
      const ConstrainedTriangulation mesh = triangulate_constrained(sketch.xy, sketch.segments, constraints, options);
      EXPECT_EQ(mesh.hash(), expected.hash()) << "run " << i;
      EXPECT_TRUE(std::ranges::equal(mesh.region(), expected.region())) << "run " << i;
      const VerifyReport report = verify(sketch.xy, sketch.segments, mesh, constraints);
      EXPECT_TRUE(report.ok) << report.summary();
      all.inserted_segments += mesh.statistics().inserted_segments;
      all.segment_retries += mesh.statistics().segment_retries;
    }
    return all;
  }
};

TEST_P(Claims, Polylines) {
  const Statistics s = run(polylines());
  EXPECT_GT(s.segment_retries, s.inserted_segments / 4);
  RecordProperty("segment_retries", std::to_string(s.segment_retries));
}

TEST_P(Claims, Overlapping) {
  const Statistics s = run(overlapping());
  EXPECT_GT(s.inserted_segments, 10U);
}

CADT_ON_EVERY_BACKEND(Claims);

}  // namespace
}  // namespace cadt::test
