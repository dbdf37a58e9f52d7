// SPDX-License-Identifier: Apache-2.0
// The device's predicates as the host compiles them, counting the lengths of integers that they take.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "tests/unit/predicates/counted.hpp"

namespace {
cadt::test::Lengths lengths;
#define CADT_STAGE(name) (++lengths.name)
#pragma GCC diagnostic ignored "-Wunused-function"  // not all of the header's are asked
#include "common/predicates/filtered_predicates.dev.h"

cadt::test::Lengths count(const std::vector<cadt::test::SignCase>& cases) {
  const auto point = [](cadt::test::PlanePoint p) {
    return cadt_point{static_cast<cadt_real>(p.x), static_cast<cadt_real>(p.y)};
  };
  lengths = {};
  for (const cadt::test::SignCase& c : cases) {
    cadt_counters counters;
    cadt_counters_clear(&counters);
    const cadt_point a = point(c.points[0]), b = point(c.points[1]), d = point(c.points[2]), p = point(c.points[3]);
    if (cadt_orientation(a, b, d, &counters) > 0) static_cast<void>(cadt_incircle(a, b, d, p, &counters));
  }
  return lengths;
}
}  // namespace
