// SPDX-License-Identifier: Apache-2.0
// Points that are given by the two segments which cross there, and predicates on them. As in M. Attene, "Indirect
// predicates for geometric constructions" (Computer-Aided Design 126, 2020) no coordinate is ever computed for a
// decision: signs come from the ends of the segments, which are doubles. Filters with the rounded coordinates decide
// most of them.
#pragma once

#include "common/constraints/exact/exact_number.hpp"
#include "common/verify/host/exact_sign.hpp"

#include <cstdint>
#include <span>

namespace cadt::exact {

using verifier::Point;

/// The two ends of a segment.
struct Line {
  Point a, b;
};

/// A point: explicit, with coordinates x, y, or where line `first` crosses line `second`; then x, y are those of the
/// crossing to the nearest double, ties to even. An implicit point whose coordinates are doubles counts as explicit.
struct Place {
  double x = 0, y = 0;
  std::int32_t first = -1, second = -1;
  std::int8_t rest_x = 0, rest_y = 0;  ///< signs of the exact coordinates minus the rounded ones

  [[nodiscard]] bool is_double() const { return rest_x == 0 && rest_y == 0; }
  [[nodiscard]] Point rounded() const { return {x, y}; }
};

[[nodiscard]] inline Place explicit_place(const Point& p) { return {.x = p.x, .y = p.y}; }

/// Homogeneous coordinates: the point is (x / w, y / w), and w > 0.
struct Homogeneous {
  Number x, y, w;
};
[[nodiscard]] Homogeneous crossing_of(const Line& s, const Line& t, Arena& arena);

/// Exact predicates for points of the same set of lines. const functions may run concurrently.
class ImplicitPoints {
 public:
  /// The lines must outlive this object.
  explicit ImplicitPoints(std::span<const Line> lines) : lines_(lines) {}

  /// Where two lines cross. \pre they do, inside both
  [[nodiscard]] Place crossing(std::int32_t first, std::int32_t second) const;

  /// Lexicographic order: negative if a is before b, 0 if they are the same point.
  [[nodiscard]] int compare(const Place& a, const Place& b) const;

  /// Positive if a, b, c are counterclockwise, 0 if they are on a line.
  [[nodiscard]] int orientation(const Place& a, const Place& b, const Place& c) const;

  /// Positive if d is inside the circle of the counterclockwise triangle a, b, c, 0 if on it.
  [[nodiscard]] int incircle(const Place& a, const Place& b, const Place& c, const Place& d) const;

  /// The same with ties broken as verifier::incircle_perturbed does. Never 0 for different points.
  [[nodiscard]] int incircle_perturbed(const Place& a, const Place& b, const Place& c, const Place& d) const;

  [[nodiscard]] Homogeneous homogeneous(const Place& p, Arena& arena) const;

 private:
  std::span<const Line> lines_;
};

/// The stages of the predicates, for tests.
namespace stage {
constexpr int unsure = 2;
[[nodiscard]] int orientation_filter(const Place& a, const Place& b, const Place& c);
[[nodiscard]] int incircle_filter(const Place& a, const Place& b, const Place& c, const Place& d);
[[nodiscard]] int orientation_exact(const ImplicitPoints& points, const Place& a, const Place& b, const Place& c);
[[nodiscard]] int incircle_exact(const ImplicitPoints& points, const Place& a, const Place& b, const Place& c,
                                 const Place& d);
}  // namespace stage

}  // namespace cadt::exact
