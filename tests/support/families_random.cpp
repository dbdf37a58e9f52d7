// SPDX-License-Identifier: Apache-2.0
// Tiny sets, sizes, duplicates, orders and clusters.
#include "tests/support/families.hpp"
#include "tests/support/same_math.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

namespace cadt::test {
namespace {

Points repeated(const Points& xy, int times) {
  Points result;
  for (int k = 0; k < times; ++k) result.insert(result.end(), xy.begin(), xy.end());
  return result;
}

Points each_twice(const Points& xy) {
  Points result;
  for (std::size_t i = 0; i < xy.size(); i += 2) result.insert(result.end(), {xy[i], xy[i + 1], xy[i], xy[i + 1]});
  return result;
}

Points backwards(const Points& xy) {
  std::vector<std::size_t> order(xy.size() / 2);
  std::iota(order.rbegin(), order.rend(), std::size_t{0});
  return reordered(xy, order);
}

// Copies of point 0 where blocks of threads end.
Points copies_at_block_ends() {
  Points xy = uniform_points(1025, 15);
  for (const std::size_t k : {31u, 32u, 255u, 256u, 257u, 511u, 512u, 1024u}) xy[2 * k] = xy[0], xy[2 * k + 1] = xy[1];
  return xy;
}

Points few_places(std::size_t n, std::size_t places, std::uint64_t seed) {
  Random random(seed);
  const Points all = uniform_points(places, seed + 1);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = 2 * random.below(places);
    xy.insert(xy.end(), {all[k], all[k + 1]});
  }
  return xy;
}

Points signed_zero_lattice() {
  Points xy;
  for (const double x : {-1.0, -0.0, 0.0, 1.0}) {
    for (const double y : {-0.0, 1.0, 0.0, -1.0}) xy.insert(xy.end(), {x, y});
  }
  return xy;
}

// Zeros of either sign, more than are sorted in place in a cell, among points too near to be in other cells than they
// are, and some far away.
Points zeros_in_a_crowd() {
  Random random(34);
  Points xy;
  for (std::size_t i = 0; i < 400; ++i) {
    const double x = random.below(2) == 0 ? 0.0 : -0.0, y = random.below(2) == 0 ? 0.0 : -0.0;
    xy.insert(xy.end(), {x, y});
    if (i % 4 == 0) xy.insert(xy.end(), {random.uniform(-1e-30, 1e-30), random.uniform(-1e-30, 1e-30)});
    if (i % 8 == 0) xy.insert(xy.end(), {random.uniform(-1e-30, 1e-30), y, x, random.uniform(-1e-30, 1e-30)});
    if (i % 16 == 0) xy.insert(xy.end(), {random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3)});
  }
  return xy;
}

template <class Key>
Points sorted_by(const Points& xy, Key key) {
  std::vector<std::size_t> order(xy.size() / 2);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return key(xy[2 * a], xy[2 * a + 1]) < key(xy[2 * b], xy[2 * b + 1]);
  });
  return reordered(xy, order);
}

double morton(double x, double y) {
  double code = 0.0;
  auto u = static_cast<unsigned>(x * 65536.0), v = static_cast<unsigned>(y * 65536.0);
  for (int b = 15; b >= 0; --b) code = code * 4.0 + ((u >> b) & 1) * 2 + ((v >> b) & 1);
  return code;
}

double from_center(double x, double y) { return (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5); }

Points bit_reversed(const Points& xy, unsigned bits) {
  std::vector<std::size_t> order(xy.size() / 2);
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::size_t reverse = 0;
    for (unsigned b = 0; b < bits; ++b) reverse |= ((i >> b) & 1u) << (bits - 1 - b);
    order[i] = reverse;
  }
  return reordered(xy, order);
}

// All points within one huge triangle, nearest to its middle first: all contend for the same triangle at the start.
Points inside_one_triangle() {
  Points inner =
      sorted_by(moved(uniform_points(997, 86), -0.5, -0.5), [](double x, double y) { return x * x + y * y; });
  inner.insert(inner.begin(), {-100, -100, 100, -100, 0, 100});
  return inner;
}

