// SPDX-License-Identifier: Apache-2.0
#include "tests/predicates/cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "tests/verify/truth.hpp"

namespace cadt::test {
namespace {

// Fields of the word, as in common/device/signs.h. Not included from there: these files share no code with the
// predicates.
enum {
  orientation = 0,
  incircle = 2,
  oriented = 4,
  oriented_long = 6,
  inside = 8,
  inside_small = 10,
  inside_long = 12,
  tie = 14,
  exact_orientation = 16,
  exact_incircle = 17,
  tied = 18
};

std::uint64_t sign_bits(int sign, int at) { return static_cast<std::uint64_t>(sign + 1) << at; }

// ---- which stage must decide
// ----------------------------------------------------------------------------------------- J. R. Shewchuk's bounds of
// stage A, u = 2^-53. A filter that tells the sign below its bound is a fault even where the sign is right by luck.
const double unit = 0x1p-53, orientation_bound = (3 + 16 * unit) * unit, incircle_bound = (10 + 96 * unit) * unit;

struct Sum {
  double det, permanent;
};

Sum orientation_sum(double ux, double uy, double vx, double vy) {
  const double left = ux * vy, right = uy * vx;
  return {left - right, std::fabs(left) + std::fabs(right)};
}

Sum incircle_sum(const std::array<double, 6>& d) {
  const double bc = d[2] * d[5], cb = d[3] * d[4], ca = d[4] * d[1], ac = d[5] * d[0], ab = d[0] * d[3],
               ba = d[1] * d[2];
  const double a = d[0] * d[0] + d[1] * d[1], b = d[2] * d[2] + d[3] * d[3], c = d[4] * d[4] + d[5] * d[5];
  return {
      a * (bc - cb) + b * (ca - ac) + c * (ab - ba),
      a * (std::fabs(bc) + std::fabs(cb)) + b * (std::fabs(ca) + std::fabs(ac)) + c * (std::fabs(ab) + std::fabs(ba))};
}

/// Scales values by one power of two to at most 1; false if one has overflowed.
bool scale(std::initializer_list<double*> values) {
  int exponent = -1022;
  for (const double* v : values) {
    if (!std::isfinite(*v)) return false;
    int own = 0;
    if (*v != 0) std::frexp(*v, &own), exponent = std::max(exponent, own);
  }
  for (double* v : values) *v = std::ldexp(*v, -exponent);
  return true;
}

constexpr double wide_underflow = 1e-300;

bool orientation_is_exact(const Four& p, bool wide) {
  double ux = p[0].x - p[2].x, uy = p[0].y - p[2].y, vx = p[1].x - p[2].x, vy = p[1].y - p[2].y;
  if (wide && !(scale({&ux, &vx}) && scale({&uy, &vy}))) return true;
  const Sum sum = orientation_sum(ux, uy, vx, vy);
  const double bound = orientation_bound * sum.permanent + (wide ? wide_underflow : 0.0);
  return std::fabs(sum.det) <= bound && bound != 0.0;
}

std::array<double, 6> differences(const Four& p) {
  return {p[0].x - p[3].x, p[0].y - p[3].y, p[1].x - p[3].x, p[1].y - p[3].y, p[2].x - p[3].x, p[2].y - p[3].y};
}

bool incircle_is_exact(const Four& p, bool wide) {
  std::array<double, 6> d = differences(p);
  if (wide && !scale({&d[0], &d[1], &d[2], &d[3], &d[4], &d[5]})) return true;
  const Sum sum = incircle_sum(d);
  return std::fabs(sum.det) <= incircle_bound * sum.permanent + (wide ? wide_underflow : 0.0);
}

double bound_of_incircle(const Four& p) {
  const Sum sum = incircle_sum(differences(p));
  return (std::fabs(sum.det) + incircle_bound * sum.permanent) * (1 + 0x1p-40);
}

// ---- the truth -----------------------------------------------------------------------------------------------------

/// Exponents of the lowest bit and above the highest one of all coordinates; empty if all are zero.
struct Span {
  int low = 5000, high = -5000;
};
Span span_of(const Four& points) {
  Span s;
  for (const PlanePoint& p : points) {
    for (const double v : {p.x, p.y}) {
      if (v == 0) continue;
      int exponent = 0;
      double fraction = std::fabs(std::frexp(v, &exponent));
      s.high = std::max(s.high, exponent);
      while (fraction != 0) fraction = fraction * 2 - std::floor(fraction * 2), --exponent;
      s.low = std::min(s.low, exponent);
    }
  }
  return s;
}

Four scaled(Four points, int exponent) {
  for (PlanePoint& p : points) p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent)};
  return points;
}

