// SPDX-License-Identifier: Apache-2.0
// A mesh that is asked: where points lie, what is near, heights between the points, a raster, Voronoi cells.
//
// usage: example-queries [points [back end]]      e.g. example-queries 1000000 opencl
#include <cadt/cadt.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <random>
#include <vector>

namespace {

double hills(double x, double y) { return std::sin(6 * x) * std::cos(5 * y); }

}  // namespace

int main(int count, char** values) {
  try {
    const std::size_t n = count > 1 ? std::strtoul(values[1], nullptr, 10) : 100'000;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> coordinate(0.0, 1.0);
    std::vector<double> xy, height;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = coordinate(random), y = coordinate(random);
      xy.insert(xy.end(), {x, y});
      height.push_back(hills(x, y));
    }

    cadt::Options options;
    if (count > 2) options.backend = cadt::backend_from_string(values[2]);
    const cadt::Triangulation mesh = cadt::triangulate(xy, options);
    cadt::MeshQueries queries(xy, mesh, options);  // points and mesh must outlive it

    const std::vector<double> where{0.5, 0.5, 0.25, 0.75, 7.0, 7.0};  // three queries, the last one outside
    const std::vector<std::int32_t> triangles = queries.locate(where);
    const std::vector<std::int32_t> nearest = queries.nearest_vertex(where);
    const std::vector<double> smooth = queries.interpolate(height, where, cadt::Interpolation::natural);
    for (std::size_t q = 0; q < triangles.size(); ++q) {
      std::cout << '(' << where[2 * q] << ", " << where[2 * q + 1] << ")  triangle " << triangles[q]
                << ", nearest vertex " << nearest[q] << ", height " << smooth[q] << '\n';
    }

    cadt::Grid grid;  // 200 x 100 cells of the unit square, the top row first
    grid.columns = 200, grid.rows = 100;
    grid.x0 = 0, grid.y0 = 1;
    grid.dx = 1.0 / 200, grid.dy = -1.0 / 100;
    const std::vector<double> raster = queries.rasterize(grid, height);
    double worst = 0;  // of the cells within the hull; the others are NaN
    for (std::size_t c = 0; c < raster.size(); ++c) {
      const double x = grid.x0 + (static_cast<double>(c % grid.columns) + 0.5) * grid.dx;
      const double y = grid.y0 + (static_cast<double>(c / grid.columns) + 0.5) * grid.dy;
      if (!std::isnan(raster[c])) worst = std::max(worst, std::abs(raster[c] - hills(x, y)));
    }
    std::cout << "raster      at most " << worst << " from the true heights\n";

    const cadt::VoronoiPolygons cells = queries.voronoi_polygons({0, 0, 1, 1});
    double area = 0;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t i = cells.begin[p]; i < cells.begin[p + 1]; ++i) {
        const std::size_t next = i + 1 < cells.begin[p + 1] ? i + 1 : cells.begin[p];
        area += (cells.xy[2 * i] * cells.xy[2 * next + 1] - cells.xy[2 * next] * cells.xy[2 * i + 1]) / 2;
      }
    }
    std::cout << "cells       area " << area << " in all\n";

    const cadt::Circle hole = queries.largest_empty_circles(1).at(0);
    std::cout << "hole        radius " << hole.radius << " at (" << hole.x << ", " << hole.y << ")\n";
    return triangles[2] == -1 && worst < 0.5 && std::abs(area - 1) < 1e-9 ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << "example-queries: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
