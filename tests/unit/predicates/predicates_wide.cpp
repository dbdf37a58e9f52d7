// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 1
#include "tests/unit/predicates/device_predicates.ipp"

namespace cadt::test {
Signs wide_signs(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint d) { return signs(a, b, c, d); }
int wide_around_centroid(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint p, PlanePoint q) {
  return around_centroid(a, b, c, p, q);
}
}  // namespace cadt::test