bool distinct(const Four& p) {
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b)
      if (p[a].x == p[b].x && p[a].y == p[b].y) return false;
  return true;
}

SignCase case_of(const Four& p, bool wide, std::uint64_t signs, bool triangle) {
  SignCase result{p, wide ? std::numeric_limits<double>::infinity() : bound_of_incircle(p), signs};
  if (orientation_is_exact(p, wide)) result.word |= 1u << exact_orientation;
  if (triangle && incircle_is_exact(p, wide)) result.word |= 1u << exact_incircle;
  return result;
}

}  // namespace

void add_case(SignSet& set, Four p) {
  if (!distinct(p)) return;
  const Span span = span_of(p);
  // The lowest bit becomes that of the smallest double: short whole numbers.
  std::array<truth::Point, 4> q{};
  const auto update = [&] {
    const Four small = span.high < span.low ? p : scaled(p, -1074 - span.low);
    for (std::size_t i = 0; i < 4; ++i) q[i] = {small[i].x, small[i].y};
  };
  update();
  int turn = truth::orientation(q[0], q[1], q[2]);
  if (turn < 0) {
    std::swap(p[0], p[1]);
    update();
    turn = 1;
  }
  const int determinant = truth::incircle(q[0], q[1], q[2], q[3]);
  const int usual = turn > 0 ? truth::tie(q[0], q[1], q[2], q[3]) : 0;
  std::uint64_t signs = sign_bits(turn, orientation) | sign_bits(turn, oriented) | sign_bits(turn, oriented_long) |
                        sign_bits(determinant, inside) | sign_bits(determinant, inside_small) |
                        sign_bits(determinant, inside_long) | sign_bits(usual, tie);
  signs |= sign_bits(turn == 0 ? 0 : (determinant != 0 ? determinant : usual), incircle);
  if (turn > 0 && determinant == 0) signs |= 1u << tied;
  set.wide.push_back(case_of(p, true, signs, turn > 0));
  // As the driver does: below 1, and no bit below 2^-240.
  if (span.high >= span.low && span.high - span.low <= 240)
    set.narrow.push_back(case_of(scaled(p, -span.high), false, signs, turn > 0));
}

WrongSigns compare(const std::vector<SignCase>& cases, const std::vector<std::uint32_t>& words) {
  WrongSigns wrong;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::uint64_t bits = cases[i].word ^ words[i];
    if (bits == 0) continue;
    if (wrong.fields == 0) wrong.first = i;
    wrong.fields |= bits;
    (bits & 0xFFFFu ? wrong.signs : wrong.stages) += 1;
  }
  return wrong;
}

StageCounts stages_of(const std::vector<std::uint32_t>& words) {
  StageCounts counts;
  for (const std::uint32_t word : words) {
    (word >> exact_orientation & 1u ? counts.exact_orientations : counts.filtered_orientations) += 1;
    if ((word >> orientation & 3u) != 2u) continue;  // incircle is asked of triangles
    if (word >> tied & 1u)
      ++counts.ties;
    else
      (word >> exact_incircle & 1u ? counts.exact_incircles : counts.filtered_incircles) += 1;
  }
  return counts;
}

}  // namespace cadt::test
