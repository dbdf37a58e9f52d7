// SPDX-License-Identifier: Apache-2.0
// Lattices: cocircular squares everywhere, long lines on the hull, and the ends of the number range.
#include "tests/support/families.hpp"
#include "tests/support/same_math.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace cadt::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Points anisotropic(int exponent) {
  Points xy = grid_points(32, 32);
  for (std::size_t i = 1; i < xy.size(); i += 2) xy[i] = std::ldexp(xy[i], exponent);
  return xy;
}

Points multiplied(Points xy, double factor) {
  for (double& value : xy) value *= factor;
  return xy;
}

Points hexagonal(int columns, int rows) {
  Points xy = grid_points(columns, rows);
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    xy[i] += std::fmod(xy[i + 1], 2.0) * 0.5;
    xy[i + 1] *= std::numbers::sqrt3 / 2.0;
  }
  return xy;
}

// Midpoints of midpoints: each level's points lie exactly on edges of the level before.
Points dyadic_midpoints(int levels) {
  Points xy = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0};
  for (int k = 1; k <= levels; ++k) {
    const double step = std::ldexp(1.0, -k);
    for (int i = 0; i <= 1 << k; ++i) {
      for (int j = 0; j <= 1 << k; ++j) {
        if ((i | j) & 1) xy.insert(xy.end(), {i * step, j * step});
      }
    }
  }
  return xy;
}

Points with_centers(int n) {
  Points xy = grid_points(n, n);
  const Points centers = moved(grid_points(n - 1, n - 1), 0.5, 0.5);
  xy.insert(xy.end(), centers.begin(), centers.end());
  return xy;
}

Points thinned(const Points& xy, std::uint64_t seed) {
  Random random(seed);
  Points kept;
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    if (random.below(3) != 0) kept.insert(kept.end(), {xy[i], xy[i + 1]});
  }
  return kept;
}

Points cantor_dust() {
  Points line;
  for (int k = 0; k < 32; ++k) {
    double x = 0.0;
    for (int b = 0; b < 5; ++b) x += ((k >> b) & 1) * 2.0 / same_power(3.0, b + 1);
    line.push_back(x);
  }
  Points xy;
  for (const double x : line) {
    for (const double y : line) xy.insert(xy.end(), {x, y});
  }
  return xy;
}

Points tilted(int n, double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0, c = same_cos(angle), s = same_sin(angle);
  Points xy = grid_points(n, n);
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    const double x = xy[i], y = xy[i + 1];
    xy[i] = x * c - y * s;
    xy[i + 1] = x * s + y * c;
  }
  return xy;
}

// Tilted by a whole vector (a, b): the squares stay exact.
Points tilted_exactly(int n, double a, double b) {
  Points xy = grid_points(n, n);
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    const double x = xy[i], y = xy[i + 1];
    xy[i] = a * x - b * y;
    xy[i + 1] = b * x + a * y;
  }
  return xy;
}

Points random_exponents(std::size_t n, int low, int high, std::uint64_t seed) {
  Random random(seed);
  Points xy;
  const auto span = static_cast<std::size_t>(high - low + 1);
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double size = random.uniform(0.5, 1.0), mantissa = random.below(2) ? size : -size;
    xy.push_back(std::ldexp(mantissa, low + static_cast<int>(random.below(span))));
  }
  return xy;
}

Points corners_of_range() {
  constexpr double m = std::numeric_limits<double>::max();
  return {m, m, -m, m, -m, -m, m, -m, 0.0, 0.0, 1.0, 1.0, m / 2, -m / 3};
}

Points neighbors_of(double value) {
  const double next = std::nextafter(value, 1.0);
  Points xy;
  for (const double x : {value, next, -value, -next}) {
    for (const double y : {value, next, -value, -next}) xy.insert(xy.end(), {x, y});
  }
  return xy;
}

Points jittered_by_ulp(bool both) {
  Random random(38);
  Points xy = moved(grid_points(32, 32), 1.0, 1.0);
  for (std::size_t i = 0; i < xy.size(); i += both ? 1 : 2)
    xy[i] = std::nextafter(xy[i], random.below(2) ? infinity : -infinity);
  return xy;
}

Points ulp_grid(double origin, double step) {
  Points xy;
  for (int i = 0; i < 24; ++i) {
    for (int j = 0; j < 24; ++j) xy.insert(xy.end(), {origin + i * step, origin + j * step});
  }
  return xy;
}

// Points that miss the hull's line by as little as a double can.
Points off_the_hull_line() {
  constexpr int m = 200;
  Points xy;
  for (int i = 0; i < m; ++i) xy.insert(xy.end(), {double(i), 0.0});
  for (int i = 0; i + 1 < m; ++i) xy.insert(xy.end(), {i + 0.5, i % 2 ? -5e-324 : std::ldexp(1.0, -52)});
  xy.insert(xy.end(), {m / 2.0, double(m)});
  return xy;
}

Points near_diagonal() {
  Points xy;
  for (int i = 0; i < 100; ++i) {
    const double x = 0.5 + i * std::ldexp(1.0, -53);
    xy.insert(xy.end(), {x, x, 12.0 + i, 12.0 + i, x, std::nextafter(x, i % 2 ? 1.0 : 0.0)});
  }
  return xy;
}

std::string number(double value) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 4);
}

}  // namespace

