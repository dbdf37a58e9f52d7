// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/predicates/cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "tests/unit/verify/truth.hpp"

namespace cadt::test {
namespace {

// Fields of the word, as in common/predicates/predicate_probe.dev.h. Not included from there: these files share no code
// with the predicates.
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

// `Real` is what the build computes with.
template <class Real>
struct Sum {
  Real det, permanent;
};

template <class Real>
Sum<Real> orientation_sum(Real ux, Real uy, Real vx, Real vy) {
  const Real left = ux * vy, right = uy * vx;
  return {left - right, std::fabs(left) + std::fabs(right)};
}

template <class Real>
Sum<Real> incircle_sum(const std::array<Real, 6>& d) {
  const Real bc = d[2] * d[5], cb = d[3] * d[4], ca = d[4] * d[1], ac = d[5] * d[0], ab = d[0] * d[3], ba = d[1] * d[2];
  const Real a = d[0] * d[0] + d[1] * d[1], b = d[2] * d[2] + d[3] * d[3], c = d[4] * d[4] + d[5] * d[5];
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
  const Sum<double> sum = orientation_sum(ux, uy, vx, vy);
  const double bound = orientation_bound * sum.permanent + (wide ? wide_underflow : 0.0);
  return std::fabs(sum.det) <= bound && bound != 0.0;
}

std::array<double, 6> differences(const Four& p) {
  return {p[0].x - p[3].x, p[0].y - p[3].y, p[1].x - p[3].x, p[1].y - p[3].y, p[2].x - p[3].x, p[2].y - p[3].y};
}

bool incircle_is_exact(const Four& p, bool wide) {
  std::array<double, 6> d = differences(p);
  if (wide && !scale({&d[0], &d[1], &d[2], &d[3], &d[4], &d[5]})) return true;
  const Sum<double> sum = incircle_sum(d);
  return std::fabs(sum.det) <= incircle_bound * sum.permanent + (wide ? wide_underflow : 0.0);
}

// Floats: u = 2^-24; differences are scaled to less than 4, and those below 2^-40 are left to integers. What a device
// makes of subnormal numbers is far below the allowance.
const float float_unit = 0x1p-24F, float_orientation_bound = (3 + 16 * float_unit) * float_unit,
            float_incircle_bound = (10 + 96 * float_unit) * float_unit, float_underflow = 0x1p-60F;

bool scale_floats(std::initializer_list<float*> values) {
  float largest = 0;
  for (const float* v : values) largest = std::max(largest, std::fabs(*v));
  if (!std::isfinite(largest) || largest < 0x1p-40F) return false;
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));
  for (float* v : values) *v = std::ldexp(*v, 2 - exponent);
  return true;
}

float minus(double a, double b) { return static_cast<float>(a) - static_cast<float>(b); }

bool float_orientation_is_exact(const Four& p) {
  float ux = minus(p[0].x, p[2].x), uy = minus(p[0].y, p[2].y), vx = minus(p[1].x, p[2].x), vy = minus(p[1].y, p[2].y);
  if (!(scale_floats({&ux, &vx}) && scale_floats({&uy, &vy}))) return true;
  const Sum<float> sum = orientation_sum(ux, uy, vx, vy);
  return std::fabs(sum.det) <= float_orientation_bound * sum.permanent + float_underflow;
}

bool float_incircle_is_exact(const Four& p) {
  std::array<float, 6> d = {minus(p[0].x, p[3].x), minus(p[0].y, p[3].y), minus(p[1].x, p[3].x),
                            minus(p[1].y, p[3].y), minus(p[2].x, p[3].x), minus(p[2].y, p[3].y)};
  if (!scale_floats({&d[0], &d[1], &d[2], &d[3], &d[4], &d[5]})) return true;
  const Sum<float> sum = incircle_sum(d);
  return std::fabs(sum.det) <= float_incircle_bound * sum.permanent + float_underflow;
}

double bound_of_incircle(const Four& p) {
  const Sum<double> sum = incircle_sum(differences(p));
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

/// What all builds must agree on.
struct Truth {
  std::uint64_t signs = 0;
  Span span;
  int turn = 0;
};

/// Of distinct points, of which two change places if the first three are clockwise.
Truth truth_of(Four& p) {
  Truth t;
  t.span = span_of(p);
  // The lowest bit becomes that of the smallest double: short whole numbers.
  std::array<truth::Point, 4> q{};
  const auto update = [&] {
    const Four small = t.span.high < t.span.low ? p : scaled(p, -1074 - t.span.low);
    for (std::size_t i = 0; i < 4; ++i) q[i] = {small[i].x, small[i].y};
  };
  update();
  t.turn = truth::orientation(q[0], q[1], q[2]);
  if (t.turn < 0) {
    std::swap(p[0], p[1]);
    update();
    t.turn = 1;
  }
  const int turn = t.turn, determinant = truth::incircle(q[0], q[1], q[2], q[3]);
  const int usual = turn > 0 ? truth::tie(q[0], q[1], q[2], q[3]) : 0;
  t.signs = sign_bits(turn, orientation) | sign_bits(turn, oriented) | sign_bits(turn, oriented_long) |
            sign_bits(determinant, inside) | sign_bits(determinant, inside_small) |
            sign_bits(determinant, inside_long) | sign_bits(usual, tie);
  t.signs |= sign_bits(turn == 0 ? 0 : (determinant != 0 ? determinant : usual), incircle);
  if (turn > 0 && determinant == 0) t.signs |= 1u << tied;
  return t;
}

}  // namespace

std::string text(const SignCase& c) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const PlanePoint& p : c.points) out << p.x << ' ' << p.y << "  ";
  out << "expected " << std::hex << c.word;
  return out.str();
}

void add_case(SignSet& set, Four p) {
  if (!distinct(p)) return;
  const auto [signs, span, turn] = truth_of(p);
  set.wide.push_back(case_of(p, true, signs, turn > 0));
  // As the driver does: below 1, and no bit below 2^-240.
  if (span.high >= span.low && span.high - span.low <= 240)
    set.narrow.push_back(case_of(scaled(p, -span.high), false, signs, turn > 0));
}

void add_float_case(SignSet& set, Four p) {
  for (const PlanePoint& q : p)
    if (!std::isfinite(q.x) || !std::isfinite(q.y)) return;
  if (!distinct(p)) return;
  const Truth t = truth_of(p);
  SignCase result{p, std::numeric_limits<double>::infinity(), t.signs};
  if (float_orientation_is_exact(p)) result.word |= 1u << exact_orientation;
  if (t.turn > 0 && float_incircle_is_exact(p)) result.word |= 1u << exact_incircle;
  set.floats.push_back(result);
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
