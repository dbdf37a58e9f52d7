// SPDX-License-Identifier: Apache-2.0
// The signs of the predicates in whole numbers, straight from their determinants: those of GMP, or where it is not
// installed (CADT_TEST_GMP is 0) those of whole.hpp.
#pragma once

#include "common/verify/host/exact_sign.hpp"

#if CADT_TEST_GMP
#include <gmpxx.h>
#else
#include "tests/unit/verify/whole.hpp"
#endif

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace truth {

using cadt::verifier::Point;
#if CADT_TEST_GMP
using Integer = mpz_class;
#else
using Integer = Whole;
#endif

/// Every finite double is an integer times 2^-1074.
inline Integer integer(double v) {
  int exponent = 0;
  const double fraction = std::frexp(v, &exponent);
  Integer m(std::ldexp(fraction, 53));
  const int shift = exponent - 53 + 1074;
  if (shift >= 0) return m << static_cast<unsigned long>(shift);
  return m >> static_cast<unsigned long>(-shift);  // a subnormal: the bits that go are zero
}

struct Vector {
  Integer x, y;
  explicit Vector(const Point& p) : x(integer(p.x)), y(integer(p.y)) {}
};

inline int orientation(const Point& pa, const Point& pb, const Point& pc) {
  const Vector a(pa), b(pb), c(pc);
  return sgn(Integer(a.x * b.y - a.y * b.x + b.x * c.y - b.y * c.x + c.x * a.y - c.y * a.x));
}

/// Cofactor of the lifted coordinate of row i in the 4 x 4 determinant with rows (x, y, x^2 + y^2, 1).
inline int cofactor(const std::array<Point, 4>& p, std::size_t i) {
  std::array<Point, 3> rest{};
  for (std::size_t j = 0, k = 0; j < 4; ++j)
    if (j != i) rest[k++] = p[j];
  return (i % 2 == 0 ? 1 : -1) * truth::orientation(rest[0], rest[1], rest[2]);
}

inline int incircle(const Point& pa, const Point& pb, const Point& pc, const Point& pd) {
  const std::array<Vector, 4> v{Vector(pa), Vector(pb), Vector(pc), Vector(pd)};
  Integer det = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<const Vector*, 3> r{};
    for (std::size_t j = 0, k = 0; j < 4; ++j)
      if (j != i) r[k++] = &v[j];
    const Integer area = r[0]->x * r[1]->y - r[0]->y * r[1]->x + r[1]->x * r[2]->y - r[1]->y * r[2]->x +
                         r[2]->x * r[0]->y - r[2]->y * r[0]->x;
    const Integer lift = v[i].x * v[i].x + v[i].y * v[i].y;
    if (i % 2 == 0) {
      det += lift * area;
    } else {
      det -= lift * area;
    }
  }
  return sgn(det);
}

/// As if all four were on a circle: the lifted coordinate of each point is raised by e^(number of points above it in
/// lexicographic order + 1), e infinitely small; the first cofactor that does not vanish, from the greatest point on.
inline int tie(const Point& a, const Point& b, const Point& c, const Point& d) {
  const std::array<Point, 4> p{a, b, c, d};
  std::array<bool, 4> done{};
  for (int round = 0; round < 4; ++round) {
    std::size_t greatest = 4;
    for (std::size_t i = 0; i < 4; ++i)
      if (!done[i] && (greatest == 4 || p[i].x > p[greatest].x || (p[i].x == p[greatest].x && p[i].y > p[greatest].y)))
        greatest = i;
    done[greatest] = true;
    if (const int s = cofactor(p, greatest); s != 0) return s;
  }
  return 0;
}

/// The sign of the perturbed determinant.
inline int incircle_perturbed(const Point& a, const Point& b, const Point& c, const Point& d) {
  const int s = truth::incircle(a, b, c, d);
  return s != 0 ? s : truth::tie(a, b, c, d);
}

/// Folder with the regression inputs; empty if it is not there.
inline std::filesystem::path hard_data() {
  const char* set = std::getenv("CADT_DATA_DIR");
  const std::filesystem::path path = std::filesystem::path(set != nullptr ? set : CADT_TEST_DATA_DEFAULT) / "hard";
  return std::filesystem::is_directory(path) ? path : std::filesystem::path();
}

}  // namespace truth
