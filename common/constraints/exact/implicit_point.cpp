// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact/implicit_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/driver/device_text.hpp"

namespace cadt::exact {
namespace {

/// A bound on how far the exact coordinate is from the rounded one: half a unit in the last place.
double error_of(double rounded, int rest) { return rest == 0 ? 0 : std::abs(rounded) * 0x1p-53 + 0x1p-1074; }

/// The order of two coordinates, or unsure: rounding is monotone, so the rounded ones are in the order of the exact
/// ones.
int compare_rounded(double a, int rest_a, double b, int rest_b) {
  if (a != b) return a < b ? -1 : 1;
  if (rest_a != rest_b) return rest_a < rest_b ? -1 : 1;
  return rest_a == 0 ? 0 : stage::unsure;
}

/// The vector from one point to another times the product of their w, and that product.
struct Vector {
  Number x, y, w;
};
Vector vector(const Arithmetic& of, const Homogeneous& from, const Homogeneous& to) {
  return {of.minor(to.x, from.w, from.x, to.w), of.minor(to.y, from.w, from.y, to.w), of.multiply(from.w, to.w)};
}

}  // namespace

Homogeneous crossing_of(const Line& s, const Line& t, Arena& arena) {
  const Arithmetic of(arena);
  const Number ax = of.number(s.a.x), ay = of.number(s.a.y), cx = of.number(t.a.x), cy = of.number(t.a.y);
  const Number ux = of.subtract(of.number(s.b.x), ax), uy = of.subtract(of.number(s.b.y), ay);
  const Number vx = of.subtract(of.number(t.b.x), cx), vy = of.subtract(of.number(t.b.y), cy);
  // a + u (c - a) x v / (u x v)
  Number w = of.minor(ux, vy, uy, vx);
  Number along = of.minor(of.subtract(cx, ax), vy, of.subtract(cy, ay), vx);
  if (w.negative) w = -w, along = -along;
  return {of.add(of.multiply(ax, w), of.multiply(ux, along)), of.add(of.multiply(ay, w), of.multiply(uy, along)), w};
}

Homogeneous ImplicitPoints::homogeneous(const Place& p, Arena& arena) const {
  if (!p.is_double())
    return crossing_of(lines_[static_cast<std::size_t>(p.first)], lines_[static_cast<std::size_t>(p.second)], arena);
  const Arithmetic of(arena);
  return {of.number(p.x), of.number(p.y), of.number(1.0)};
}

Place ImplicitPoints::crossing(std::int32_t first, std::int32_t second) const {
  Arena arena;
  const Homogeneous p =
      crossing_of(lines_[static_cast<std::size_t>(first)], lines_[static_cast<std::size_t>(second)], arena);
  const Rounded x = round_quotient(p.x, p.w, arena), y = round_quotient(p.y, p.w, arena);
  return {.x = x.value,
          .y = y.value,
          .first = first,
          .second = second,
          .rest_x = static_cast<std::int8_t>(x.rest),
          .rest_y = static_cast<std::int8_t>(y.rest)};
}

int ImplicitPoints::compare(const Place& a, const Place& b) const {
  if (a.first >= 0 && a.first == b.first && a.second == b.second) return 0;
  const int x = compare_rounded(a.x, a.rest_x, b.x, b.rest_x), y = compare_rounded(a.y, a.rest_y, b.y, b.rest_y);
  if (x != 0 && x != stage::unsure) return x;
  if (x == 0 && y != stage::unsure) return y;
  Arena arena;
  const Arithmetic of(arena);
  const Homogeneous p = homogeneous(a, arena), q = homogeneous(b, arena);
  if (x == stage::unsure)
    if (const int order = exact::compare(of.multiply(p.x, q.w), of.multiply(q.x, p.w)); order != 0) return order;
  return y != stage::unsure ? y : exact::compare(of.multiply(p.y, q.w), of.multiply(q.y, p.w));
}

int ImplicitPoints::orientation(const Place& a, const Place& b, const Place& c) const {
  if (a.is_double() && b.is_double() && c.is_double())
    return verifier::orientation(a.rounded(), b.rounded(), c.rounded());
  const int sign = stage::orientation_filter(a, b, c);
  return sign != stage::unsure ? sign : stage::orientation_exact(*this, a, b, c);
}

int ImplicitPoints::incircle(const Place& a, const Place& b, const Place& c, const Place& d) const {
  if (a.is_double() && b.is_double() && c.is_double() && d.is_double())
    return verifier::incircle(a.rounded(), b.rounded(), c.rounded(), d.rounded());
  const int sign = stage::incircle_filter(a, b, c, d);
  return sign != stage::unsure ? sign : stage::incircle_exact(*this, a, b, c, d);
}

// The point that is lexicographically the greatest decides: verifier::incircle_perturbed has the reason.
int ImplicitPoints::incircle_perturbed(const Place& a, const Place& b, const Place& c, const Place& d) const {
  if (const int sign = incircle(a, b, c, d); sign != 0) return sign;
  std::array<const Place*, 4> order{&a, &b, &c, &d};
  std::sort(order.begin(), order.end(), [this](const Place* p, const Place* q) { return compare(*p, *q) < 0; });
  for (std::size_t i = 4; i-- > 0;) {
    int side = 0;
    if (order[i] == &d) return -1;
    if (order[i] == &a) side = orientation(d, b, c);
    if (order[i] == &b) side = orientation(a, d, c);
    if (order[i] == &c) side = orientation(a, b, d);
    if (side != 0) return side;
  }
  return -1;
}

namespace stage {

namespace {

/// As the filters of the device take it (exact_places.dev.h).
device_text::cadt_rounded rounded_of(const Place& p) {
  return {{p.x, p.y}, error_of(p.x, p.rest_x), error_of(p.y, p.rest_y)};
}
int sign_or_unsure(int sign) { return sign != 0 ? sign : unsure; }

}  // namespace

int orientation_filter(const Place& a, const Place& b, const Place& c) {
  return sign_or_unsure(device_text::cadt_orientation_about(rounded_of(a), rounded_of(b), rounded_of(c)));
}

int incircle_filter(const Place& a, const Place& b, const Place& c, const Place& d) {
  return sign_or_unsure(device_text::cadt_incircle_about(rounded_of(a), rounded_of(b), rounded_of(c), rounded_of(d)));
}

int orientation_exact(const ImplicitPoints& points, const Place& a, const Place& b, const Place& c) {
  const Place *p = &a, *q = &b, *r = &c;  // turned until r is explicit, if one is: its w is 1
  for (int turn = 0; turn < 2 && !r->is_double(); ++turn) p = std::exchange(q, std::exchange(r, p));
  Arena arena;
  const Arithmetic of(arena);
  const Homogeneous from = points.homogeneous(*r, arena);
  const Vector u = vector(of, from, points.homogeneous(*p, arena));
  const Vector v = vector(of, from, points.homogeneous(*q, arena));
  return compare(of.multiply(u.x, v.y), of.multiply(u.y, v.x));
}

int incircle_exact(const ImplicitPoints& points, const Place& a, const Place& b, const Place& c, const Place& d) {
  std::array<const Place*, 4> corner{&a, &b, &c, &d};
  int sign = 1;
  for (std::size_t i = 0; i < 3 && !corner[3]->is_double(); ++i)
    if (corner[i]->is_double()) std::swap(corner[i], corner[3]), sign = -1;
  Arena arena;
  const Arithmetic of(arena);
  const Homogeneous from = points.homogeneous(*corner[3], arena);
  std::array<Homogeneous, 3> point;
  std::array<Vector, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    point[i] = points.homogeneous(*corner[i], arena);
    v[i] = vector(of, from, point[i]);
  }
  // The lift of i is over w_i^2 and the minor of j, k over w_j w_k: all over w_1^2 w_2^2 w_3^2 > 0
  Number det;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Number lift = of.add(of.multiply(v[i].x, v[i].x), of.multiply(v[i].y, v[i].y));
    const Number minor = of.multiply(of.minor(v[j].x, v[k].y, v[k].x, v[j].y), of.multiply(point[j].w, point[k].w));
    det = of.add(det, of.multiply(lift, minor));
  }
  return sign * det.sign();
}

}  // namespace stage
}  // namespace cadt::exact
