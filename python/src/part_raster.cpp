// SPDX-License-Identifier: Apache-2.0
// Some triangles of a larger mesh, such as the final ones of a tile, on the cells of a grid (cadt.terrain).
#include "common.hpp"

#include <nanobind/stl/array.h>

#include <algorithm>
#include <cmath>

namespace cadt_python {

namespace {

using Corners = std::array<double, 4>;  // x0, y0, dx, dy of a cadt::Grid
using Vertices = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Heights = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Point = std::array<double, 2>;

/// Cells on edges that have triangles of the part on one side alone.
struct Rim {
  std::vector<std::int64_t> cells;      // of the grid, row by row
  std::vector<std::int32_t> triangles;  // the lowest of the part at the cell's centre
  std::vector<std::int32_t> edges;      // n x 2 points: the ends of the edge, or twice the vertex at the centre
};

/// Cell i of an axis has its centre at origin + (first + i + 0.5) step, as in the library's rasters.
struct Axis {
  double origin, step;
  std::int64_t count;
  double first = 0;
  [[nodiscard]] double center(std::int64_t i) const { return origin + (static_cast<double>(i) + first + 0.5) * step; }
  [[nodiscard]] std::int64_t cell(double x) const {
    const double at = (x - origin) / step - first;
    if (!(at > -2)) return -2;  // or not a number
    return at < static_cast<double>(count) + 2 ? static_cast<std::int64_t>(std::floor(at)) : count + 2;
  }
  /// The first and one past the last of the cells whose centres may lie between two places: one more on each side, so
  /// that rounding is harmless.
  [[nodiscard]] std::array<std::int64_t, 2> between(double a, double b) const {
    const std::int64_t i = cell(a), j = cell(b);
    return {std::clamp<std::int64_t>(std::min(i, j) - 1, 0, count),
            std::clamp<std::int64_t>(std::max(i, j) + 2, 0, count)};
  }
};

class PartRaster {
 public:
  PartRaster(const Vertices& points, const Indices& triangles, const Indices& neighbors, const cadt::Options& options)
      : points_(points), triangles_(triangles), options_(options) {
    if (neighbors.shape(0) != triangles.shape(0)) throw nb::value_error("three neighbours a triangle are needed");
    const ReleasedGil released;
    across_.assign(neighbors.data(), neighbors.data() + neighbors.size());
    for (std::int32_t& n : across_) n = std::max(n, -1);  // triangles of other parts are not there
    lowest_.assign(points_.shape(0), -1);
    const std::int32_t* corner = triangles_.data();
    for (std::size_t i = triangles_.size(); i-- > 0;)
      if (corner[i] >= 0 && static_cast<std::size_t>(corner[i]) < lowest_.size())
        lowest_[static_cast<std::size_t>(corner[i])] = static_cast<std::int32_t>(i / 3);
    for (std::size_t side = 0; side < across_.size(); ++side)
      if (across_[side] < 0) open_sides_.push_back(side);
    // It looks at all indices.
    queries_ = std::make_unique<cadt::MeshQueries>(
        cadt::PointsView(std::span(points_.data(), points_.size())),
        cadt::MeshView{{triangles_.data(), triangles_.size()}, across_, {}, {}}, options_);
  }

  NumpyArray<double> rasterize(const Corners& grid, std::size_t columns, std::size_t rows, const Heights& values,
                               double max_edge, std::size_t first_column, std::size_t first_row) {
    const cadt::Grid cells{grid[0], grid[1], grid[2], grid[3], columns, rows, first_column, first_row};
    const nb::object none = nb::none();
    return array_of(
        Call(none)(
            queries_->options(),
            [&] {
              return queries_->rasterize(cells, {values.data(), values.size()}, cadt::Interpolation::linear, max_edge);
            }),
        columns);
  }

  /// Which blocks of `side` x `side` cells the boxes of triangles meet: 1 or 0, row by row.
  NumpyArray<std::uint8_t> blocks(const Corners& grid, std::size_t columns, std::size_t rows, std::int64_t side) const {
    const Axis x{grid[0], grid[2], static_cast<std::int64_t>(columns)};
    const Axis y{grid[1], grid[3], static_cast<std::int64_t>(rows)};
    const std::int64_t nx = (x.count + side - 1) / side, ny = (y.count + side - 1) / side;
    std::vector<std::int64_t> begun(static_cast<std::size_t>((nx + 1) * (ny + 1)));  // minus those that have ended
    const auto at = [&](std::int64_t i, std::int64_t j) -> std::int64_t& {
      return begun[static_cast<std::size_t>(j * (nx + 1) + i)];
    };
    std::vector<std::uint8_t> met;
    without_gil([&] {
      for (std::size_t t = 0; t < triangles_.shape(0); ++t) {
        const Point a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
        const auto [i0, i1] = x.between(std::min({a[0], b[0], c[0]}), std::max({a[0], b[0], c[0]}));
        const auto [j0, j1] = y.between(std::min({a[1], b[1], c[1]}), std::max({a[1], b[1], c[1]}));
        if (i0 >= i1 || j0 >= j1) continue;
        const std::int64_t left = i0 / side, right = (i1 - 1) / side + 1, low = j0 / side, high = (j1 - 1) / side + 1;
        ++at(left, low), --at(right, low), --at(left, high), ++at(right, high);
      }
      for (std::int64_t j = 0; j < ny; ++j) {
        for (std::int64_t i = 0; i < nx; ++i) {
          at(i, j) += (i > 0 ? at(i - 1, j) : 0) + (j > 0 ? at(i, j - 1) : 0) - (i > 0 && j > 0 ? at(i - 1, j - 1) : 0);
          met.push_back(at(i, j) > 0 ? 1 : 0);
        }
      }
    });
    return array_of(std::move(met), static_cast<std::size_t>(nx));
  }

