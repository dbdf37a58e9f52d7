// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/predicates/device_predicates.hpp"

namespace {
#include "common/insertion/locate.dev.h"

cadt_point point(cadt::test::PlanePoint p) { return {p.x, p.y}; }

cadt::test::Signs signs(cadt::test::PlanePoint a, cadt::test::PlanePoint b, cadt::test::PlanePoint c,
                        cadt::test::PlanePoint d) {
  cadt_counters counters;
  cadt_counters_clear(&counters);
  cadt::test::Signs s{};
  s.orientation = cadt_orientation(point(a), point(b), point(c), &counters);
  s.exact_orientation = counters.count[CADT_COUNT_EXACT_ORIENTATIONS] != 0;
  s.incircle = cadt_incircle(point(a), point(b), point(c), point(d), &counters);
  s.exact_incircle = counters.count[CADT_COUNT_EXACT_INCIRCLES] != 0;
  s.tie = counters.count[CADT_COUNT_TIES] != 0;
  return s;
}

int around_centroid(cadt::test::PlanePoint a, cadt::test::PlanePoint b, cadt::test::PlanePoint c,
                    cadt::test::PlanePoint p, cadt::test::PlanePoint q) {
  const cadt_point points[3] = {point(a), point(b), point(c)};
  cadt_locked_mesh mesh{};
  mesh.points = points;
  mesh.first = 0;
  mesh.second = 1;
  mesh.third = 2;
  mesh.center = {a.x / 3 + b.x / 3 + c.x / 3, a.y / 3 + b.y / 3 + c.y / 3};
  cadt_counters counters;
  cadt_counters_clear(&counters);
  return cadt_around_center(&mesh, point(p), point(q), &counters);
}
}  // namespace
