// SPDX-License-Identifier: Apache-2.0
// Circles, lines and curves: cocircular and collinear points, and the cases that flip most.
#include "tests/support/families.hpp"
#include "tests/support/same_math.hpp"

#include <cmath>
#include <numbers>

namespace cadt::test {
namespace {

// All whole points at distance r from the origin.
Points lattice_circle(int r, double factor = 1.0) {
  Points xy;
  for (int x = -r; x <= r; ++x) {
    const double y2 = double(r) * r - double(x) * x, y = std::sqrt(y2);
    if (y != std::floor(y)) continue;
    xy.insert(xy.end(), {factor * x, factor * y});
    if (y > 0) xy.insert(xy.end(), {factor * x, -factor * y});
  }
  return xy;
}

Points concentric(int circles) {
  Points xy = {0.0, 0.0};
  for (int k = 1; k <= circles; ++k) {
    const Points circle = lattice_circle(325, k);
    xy.insert(xy.end(), circle.begin(), circle.end());
  }
  return xy;
}

// Small circles around the points of a grid, every point moved by up to `epsilon`.
Points circles_on_grid(int cells, int k, double radius, double epsilon) {
  Random random(44);
  Points xy;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      Points circle = regular_polygon(k, i, j, radius);
      for (double& value : circle) value += epsilon * random.uniform(-1.0, 1.0);
      xy.insert(xy.end(), circle.begin(), circle.end());
    }
  }
  return xy;
}

Points ring(double radius, double width, std::size_t n) {
  Random random(45);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = radius + width * random.uniform(), angle = 2.0 * std::numbers::pi * random.uniform();
    xy.insert(xy.end(), {0.5 + r * same_cos(angle), 0.5 + r * same_sin(angle)});
  }
  return xy;
}

Points rectangles(std::size_t n) {
  Random random(47);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double x0 = random.uniform(), y0 = random.uniform(), x1 = 1 + random.uniform(), y1 = 1 + random.uniform();
    xy.insert(xy.end(), {x0, y0, x1, y0, x1, y1, x0, y1});
  }
  return xy;
}

Points eightfold(std::size_t n) {
  Random random(46);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double a = random.uniform(), b = random.uniform();
    for (const double u : {a, -a}) {
      for (const double v : {b, -b}) xy.insert(xy.end(), {u, v, v, u});
    }
  }
  return xy;
}

Points with(Points xy, std::initializer_list<double> more) {
  xy.insert(xy.end(), more);
  return xy;
}

Points line(int n, double dx, double dy) {
  Points xy;
  for (int i = 0; i < n; ++i) xy.insert(xy.end(), {dx * i, dy * i});
  return xy;
}

Points diagonals(int arm) {
  Points xy = {0.0, 0.0};
  for (int i = 1; i <= arm; ++i) {
    const double d = i;
    xy.insert(xy.end(), {d, d, -d, d, d, -d, -d, -d});
  }
  return xy;
}

Points two_oblique_lines(std::size_t n) {
  Random random(25);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const bool first = random.below(2) == 0;
    const double t = random.uniform();
    if (first) {
      xy.insert(xy.end(), {0.3 * t, 0.5 * t});
    } else {
      xy.insert(xy.end(), {0.7 + (1.0 - 0.7) * t, 0.5 + 0.5 * t});
    }
  }
  return xy;
}

Points parabola(int n) {
  Points xy;
  for (int i = 0; i < n; ++i) xy.insert(xy.end(), {double(i), double(i) * i});
  return xy;
}

Points reversed(const Points& xy) {
  Points result;
  for (std::size_t i = xy.size(); i > 0; i -= 2) result.insert(result.end(), {xy[i - 2], xy[i - 1]});
  return result;
}

Points spiral(int n, double growth, double turn, double start) {
  Points xy;
  for (int i = 0; i < n; ++i) {
    const double r = same_exp(growth * i + start);
    xy.insert(xy.end(), {r * same_cos(turn * i), r * same_sin(turn * i)});
  }
  return xy;
}

// Every insertion makes the hull grow.
Points golden_spiral(int n) {
  Points xy;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.399963229728653 * i;
    xy.insert(xy.end(), {(1.0 + i) * same_cos(angle), (1.0 + i) * same_sin(angle)});
  }
  return xy;
}

Points on_a_square(int per_side) {
  Points xy;
  for (int i = 0; i < per_side; ++i) {
    const double t = double(i) / per_side;
    xy.insert(xy.end(), {t, 0.0, 1.0, t, 1.0 - t, 1.0, 0.0, 1.0 - t});
  }
  return xy;
}

}  // namespace

