// SPDX-License-Identifier: Apache-2.0
// Qhull's numbers of a triangulation, for cadt.scipy: paraboloid, planes, barycentric transforms.
#include "common.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadt_python {

namespace {

struct Vector {
  double x, y;
};
Vector at(const double* points, std::int32_t p) {
  const double* xy = points + 2 * static_cast<std::ptrdiff_t>(p);
  return {xy[0], xy[1]};
}
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y}; }
double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
Vector scalbn(Vector a, int exponent) {
  return exponent == 0 ? a : Vector{std::scalbn(a.x, exponent), std::scalbn(a.y, exponent)};
}

/// A number as the sum of two doubles.
struct Pair {
  double high, low = 0;
};
/// Without an error (Knuth's two-sum).
Pair difference(double a, double b) {
  const double high = a - b, of_b = a - high, of_a = high + of_b;
  return {high, (a - of_a) + (of_b - b)};
}
/// With a relative error of some 2^-105.
Pair product(Pair a, Pair b) {
  const double high = a.high * b.high;
  return {high, std::fma(a.high, b.high, -high) + (a.high * b.low + a.low * b.high)};
}

struct PairVector {
  Pair x, y;
};
/// a - b without an error.
PairVector difference(Vector a, Vector b) { return {difference(a.x, b.x), difference(a.y, b.y)}; }
Vector rounded(const PairVector& a) { return {a.x.high, a.y.high}; }

/// u x v. Its error is some 2^-105 |u| |v|: that of a determinant that is not nearly zero is the last rounding's.
double cross(const PairVector& u, const PairVector& v) {
  const Pair p = product(u.x, v.y), q = product(u.y, v.x);
  const Pair d = difference(p.high, q.high);
  return d.high + (d.low + (p.low - q.low));
}

/// By what power of two to scale coordinates of which this is the largest, so that products of them neither overflow
/// nor lose digits: 0 for most.
int extreme_exponent(double largest) {
  return largest > 0x1p250 || (largest < 0x1p-250 && largest > 0) ? std::ilogb(largest) : 0;
}

/// Scale and shift of Qhull's paraboloid. `scaled` (Qbb): its heights span as much as the largest coordinate;
/// `at_infinity` (Qz): Qhull's point at infinity is 1.1 times as high as the highest.
std::pair<double, double> paraboloid(const Coordinates& points, bool scaled, bool at_infinity) {
  if (!scaled || points.shape(0) == 0) return {1, 0};
  double low = std::numeric_limits<double>::infinity(), high = 0, largest = 0;
  for (const double* x = points.data(); x != points.data() + points.size(); ++x)
    largest = std::max(largest, std::abs(*x));
  const int exponent = extreme_exponent(largest);
  for (const double* p = points.data(); p != points.data() + points.size(); p += 2) {
    const Vector x = scalbn({p[0], p[1]}, -exponent);
    const double height = dot(x, x);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  if (at_infinity) high *= 1.1;
  if (!(high > low)) return {1, 0};
  const double scale = std::scalbn(largest, -exponent) / (high - low), shift = -low * scale;
  const std::pair<double, double> result(std::scalbn(scale, -exponent), std::scalbn(shift, exponent));
  if (!std::isfinite(result.first)) return {1, 0};  // of the smallest coordinates
  return result;
}

/// Unit normal, away from the paraboloid's inside, and offset of the plane of a lifted triangle.
void equation(Vector a, Vector b, Vector c, double scale, double shift, double* out) {
  // The paraboloid of scaled coordinates that is scaled as they are has planes of the same normals.
  const int exponent = extreme_exponent(
      std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y), std::abs(c.x), std::abs(c.y)}));
  for (Vector* p : {&a, &b, &c}) *p = scalbn(*p, -exponent);
  const PairVector ab = difference(b, a), ac = difference(c, a);
  const Vector u = rounded(ab), v = rounded(ac);
  // `scale` becomes 2^exponent times as large. One half of that is for nx and ny, the other, as its inverse, for nz.
  const int half = exponent / 2;
  const double steepness = std::scalbn(scale, exponent - half);
  // Differences of heights as products of differences and sums, which lose less than differences of squares.
  const double up_b = steepness * dot(u, a + b), up_c = steepness * dot(v, a + c);
  const double nx = up_b * v.y - u.y * up_c, ny = u.x * up_c - up_b * v.x, nz = std::scalbn(-cross(ab, ac), -half);
  const double length = std::hypot(nx, ny, nz);
  out[0] = nx / length;
  out[1] = ny / length;
  out[2] = nz / length;
  const double height = std::scalbn(scale, exponent) * dot(a, a) + std::scalbn(shift, -exponent);
  out[3] = -std::scalbn(out[0] * a.x + out[1] * a.y + out[2] * height, exponent);
}

