// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#include "tests/unit/predicates/device_predicates.ipp"

namespace cadt::test {
Signs narrow_signs(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint d) { return signs(a, b, c, d); }
int narrow_around_centroid(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint p, PlanePoint q) {
  return around_centroid(a, b, c, p, q);
}
}  // namespace cadt::test