std::vector<Family> circle_families() {
  std::vector<Family> result;
  for (int n = 3; n <= 33; ++n) {
    result.push_back({"polygon_" + std::to_string(n), [n] { return regular_polygon(n, 0, 0, 1); }});
  }
  result.insert(result.end(), {
                                  {"polygon_17_off_centre", [] { return regular_polygon(17, 1, 1, 3); }},
                                  {"polygon_1000", [] { return regular_polygon(1000, 0, 0, 1); }},
                                  {"polygon_1000_shuffled", [] { return shuffled(regular_polygon(1000, 0, 0, 1), 4); }},
                                  {"lattice_circle_324", [] { return lattice_circle(32045); }},
                                  {"lattice_circle_324_shuffled", [] { return shuffled(lattice_circle(32045), 9); }},
                                  {"lattice_circle_and_centre",
                                   [] {
                                     return with(lattice_circle(32045), {0, 0});
                                   }},
                                  {"concentric", [] { return concentric(16); }},
                                  {"circles_exact", [] { return circles_on_grid(11, 8, 0.25, 0.0); }},
                                  {"circles_1e-16", [] { return circles_on_grid(11, 8, 0.25, 1e-16); }},
                                  {"circles_1e-12", [] { return circles_on_grid(11, 8, 0.25, 1e-12); }},
                                  {"circles_1e-4", [] { return circles_on_grid(11, 8, 0.25, 1e-4); }},
                                  {"circles_touching", [] { return circles_on_grid(11, 8, 0.5, 0.0); }},
                                  {"circles_12", [] { return circles_on_grid(9, 12, 0.35, 0.0); }},
                                  {"ring", [] { return ring(0.45, 1e-3, 1000); }},
                                  {"ring_1e-15", [] { return ring(0.45, 1e-15, 1000); }},
                                  {"hub", [] { return hub_points(999); }},
                                  {"rectangles", [] { return rectangles(250); }},
                                  {"eightfold", [] { return eightfold(125); }},
                                  {"sides_of_a_square", [] { return on_a_square(250); }},
                              });
  return result;
}

std::vector<Family> line_families() {
  return {
      {"horizontal", [] { return line(1000, 1, 0); }},
      {"vertical", [] { return line(1000, 0, 1); }},
      {"diagonal", [] { return line(1000, 1, 1); }},
      {"diagonal_shuffled", [] { return shuffled(line(1000, 1, 1), 2); }},
      {"slope_2/3", [] { return line(1000, 3, 2); }},
      {"slope_2/3_subnormal", [] { return scaled(line(100, 3, 2), -1074); }},
      {"slope_2/3_huge", [] { return scaled(line(100, 3, 2), 1010); }},
      {"almost_a_line", [] { return line(1000, 0.1, 0.3); }},
      {"almost_a_line_shuffled", [] { return shuffled(line(1000, 0.1, 0.3), 8); }},
      {"last_point_off",
       [] {
         return with(line(999, 1, 0), {500, 1});
       }},
      {"first_point_off",
       [] {
         return reversed(with(line(999, 1, 0), {500, 1}));
       }},
      {"one_point_off_by_the_smallest",
       [] {
         return with(line(300, 1, 0), {150.5, 5e-324});
       }},
      {"points_on_both_sides",
       [] {
         return with(line(300, 1, 0), {150.5, 1, 150.5, -1});
       }},
      {"beyond_the_end",
       [] {
         return with(line(300, 1, 0), {400, 1});
       }},
      {"parallel_lines", [] { return grid_points(500, 2); }},
      {"crossing_diagonals", [] { return diagonals(150); }},
      {"two_oblique_lines", [] { return two_oblique_lines(1000); }},
      {"unsorted_with_repeat",
       [] { return Points{0, 10, 0, 2, 0, 4, 0, 4, 0, 1, 0, 0, 0, 3, 0, 6, 0, 8, 0, 5, 0, 7, 0, 9}; }},
  };
}

std::vector<Family> curve_families() {
  return {
      {"parabola", [] { return parabola(1000); }},
      {"parabola_reversed", [] { return reversed(parabola(1000)); }},
      {"parabola_shuffled", [] { return shuffled(parabola(1000), 6); }},
      {"parabola_and_far_apex",
       [] {
         return with(parabola(999), {1e6, -1e6});
       }},
      {"axis_cross", [] { return axis_cross(120); }},
      {"axis_cross_outside_in", [] { return reversed(axis_cross(120)); }},
      {"axis_cross_shuffled", [] { return shuffled(axis_cross(250), 13); }},
      {"log_spiral", [] { return spiral(1000, 0.05, 0.7, -25.0); }},
      {"slow_spiral", [] { return spiral(1000, 0.001, 0.05, 0.0); }},
      {"golden_spiral", [] { return golden_spiral(1000); }},
      {"golden_spiral_inward", [] { return reversed(golden_spiral(1000)); }},
  };
}

}  // namespace cadt::test
