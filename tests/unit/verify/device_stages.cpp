// SPDX-License-Identifier: Apache-2.0
#include "device_stages.hpp"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace {
#include "common/verify/device/verify_predicates.dev.h"

using cadt::verifier::Point;
cadt_point at(const Point& p) { return {p.x, p.y}; }
device_stage::Sign sign(cadt_i32 s, int factor) {
  if (s == CADT_UNKNOWN) return std::nullopt;
  return factor * s;
}
}  // namespace

namespace device_stage {

Sign turn_filter(const Point& a, const Point& b, const Point& c) {
  return sign(cadt_verify_turn_filter(at(a), at(b), at(c)), 1);
}
Sign turn_exact(const Point& a, const Point& b, const Point& c) {
  return sign(cadt_verify_turn_exact(at(a), at(b), at(c)), 1);
}
Sign incircle_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
  return sign(cadt_verify_edge_filter(at(a), at(b), at(c), at(d)), -1);
}
Sign incircle_exact(const Point& a, const Point& b, const Point& c, const Point& d) {
  return sign(cadt_verify_edge_exact(at(a), at(b), at(c), at(d)), -1);
}
bool tie_is_usual(const Point& a, const Point& b, const Point& c, const Point& d) {
  return cadt_verify_tie_is_usual(at(a), at(b), at(c), at(d)) != 0;
}

}  // namespace device_stage
