// SPDX-License-Identifier: Apache-2.0
#include "tests/robustness/fuzz/signs.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

namespace {
#pragma GCC diagnostic ignored "-Wunused-function"  // not all of the headers' are asked
#include "common/predicates/predicate_probe.dev.h"

std::vector<std::uint32_t> words(const std::vector<cadt::test::SignCase>& cases) {
  std::vector<cadt_point> points;
  std::vector<double> most;
  for (const cadt::test::SignCase& c : cases) {
    for (const auto& p : c.points) points.push_back({p.x, p.y});
    most.push_back(c.most);
  }
  std::vector<std::uint32_t> result(cases.size());
  const auto count = static_cast<cadt_u32>(cases.size());
  cadt_predicate_probe(0, 1, points.data(), most.data(), result.data(), count, count);
  return result;
}
}  // namespace
