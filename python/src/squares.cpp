// SPDX-License-Identifier: Apache-2.0
// Points in the order of square buckets (cadt.terrain).
#include "common.hpp"

#include <limits>

namespace cadt_python {

namespace {

using SortedPoints = nb::ndarray<double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using SortedValues = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Point = std::array<double, 2>;

/// nx columns and ny rows of squares from a lower left corner on.
struct Squares {
  double x0, y0, side;
  std::uint32_t nx, ny;
  /// That of the point's square, row by row; of the nearest one for points outside. As Squares.place in Python.
  [[nodiscard]] std::uint32_t number(Point p) const { return at(p[1], y0, ny) * nx + at(p[0], x0, nx); }

 private:
  [[nodiscard]] std::uint32_t at(double coordinate, double origin, std::uint32_t count) const {
    const double place = (coordinate - origin) / side;
    if (!(place > 0)) return 0;
    return place < static_cast<double>(count - 1) ? static_cast<std::uint32_t>(place) : count - 1;
  }
};

/// A counting sort, in place; those of one square stay in their order. Where each square's points begin, and the end.
std::vector<std::int32_t> sort_by_square(std::span<Point> points, std::span<double> values, const Squares& squares) {
  std::vector<std::int32_t> begin(std::size_t{squares.nx} * squares.ny + 1);
  std::vector<std::uint32_t> number(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    number[i] = squares.number(points[i]);
    ++begin[number[i] + 1];
  }
  for (std::size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
  const std::vector<Point> from(points.begin(), points.end());
  const std::vector<double> values_from(values.begin(), values.end());
  std::vector<std::int32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto to = static_cast<std::size_t>(next[number[i]]++);
    points[to] = from[i];
    values[to] = values_from[i];
  }
  return begin;
}

}  // namespace

void bind_squares(nb::module_& m) {
  m.def(
      "sort_by_square",
      [](SortedPoints xy, SortedValues z, double x0, double y0, double side, std::uint32_t nx, std::uint32_t ny) {
        const std::size_t n = xy.shape(0);
        constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
        if (z.shape(0) != n) throw nb::value_error("a value for each point is needed");
        if (nx == 0 || ny == 0 || std::size_t{nx} * ny >= most || n > most || !(side > 0))
          throw nb::value_error("fewer than 2^31 points and squares with a side above 0 are needed");
        static_assert(sizeof(Point) == 2 * sizeof(double));
        const std::span<Point> points(reinterpret_cast<Point*>(xy.data()), n);
        return array_of(without_gil([&] { return sort_by_square(points, {z.data(), n}, {x0, y0, side, nx, ny}); }));
      },
      nb::arg("xy").noconvert(), nb::arg("z").noconvert(), nb::arg("x0"), nb::arg("y0"), nb::arg("side"), nb::arg("nx"),
      nb::arg("ny"));
}

}  // namespace cadt_python
