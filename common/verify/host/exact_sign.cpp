// SPDX-License-Identifier: Apache-2.0
#include "exact_sign.hpp"

#include "exact_expansion.hpp"
#include "exact_integer.hpp"

#include <array>
#include <bit>
#include <cfloat>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace cadt::verifier {
namespace {

// The bounds of the filters and the expansions hold for IEEE doubles without excess precision.
static_assert(std::numeric_limits<double>::is_iec559 && FLT_EVAL_METHOD == 0);
#ifdef __FAST_MATH__
#error "the verifier must not be built with -ffast-math"
#endif

/// A finite double as (-1)^negative * mantissa * 2^exponent, mantissa odd, or zero.
struct Parts {
  std::uint64_t mantissa;
  int exponent;
  bool negative;
};

Parts parts(double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  const auto field = static_cast<int>((bits >> 52) & 0x7ff);
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
  const std::uint64_t m = field == 0 ? fraction : fraction | (std::uint64_t{1} << 52);
  if (m == 0) return {0, 0, false};
  const int zeros = std::countr_zero(m);
  return {m >> zeros, std::max(field, 1) - 1075 + zeros, (bits >> 63) != 0};
}

/// All coordinates as integers times 2^low; the largest has `width` bits. width <= 2098 for finite doubles.
template <std::size_t Count>
struct Common {
  std::array<Parts, Count> part;
  int low = 0, width = 0;

  explicit Common(const std::array<double, Count>& value) {  // NOLINT: part is filled below
    int lowest = 2000, high = -2000;
    for (std::size_t i = 0; i < Count; ++i) {
      part[i] = parts(value[i]);
      if (part[i].mantissa == 0) continue;
      lowest = std::min(lowest, part[i].exponent);
      high = std::max(high, part[i].exponent + static_cast<int>(std::bit_width(part[i].mantissa)));
    }
    if (high > lowest) low = lowest, width = high - lowest;
  }
  /// \pre width <= 62
  [[nodiscard]] std::int64_t small(std::size_t i) const {
    if (part[i].mantissa == 0) return 0;
    const auto m = static_cast<std::int64_t>(part[i].mantissa << (part[i].exponent - low));
    return part[i].negative ? -m : m;
  }
  [[nodiscard]] Integer<33> integer(std::size_t i) const {
    if (part[i].mantissa == 0) return {};
    return {part[i].negative, part[i].mantissa, static_cast<unsigned>(part[i].exponent - low)};
  }
};

int sign_of(i128 v) { return (v > 0) - (v < 0); }

/// a - b if that is a double, and zero or of a modulus in [2^-216, 2^250].
bool exact_difference(double a, double b, double& d) {
  d = a - b;
  if (d == 0) return true;
  const double m = std::abs(d);
  if (!(m >= 0x1p-216 && m <= 0x1p250)) return false;
  const double b_part = a - d;  // the error of Knuth's two-sum of a and -b
  const double a_part = d + b_part;
  return (a - a_part) - (b - b_part) == 0;
}

using Cross = Expansion<4>;
Cross cross(double ax, double ay, double bx, double by) {
  Cross r;
  r.add_product(ax, by);
  r.add_product(-bx, ay);
  return r;
}

using Difference = Integer<33>;
Integer<66> cross(const Difference& ax, const Difference& ay, const Difference& bx, const Difference& by) {
  return difference(product(ax, by), product(bx, ay));
}
Integer<66> lift(const Difference& x, const Difference& y) { return sum(product(x, x), product(y, y)); }

}  // namespace