/// The inverse of T = [a - c, b - c] by rows, and c; all NaN where T's reciprocal condition number (1-norm) is below
/// 1000 eps, as in SciPy, whose search then goes by the neighbours and so finds what rounding has put beside a
/// triangle, and where the inverse overflows.
void transform(Vector a, Vector b, Vector c, double* out) {
  PairVector u = difference(a, c), v = difference(b, c);
  const double largest = std::max({std::abs(u.x.high), std::abs(u.y.high), std::abs(v.x.high), std::abs(v.y.high)});
  int exponent = 0;
  if (largest > 0x1p400 || largest < 0x1p-400) {  // products would overflow or lose digits
    exponent = std::ilogb(largest);
    for (Pair* p : {&u.x, &u.y, &v.x, &v.y}) *p = {std::scalbn(p->high, -exponent), std::scalbn(p->low, -exponent)};
  }
  const double determinant = cross(u, v);
  const double inverse[4] = {v.y.high / determinant, -v.x.high / determinant, -u.y.high / determinant,
                             u.x.high / determinant};
  const double norm = std::max(std::abs(u.x.high) + std::abs(u.y.high), std::abs(v.x.high) + std::abs(v.y.high));
  const double norm_of_inverse =
      std::max(std::abs(inverse[0]) + std::abs(inverse[2]), std::abs(inverse[1]) + std::abs(inverse[3]));
  for (int k = 0; k < 4; ++k) out[k] = exponent == 0 ? inverse[k] : std::scalbn(inverse[k], -exponent);
  out[4] = c.x;
  out[5] = c.y;
  const bool good = 1 / (norm * norm_of_inverse) >= 1000 * std::numeric_limits<double>::epsilon();
  if (!good || !std::all_of(out, out + 4, [](double x) { return std::isfinite(x); }))
    std::fill_n(out, 6, std::numeric_limits<double>::quiet_NaN());
}

/// `row(a, b, c, out)` of each triangle, `width` numbers.
template <class Row>
std::vector<double> rows(const Coordinates& points, const cadt::Triangulation& mesh, std::size_t width, Row&& row) {
  if (points.shape(0) != mesh.number_of_points()) throw nb::value_error("the points are not those of the mesh");
  const ReleasedGil released;
  const auto triangles = mesh.triangles();
  std::vector<double> result(width * (triangles.size() / 3));
  double* out = result.data();
  for (const std::int32_t* t = triangles.data(); t != triangles.data() + triangles.size(); t += 3, out += width)
    row(at(points.data(), t[0]), at(points.data(), t[1]), at(points.data(), t[2]), out);
  return result;
}

}  // namespace

void bind_scipy(nb::module_& m) {
  m.def("paraboloid", &paraboloid, nb::arg("points"), nb::arg("scaled"), nb::arg("at_infinity"));
  m.def(
      "equations",
      [](const Coordinates& points, const cadt::Triangulation& mesh, double scale, double shift) {
        return array_of(rows(points, mesh, 4,
                             [=](Vector a, Vector b, Vector c, double* out) { equation(a, b, c, scale, shift, out); }),
                        4);
      },
      nb::arg("points"), nb::arg("mesh"), nb::arg("scale"), nb::arg("shift"));
  m.def(
      "transforms",
      [](const Coordinates& points, const cadt::Triangulation& mesh) {
        return array_of_shape<double>({mesh.number_of_triangles(), 3, 2}, rows(points, mesh, 6, transform));
      },
      nb::arg("points"), nb::arg("mesh"));
}

}  // namespace cadt_python