Points kuzmin(std::size_t n) {
  Random random(55);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = 1.0 - random.uniform(), angle = 2.0 * std::numbers::pi * random.uniform();
    const double r = std::sqrt(1.0 / (s * s) - 1.0);
    xy.insert(xy.end(), {r * same_cos(angle), r * same_sin(angle)});
  }
  return xy;
}

Points line_singularity(std::size_t n) {
  Random random(56);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = random.uniform(), v = random.uniform();
    xy.insert(xy.end(), {0.001 / (u - 0.001 * u + 0.001), v});
  }
  return xy;
}

Points sierpinski(std::size_t n) {
  Random random(57);
  const double corner[3][2] = {{0, 0}, {1, 0}, {0.5, 1}};
  double x = 0.0, y = 0.0;
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double* to = corner[random.below(3)];
    x = (x + to[0]) / 2, y = (y + to[1]) / 2;
    xy.insert(xy.end(), {x, y});
  }
  return xy;
}

Points axis_spikes(std::size_t n) {
  Random random(58);
  Points xy;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double a = -same_log(1.0 - random.uniform());
    xy.push_back(a * same_power(random.uniform(), 10));
  }
  return xy;
}

Points nested_clusters(int levels) {
  Random random(77);
  Points xy;
  for (int k = 0; k < levels; ++k) {
    for (int i = 0; i < 60; ++i) {
      const double x = random.uniform(), y = random.uniform();
      xy.insert(xy.end(), {std::ldexp(x, -8 * k), std::ldexp(y, -8 * k)});
    }
  }
  return xy;
}

}  // namespace

std::vector<Family> tiny_families() {
  return {
      {"none", [] { return Points{}; }},
      {"one",
       [] {
         return Points{0.25, -3};
       }},
      {"two",
       [] {
         return Points{0, 0, 1, 0};
       }},
      {"two_equal",
       [] {
         return Points{1, 2, 1, 2};
       }},
      {"counterclockwise", [] { return Points{0, 0, 1, 0, 0, 1}; }},
      {"clockwise", [] { return Points{0, 0, 0, 1, 1, 0}; }},
      {"three_on_a_line", [] { return Points{0, 0, 1, 1, 2, 2}; }},
      {"square", [] { return Points{0, 0, 1, 0, 1, 1, 0, 1}; }},
      {"square_clockwise", [] { return Points{0, 0, 0, 1, 1, 1, 1, 0}; }},
      {"square_and_centre", [] { return Points{0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5}; }},
      {"point_on_an_edge", [] { return Points{0, 0, 2, 0, 1, 2, 1, 0}; }},
      {"signed_zeros", [] { return Points{0, 0, -0., 0, 0, -0., -0., -0., 1, 0, 1, -0., 0, 1, -0., 1}; }},
      {"two_places",
       [] {
         return repeated({0, 0, 1, 1}, 500);
       }},
      {"two_zeros",
       [] {
         return Points{-0., 0, 0, -0.};
       }},
  };
}

std::vector<Family> size_families() {
  std::set<std::size_t> sizes = {20000};
  for (std::size_t n = 3; n <= 64; ++n) sizes.insert(n);
  for (const std::size_t block : {64u, 128u, 256u, 512u, 1024u, 4096u}) {
    sizes.insert({block - 1, block, block + 1, 2 * block - 1, 2 * block + 1});
  }
  std::vector<Family> result;
  for (const std::size_t n : sizes)
    result.push_back({"uniform_" + std::to_string(n), [n] { return uniform_points(n, n); }});
  return result;
}

