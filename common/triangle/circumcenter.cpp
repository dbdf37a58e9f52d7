// SPDX-License-Identifier: Apache-2.0
#include "common/triangle/circumcenter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadt {
namespace {

using Sum = Circumcenter::Sum;
using Side = Circumcenter::Side;

Sum exact_sum(double a, double b) noexcept {
  const double high = a + b, part = high - a;
  return {high, (a - (high - part)) + (b - part)};
}

Sum exact_product(double a, double b) noexcept {
  const double high = a * b;
#if defined(__MINGW32__)  // whose std::fma() rounds twice
  return {high, static_cast<double>(static_cast<__float128>(a) * b - high)};
#else
  return {high, std::fma(a, b, -high)};
#endif
}

Side side(const Corner& from, const Corner& to) noexcept {
  Side s{exact_sum(to[0], -from[0]), exact_sum(to[1], -from[1])};
  static_cast<void>(std::frexp(std::max(std::abs(s.x.high), std::abs(s.y.high)), &s.exponent));
  for (double* v : {&s.x.high, &s.x.low, &s.y.high, &s.y.low}) *v = std::ldexp(*v, -s.exponent);
  return s;
}

double squared(const Side& s) noexcept { return s.x.high * s.x.high + s.y.high * s.y.high; }

double length(const Corner& a, const Corner& b) noexcept { return std::hypot(b[0] - a[0], b[1] - a[1]); }

/// An exact sum of doubles as components that do not overlap, the smallest first (Shewchuk's expansions).
class Expansion {
 public:
  void add(double value) noexcept {
    for (int i = 0; i < size_; ++i) {
      const Sum sum = exact_sum(value, parts_[i]);
      parts_[i] = sum.low;
      value = sum.high;
    }
    parts_[size_++] = value;
  }
  void add_product(double a, double b) noexcept {
    const Sum product = exact_product(a, b);
    add(product.low);
    add(product.high);
  }
  [[nodiscard]] double rounded() const noexcept {
    double sum = 0;
    for (int i = 0; i < size_; ++i) sum += parts_[i];
    return sum;
  }

 private:
  double parts_[16];
  int size_ = 0;
};

double cross(const Side& b, const Side& c) noexcept {
  Expansion sum;
  for (const double bx : {b.x.low, b.x.high}) {
    for (const double cy : {c.y.low, c.y.high}) sum.add_product(bx, cy);
  }
  for (const double by : {b.y.low, b.y.high}) {
    for (const double cx : {c.x.low, c.x.high}) sum.add_product(-by, cx);
  }
  return sum.rounded();
}

/// 0 / 0 is 0: where area has no double, nothing is known of the centre's direction.
double quotient(double value, double divisor) noexcept { return value == 0 ? 0 : value / divisor; }

/// A double times a power of two, which no product takes beyond the largest double.
struct Scaled {
  explicit Scaled(double value) noexcept { factor = std::frexp(value, &exponent); }
  double factor;
  int exponent;
};

/// a b / (2 c c) + d e / (2 c c), divided by 2^exponent. \pre c is not 0
double sum_of_products(double a, double b, double d, double e, double c, int exponent) noexcept {
  const Scaled divisor(c);
  const auto product = [&](double v, double w) {
    const Scaled first(v), second(w);
    Scaled result(first.factor * second.factor / (2 * divisor.factor * divisor.factor));
    result.exponent += first.exponent + second.exponent - 2 * divisor.exponent - exponent;
    return result;
  };
  const Scaled one = product(a, b), other = product(d, e);
  if (one.factor == 0) return std::ldexp(other.factor, other.exponent);
  if (other.factor == 0) return std::ldexp(one.factor, one.exponent);
  const int most = std::max(one.exponent, other.exponent);
  const double sum = std::ldexp(one.factor, one.exponent - most) + std::ldexp(other.factor, other.exponent - most);
  return std::ldexp(sum, most);
}

}  // namespace

Circumcenter circumcenter(const Corner& a, const Corner& b, const Corner& c) noexcept {
  // Differences of coordinates above a quarter of the largest double could overflow.
  const double largest =
      std::max({std::abs(a[0]), std::abs(a[1]), std::abs(b[0]), std::abs(b[1]), std::abs(c[0]), std::abs(c[1])});
  if (largest > std::numeric_limits<double>::max() / 4) {
    const auto smaller = [](const Corner& p) { return Corner{p[0] / 8, p[1] / 8}; };
    Circumcenter center = circumcenter(smaller(a), smaller(b), smaller(c));
    center.x *= 8;
    center.y *= 8;
    return center;
  }
  // From an end of the shortest side the sums below lose nothing: their terms are of the size of what they sum up to.
  const double ab = length(a, b), bc = length(b, c), ca = length(c, a);
  const bool first_is_b = bc < ab && bc <= ca;
  if (first_is_b || (ca < ab && ca < bc)) {
    Circumcenter center = first_is_b ? circumcenter(b, c, a) : circumcenter(c, a, b);
    center.from = first_is_b ? 1 : 2;
    return center;
  }
  const Side p = side(a, b), q = side(a, c);
  const double area = cross(p, q), pp = squared(p), qq = squared(q);
  // With p and q times their powers of two: centre - a = (qy pp - py qq, px qq - qx pp) / (2 area).
  const int less = p.exponent - q.exponent;  // at most 1
  const double x = std::ldexp(q.y.high * pp, less) - p.y.high * qq;
  const double y = p.x.high * qq - std::ldexp(q.x.high * pp, less);
  return {a[0] + std::ldexp(quotient(x, 2 * area), q.exponent),
          a[1] + std::ldexp(quotient(y, 2 * area), q.exponent),
          0,
          p,
          q,
          area,
          {x, y}};
}

double Circumcenter::value(std::array<double, 3> corners) const noexcept {
  std::rotate(corners.begin(), corners.begin() + from, corners.end());
  const double largest = std::max({std::abs(corners[0]), std::abs(corners[1]), std::abs(corners[2])});
  const bool reduced = largest > std::numeric_limits<double>::max() / 4;  // differences could overflow
  if (reduced) {
    for (double& v : corners) v /= 8;
  }
  // Along p and along q. The slope, times the area: (dp qy - dq py, dq px - dp qx), without a rounding of what cancels.
  const Side d = side({corners[0], corners[0]}, {corners[1], corners[2]});
  const int less = p.exponent - q.exponent;
  const auto scaled = [&](const Sum& s) { return Sum{std::ldexp(s.high, less), std::ldexp(s.low, less)}; };
  const double slope_x = cross(d, {scaled(p.y), q.y}), slope_y = -cross(d, {scaled(p.x), q.x});
  const double change = area == 0 ? quotient(slope_x * twice[0] + slope_y * twice[1], 0)
                                  : sum_of_products(slope_x, twice[0], slope_y, twice[1], area, less - d.exponent);
  return reduced ? 8 * (corners[0] + change) : corners[0] + change;
}

}  // namespace cadt