  /// The cells whose centres lie on the rim of the part, where other parts may have triangles, too. Exact.
  nb::tuple rim(const Corners& grid, std::size_t columns, std::size_t rows, std::size_t first_column,
                std::size_t first_row) const {
    const Axis x{grid[0], grid[2], static_cast<std::int64_t>(columns), static_cast<double>(first_column)};
    const Axis y{grid[1], grid[3], static_cast<std::int64_t>(rows), static_cast<double>(first_row)};
    Rim found;
    {
      const ReleasedGil released;
      for (const std::size_t side : open_sides_) add_cells(x, y, side, found);
    }
    return nb::make_tuple(array_of(std::move(found.cells)), array_of(std::move(found.triangles)),
                          array_of(std::move(found.edges), 2));
  }

 private:
  [[nodiscard]] std::int32_t vertex(std::size_t t, std::size_t k) const { return triangles_.data()[3 * t + k % 3]; }
  [[nodiscard]] Point corner(std::size_t t, std::size_t k) const {
    const double* p = points_.data() + 2 * static_cast<std::size_t>(vertex(t, k));
    return {p[0], p[1]};
  }

  void add_cells(const Axis& x, const Axis& y, std::size_t side, Rim& found) const {
    const std::size_t t = side / 3, k = side % 3;
    const Point a = corner(t, k + 1), b = corner(t, k + 2);
    const auto [i0, i1] = x.between(a[0], b[0]);
    const auto [j0, j1] = y.between(a[1], b[1]);
    // Along the axis with more cells (of the edge, not of its part in this grid); across it the nearest ones.
    if (std::abs((b[0] - a[0]) / x.step) > std::abs((b[1] - a[1]) / y.step)) {
      for (std::int64_t i = i0; i < i1; ++i) {
        const double at = a[1] + (b[1] - a[1]) * ((x.center(i) - a[0]) / (b[0] - a[0]));
        for (std::int64_t j = std::max(j0, y.cell(at) - 1); j < std::min(j1, y.cell(at) + 2); ++j)
          add_cell(x, y, i, j, t, k, found);
      }
    } else {
      for (std::int64_t j = j0; j < j1; ++j) {
        const double at = a[0] + (b[0] - a[0]) * ((y.center(j) - a[1]) / (b[1] - a[1]));
        for (std::int64_t i = std::max(i0, x.cell(at) - 1); i < std::min(i1, x.cell(at) + 2); ++i)
          add_cell(x, y, i, j, t, k, found);
      }
    }
  }

  void add_cell(const Axis& x, const Axis& y, std::int64_t i, std::int64_t j, std::size_t t, std::size_t k,
                Rim& found) const {
    const Point a = corner(t, k + 1), b = corner(t, k + 2), p = {x.center(i), y.center(j)};
    for (const std::size_t axis : {0U, 1U})
      if (p[axis] < std::min(a[axis], b[axis]) || p[axis] > std::max(a[axis], b[axis])) return;
    if (cadt::exact_orientation(a, b, p) != 0) return;
    const std::int32_t from = vertex(t, k + 1), to = vertex(t, k + 2);
    const std::int32_t first = p == b ? to : from, second = p == a ? from : to;
    found.cells.push_back(j * x.count + i);
    found.triangles.push_back(first == second ? lowest_[static_cast<std::size_t>(first)]
                                              : static_cast<std::int32_t>(t));
    found.edges.insert(found.edges.end(), {first, second});
  }

  Vertices points_;
  Indices triangles_;
  std::vector<std::int32_t> across_, lowest_;
  std::vector<std::size_t> open_sides_;  // 3 t + k: edge k of triangle t has nothing across
  cadt::Options options_;
  std::unique_ptr<cadt::MeshQueries> queries_;
};

}  // namespace

void bind_part_raster(nb::module_& m) {
  nb::class_<PartRaster>(m, "PartRaster")
      .def(nb::init<const Vertices&, const Indices&, const Indices&, const cadt::Options&>(), nb::arg("points"),
           nb::arg("triangles"), nb::arg("neighbors"), nb::arg("options"))
      .def("rasterize", &PartRaster::rasterize, nb::arg("grid"), nb::arg("columns"), nb::arg("rows"), nb::arg("values"),
           nb::arg("max_edge"), nb::arg("first_column") = 0, nb::arg("first_row") = 0)
      .def("blocks", &PartRaster::blocks, nb::arg("grid"), nb::arg("columns"), nb::arg("rows"), nb::arg("side"))
      .def("rim", &PartRaster::rim, nb::arg("grid"), nb::arg("columns"), nb::arg("rows"), nb::arg("first_column") = 0,
           nb::arg("first_row") = 0);
}

}  // namespace cadt_python
