// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/predicates/device_predicates.hpp"

namespace {
#include "common/device/locate.h"

cadt_point point(cadt::test::PlanePoint p) { return {p.x, p.y}; }

cadt::test::Signs signs(cadt::test::PlanePoint a, cadt::test::PlanePoint b, cadt::test::PlanePoint c,
                        cadt::test::PlanePoint d) {
  cadt_tally tally;
  cadt_tally_clear(&tally);
  cadt::test::Signs s{};
  s.orientation = cadt_orientation(point(a), point(b), point(c), &tally);
  s.exact_orientation = tally.count[CADT_COUNT_EXACT_ORIENTATIONS] != 0;
  s.incircle = cadt_incircle(point(a), point(b), point(c), point(d), &tally);
  s.exact_incircle = tally.count[CADT_COUNT_EXACT_INCIRCLES] != 0;
  s.tie = tally.count[CADT_COUNT_TIES] != 0;
  return s;
}

int around_centroid(cadt::test::PlanePoint a, cadt::test::PlanePoint b, cadt::test::PlanePoint c,
                    cadt::test::PlanePoint p, cadt::test::PlanePoint q) {
  const cadt_point points[3] = {point(a), point(b), point(c)};
  cadt_mesh mesh{};
  mesh.points = points;
  mesh.first = 0;
  mesh.second = 1;
  mesh.third = 2;
  mesh.center = {a.x / 3 + b.x / 3 + c.x / 3, a.y / 3 + b.y / 3 + c.y / 3};
  cadt_tally tally;
  cadt_tally_clear(&tally);
  return cadt_around_center(&mesh, point(p), point(q), &tally);
}
}  // namespace
