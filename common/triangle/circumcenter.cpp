// SPDX-License-Identifier: Apache-2.0
#include "common/triangle/circumcenter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadt {
namespace {

/// A number as a double and what is left of it.
struct Sum {
  double high, low;
};

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

/// b - a for points, divided by a power of two that brings the larger component to 1/2 ... 1.
struct Side {
  Sum x, y;
  int exponent = 0;
  [[nodiscard]] double squared() const noexcept { return x.high * x.high + y.high * y.high; }
};

Side side(const Corner& from, const Corner& to) noexcept {
  Side s{exact_sum(to[0], -from[0]), exact_sum(to[1], -from[1])};
  static_cast<void>(std::frexp(std::max(std::abs(s.x.high), std::abs(s.y.high)), &s.exponent));
  for (double* v : {&s.x.high, &s.x.low, &s.y.high, &s.y.low}) *v = std::ldexp(*v, -s.exponent);
  return s;
}

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

}  // namespace

Circumcenter circumcenter(const Corner& a, const Corner& b, const Corner& c) noexcept {
  // Differences of coordinates above a quarter of the largest double could overflow.
  const double largest =
      std::max({std::abs(a[0]), std::abs(a[1]), std::abs(b[0]), std::abs(b[1]), std::abs(c[0]), std::abs(c[1])});
  if (largest > std::numeric_limits<double>::max() / 4) {
    const auto smaller = [](const Corner& p) { return Corner{p[0] / 8, p[1] / 8}; };
    const auto [x, y, weights] = circumcenter(smaller(a), smaller(b), smaller(c));
    return {8 * x, 8 * y, weights};
  }
  // From an end of the shortest side the sums below lose nothing: their terms are of the size of what they sum up to.
  const double ab = length(a, b), bc = length(b, c), ca = length(c, a);
  if (bc < ab && bc <= ca) {
    const auto [x, y, w] = circumcenter(b, c, a);
    return {x, y, {w[2], w[0], w[1]}};
  }
  if (ca < ab && ca < bc) {
    const auto [x, y, w] = circumcenter(c, a, b);
    return {x, y, {w[1], w[2], w[0]}};
  }
  const Side p = side(a, b), q = side(a, c);
  const double area = cross(p, q), pp = p.squared(), qq = q.squared();
  // With p and q times their powers of two: centre - a = (qy pp - py qq, px qq - qx pp) / (2 area).
  const int less = p.exponent - q.exponent;  // at most 1
  const double x = std::ldexp(q.y.high * pp, less) - p.y.high * qq;
  const double y = p.x.high * qq - std::ldexp(q.x.high * pp, less);
  // The weight of a corner: the square of the opposite side times the product of the other two, over 2 area^2.
  const double pq = p.x.high * q.x.high + p.y.high * q.y.high;
  const double dx = q.x.high - std::ldexp(p.x.high, less), dy = q.y.high - std::ldexp(p.y.high, less);
  const auto weight = [&](double value, int exponent) {
    return std::ldexp(quotient(quotient(value, 2 * area), area), exponent);
  };
  return {a[0] + std::ldexp(quotient(x, 2 * area), q.exponent),
          a[1] + std::ldexp(quotient(y, 2 * area), q.exponent),
          {weight(pq * (dx * dx + dy * dy), -less), weight(qq * (pp - std::ldexp(pq, -less)), 0),
           weight(pp * (qq - std::ldexp(pq, less)), 0)}};
}

}  // namespace cadt