namespace stage {

// Coordinates of at most 62 bits differ by less than 2^63; a product of two such is below 2^126 in modulus, and the
// difference of two of these below 2^127.
Sign orientation_integer(const Point& a, const Point& b, const Point& c) {
  const Common<6> v({a.x, a.y, b.x, b.y, c.x, c.y});
  if (v.width > 62) return std::nullopt;
  const std::int64_t x = v.small(4), y = v.small(5);
  const std::int64_t ax = v.small(0) - x, ay = v.small(1) - y, bx = v.small(2) - x, by = v.small(3) - y;
  return sign_of(i128{ax} * by - i128{ay} * bx);
}

// Differences below 2^30: lift and cross are at most 2^61, a product 2^122, the sum of three below 2^124.
Sign incircle_integer(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Common<8> v({a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y});
  if (v.width > 62) return std::nullopt;
  std::array<std::int64_t, 6> p{};
  for (std::size_t i = 0; i < 6; ++i) {
    p[i] = v.small(i) - v.small(6 + i % 2);
    if (std::abs(p[i]) >= (std::int64_t{1} << 30)) return std::nullopt;
  }
  const auto [ax, ay, bx, by, cx, cy] = p;
  return sign_of(i128{ax * ax + ay * ay} * (bx * cy - cx * by) + i128{bx * bx + by * by} * (cx * ay - ax * cy) +
                 i128{cx * cx + cy * cy} * (ax * by - bx * ay));
}

// Differences in [2^-216, 2^250] are multiples of 2^-268. Then all terms of degree 4 are multiples of 2^-1072, which no
// operation can lose, and below 2^1005: the expansions are exact.
Sign orientation_expansion(const Point& a, const Point& b, const Point& c) {
  double ax, ay, bx, by;  // NOLINT: set by exact_difference
  if (!exact_difference(a.x, c.x, ax) || !exact_difference(a.y, c.y, ay) || !exact_difference(b.x, c.x, bx) ||
      !exact_difference(b.y, c.y, by))
    return std::nullopt;
  return cross(ax, ay, bx, by).sign();
}

Sign incircle_expansion(const Point& a, const Point& b, const Point& c, const Point& d) {
  const std::array<Point, 3> corner{a, b, c};
  std::array<Point, 3> p{};
  for (std::size_t i = 0; i < 3; ++i)
    if (!exact_difference(corner[i].x, d.x, p[i].x) || !exact_difference(corner[i].y, d.y, p[i].y)) return std::nullopt;
  Expansion<96> det;  // 3 times 4 x 4 products of two terms each
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &q = p[(i + 1) % 3], &r = p[(i + 2) % 3];
    Cross up;
    up.add_product(p[i].x, p[i].x);
    up.add_product(p[i].y, p[i].y);
    const Cross side = cross(q.x, q.y, r.x, r.y);
    for (std::size_t j = 0; j < up.size(); ++j)
      for (std::size_t k = 0; k < side.size(); ++k) det.add_product(up[j], side[k]);
  }
  return det.sign();
}

int orientation_long(const Point& a, const Point& b, const Point& c) {
  const Common<6> v({a.x, a.y, b.x, b.y, c.x, c.y});
  const Difference x = v.integer(4), y = v.integer(5);
  return cross(difference(v.integer(0), x), difference(v.integer(1), y), difference(v.integer(2), x),
               difference(v.integer(3), y))
      .sign();
}

// Coordinates have at most 2098 bits, differences 2099 (33 limbs hold 2112), lift and cross 4199 (66 limbs: 4224), the
// sum of three products 8400 (132 limbs: 8448).
int incircle_long(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Common<8> v({a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y});
  const Difference x = v.integer(6), y = v.integer(7);
  const Difference ax = difference(v.integer(0), x), ay = difference(v.integer(1), y);
  const Difference bx = difference(v.integer(2), x), by = difference(v.integer(3), y);
  const Difference cx = difference(v.integer(4), x), cy = difference(v.integer(5), y);
  return sum(sum(product(lift(ax, ay), cross(bx, by, cx, cy)), product(lift(bx, by), cross(cx, cy, ax, ay))),
             product(lift(cx, cy), cross(ax, ay, bx, by)))
      .sign();
}

}  // namespace stage

int orientation(const Point& a, const Point& b, const Point& c) {
  if (const auto s = stage::orientation_filter(a, b, c)) return *s;
  if (const auto s = stage::orientation_integer(a, b, c)) return *s;
  if (const auto s = stage::orientation_expansion(a, b, c)) return *s;
  return stage::orientation_long(a, b, c);
}

int incircle(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (const auto s = stage::incircle_filter(a, b, c, d)) return *s;
  if (const auto s = stage::incircle_integer(a, b, c, d)) return *s;
  if (const auto s = stage::incircle_expansion(a, b, c, d)) return *s;
  return stage::incircle_long(a, b, c, d);
}

// The lifted point of rank i is raised by e^(4 - i): the lexicographically greatest point dominates. Raising d puts it
// outside; raising a vertex puts d on the side given by the sign of that vertex's cofactor, which is the orientation of
// the triangle with d in its place.
int incircle_perturbed(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<const Point*, 4> order{&a, &b, &c, &d};
  std::sort(order.begin(), order.end(), [](const Point* p, const Point* q) { return lexicographic_less(*p, *q); });
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

}  // namespace cadt::verifier