std::vector<Family> duplicate_families() {
  return {
      {"one_place_1000",
       [] {
         return repeated({0.1, 0.2}, 1000);
       }},
      {"triangle_and_997_copies",
       [] {
         Points xy = {0, 0, 1, 0, 0, 1};
         const Points copies = repeated({0, 0}, 997);
         xy.insert(xy.end(), copies.begin(), copies.end());
         return xy;
       }},
      {"copies_before_the_triangle",
       [] {
         Points xy = repeated({1, 0}, 997);
         xy.insert(xy.end(), {0, 0, 0, 1});
         return xy;
       }},
      {"each_twice", [] { return each_twice(uniform_points(1000)); }},
      {"twice_in_reverse",
       [] {
         Points xy = uniform_points(1000);
         const Points again = backwards(xy);
         xy.insert(xy.end(), again.begin(), again.end());
         return xy;
       }},
      {"copies_at_block_ends", [] { return copies_at_block_ends(); }},
      {"grid_ten_times_shuffled", [] { return shuffled(repeated(grid_points(12, 12), 10), 21); }},
      {"three_places", [] { return few_places(2000, 3, 31); }},
      {"ten_places", [] { return few_places(2000, 10, 32); }},
      {"signed_zero_lattice", [] { return signed_zero_lattice(); }},
      {"zeros_in_a_crowd", [] { return zeros_in_a_crowd(); }},
      {"line_five_times",
       [] {
         return shuffled(repeated({0, 0, 1, 1, 2, 2, 3, 3}, 5), 33);
       }},
  };
}

std::vector<Family> order_families() {
  static const Points base = uniform_points(1024, 77);
  return {
      {"x_ascending", [] { return sorted_by(base, [](double x, double) { return x; }); }},
      {"x_descending", [] { return sorted_by(base, [](double x, double) { return -x; }); }},
      {"y_ascending", [] { return sorted_by(base, [](double, double y) { return y; }); }},
      {"y_descending", [] { return sorted_by(base, [](double, double y) { return -y; }); }},
      {"diagonal", [] { return sorted_by(base, [](double x, double y) { return x + y; }); }},
      {"columns", [] { return sorted_by(base, [](double x, double y) { return std::floor(x * 32) + y; }); }},
      {"morton", [] { return sorted_by(base, morton); }},
      {"outward", [] { return sorted_by(base, from_center); }},
      {"inward", [] { return backwards(sorted_by(base, from_center)); }},
      {"bit_reversed", [] { return bit_reversed(sorted_by(base, [](double x, double) { return x; }), 10); }},
      {"shuffled", [] { return shuffled(base, 78); }},
      {"grid_by_columns_of_y",
       [] { return sorted_by(grid_points(32, 32), [](double x, double y) { return y * 64 + x; }); }},
      {"grid_outward",
       [] {
         return sorted_by(moved(grid_points(31, 31), -15, -15), [](double x, double y) { return x * x + y * y; });
       }},
  };
}

std::vector<Family> cluster_families() {
  return {
      {"two_clusters_1e12_apart", [] { return two_clusters(2000); }},
      {"two_clusters_1e12_apart_in_turn", [] { return shuffled(two_clusters(2000), 5); }},
      {"gaussians_1e-6", [] { return cluster_points(2000); }},
      {"999_of_1000_in_1e-12", [] { return skewed_points(2000); }},
      {"kuzmin", [] { return kuzmin(2000); }},
      {"line_singularity", [] { return line_singularity(2000); }},
      {"sierpinski", [] { return sierpinski(2000); }},
      {"axis_spikes", [] { return axis_spikes(2000); }},
      {"nested_clusters", [] { return nested_clusters(30); }},
      {"nested_clusters_deep", [] { return nested_clusters(130); }},
      {"inside_one_triangle", [] { return inside_one_triangle(); }},
  };
}

const std::vector<FamilyGroup>& family_groups() {
  static const std::vector<FamilyGroup> groups = {
      {"tiny", tiny_families},     {"sizes", size_families},           {"grids", grid_families},
      {"tilted", tilted_families}, {"scaled", scaled_families},        {"circles", circle_families},
      {"lines", line_families},    {"duplicates", duplicate_families}, {"ulps", ulp_families},
      {"orders", order_families},  {"curves", curve_families},         {"clusters", cluster_families},
  };
  return groups;
}

}  // namespace cadt::test