std::vector<Family> grid_families() {
  return {
      {"grid_32x32", [] { return grid_points(32, 32); }},
      {"grid_33x31_shuffled", [] { return shuffled(grid_points(33, 31), 3); }},
      {"grid_2x500", [] { return grid_points(500, 2); }},
      {"grid_3x100", [] { return grid_points(3, 100); }},
      {"grid_100x100_shuffled", [] { return shuffled(grid_points(100, 100), 5); }},
      {"grid_spacing_0.1", [] { return multiplied(grid_points(32, 32), 0.1); }},
      {"grid_anisotropic_2^-40", [] { return anisotropic(-40); }},
      {"grid_anisotropic_2^-900", [] { return anisotropic(-900); }},
      {"hexagonal", [] { return hexagonal(32, 32); }},
      {"dyadic_midpoints", [] { return dyadic_midpoints(5); }},
      {"grid_with_centres", [] { return with_centers(24); }},
      {"grid_with_centres_shuffled", [] { return shuffled(with_centers(24), 7); }},
      {"grid_thinned", [] { return thinned(grid_points(40, 40), 11); }},
      {"cantor_dust", [] { return cantor_dust(); }},
  };
}

std::vector<Family> tilted_families() {
  std::vector<Family> result;
  for (int i = 0; i < 60; ++i) {
    const double degrees = 0.1 + 6.05 * i;
    result.push_back({"tilted_" + number(degrees), [degrees] { return tilted(12, degrees); }});
  }
  for (const char* text : {"1e-7", "1e-14", "30", "45", "60", "302.328"}) {
    const double degrees = std::strtod(text, nullptr);
    result.push_back({std::string("tilted_") + text, [degrees] { return tilted(32, degrees); }});
  }
  result.push_back({"tilted_exactly_3_4", [] { return tilted_exactly(24, 3.0, 4.0); }});
  result.push_back({"tilted_exactly_1_1e6", [] { return tilted_exactly(24, 1.0, 1e6); }});
  result.push_back({"tilted_exactly_1_1", [] { return tilted_exactly(24, 1.0, 1.0); }});
  return result;
}

std::vector<Family> scaled_families() {
  std::vector<Family> result;
  for (const int exponent : {-1074, -1040, -600, -540, -300, -216, -142, 248, 250, 300, 510, 512, 700, 1018}) {
    result.push_back(
        {"grid_2^" + std::to_string(exponent), [exponent] { return scaled(grid_points(20, 20), exponent); }});
  }
  for (const int exponent : {-1000, -500, -250, -200, 200, 255, 300, 500, 900, 1022}) {
    result.push_back({"uniform_2^" + std::to_string(exponent),
                      [exponent] { return scaled(moved(uniform_points(300, 64), -0.5, -0.5), exponent); }});
  }
  result.insert(result.end(),
                {{"grid_1e-150", [] { return multiplied(grid_points(20, 20), 1e-150); }},
                 {"grid_1e150", [] { return multiplied(grid_points(20, 20), 1e150); }},
                 {"grid_1e-150_tilted", [] { return multiplied(tilted(20, 17.0), 1e-150); }},
                 {"grid_1e150_tilted", [] { return multiplied(tilted(20, 17.0), 1e150); }},
                 {"grid_at_1e15", [] { return moved(grid_points(32, 32), 1e15, 1e15); }},
                 {"eighths_at_1e15", [] { return moved(scaled(grid_points(32, 32), -3), 1e15, -1e15); }},
                 {"uniform_at_1e15", [] { return moved(uniform_points(2000, 68), 1e15, 1e15); }},
                 {"uniform_at_1e8", [] { return moved(uniform_points(1000, 68), 1e8, -1e8); }},
                 {"grid_at_2^1023", [] { return moved(scaled(grid_points(12, 12), 971), 0x1p1023, -0x1p1023); }},
                 {"five_smallest", [] { return Points{0, 0, 5e-324, 0, 0, 5e-324, 5e-324, 5e-324, 1e-323, 5e-324}; }},
                 {"smallest_and_one", [] { return Points{0, 0, 1, 0, 0, 1, 5e-324, 5e-324, 1, 5e-324, 0.5, 0.5}; }},
                 {"corners_of_the_range", [] { return corners_of_range(); }},
                 {"neighbours_of_2^-142", [] { return neighbors_of(0x1p-142); }},
                 {"neighbours_of_smallest_normal", [] { return neighbors_of(0x1p-1022); }},
                 {"exponents_-30_30", [] { return random_exponents(400, -30, 30, 1); }},
                 {"exponents_-300_300", [] { return random_exponents(400, -300, 300, 2); }},
                 {"exponents_all", [] { return random_exponents(400, -1073, 1023, 3); }},
                 {"exponents_all_7", [] { return random_exponents(7, -1073, 1023, 4); }},
                 {"one_point_far_away", [] {
                    Points xy = grid_points(16, 16);
                    xy.insert(xy.end(), {1e300, 1e-300});
                    return xy;
                  }}});
  return result;
}

std::vector<Family> ulp_families() {
  return {
      {"jitter_of_x_by_an_ulp", [] { return jittered_by_ulp(false); }},
      {"jitter_by_an_ulp", [] { return jittered_by_ulp(true); }},
      {"ulp_grid_at_1", [] { return ulp_grid(1.0, 0x1p-52); }},
      {"ulp_grid_at_0.5", [] { return ulp_grid(0.5, 0x1p-53); }},
      {"ulp_grid_around_0", [] { return ulp_grid(-12 * 5e-324, 5e-324); }},
      {"ulp_grid_across_1", [] { return ulp_grid(1.0 - 12 * 0x1p-53, 0x1p-53); }},
      {"off_the_hull_line", [] { return off_the_hull_line(); }},
      {"near_diagonal", [] { return near_diagonal(); }},
      {"neighbours_of_1", [] { return neighbors_of(1.0); }},
      {"neighbours_of_1/3", [] { return neighbors_of(1.0 / 3.0); }},
  };
}

}  // namespace cadt::test
