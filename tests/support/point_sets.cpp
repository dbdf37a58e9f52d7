// SPDX-License-Identifier: Apache-2.0
// Building blocks of the families.
#include "tests/support/families.hpp"
#include "tests/support/same_math.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace cadt::test {

std::uint64_t Random::bits() {
  state_ += 0x9E3779B97F4A7C15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

double Random::uniform() { return std::ldexp(static_cast<double>(bits() >> 11), -53); }

double Random::normal() {
  const double a = 1.0 - uniform(), b = uniform();
  return std::sqrt(-2.0 * same_log(a)) * same_cos(2.0 * std::numbers::pi * b);
}

Points uniform_points(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  Points xy(2 * n);
  for (double& value : xy) value = random.uniform();
  return xy;
}

Points grid_points(int columns, int rows) {
  Points xy;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) xy.insert(xy.end(), {double(i), double(j)});
  }
  return xy;
}

Points scaled(Points xy, int exponent) {
  for (double& value : xy) value = std::ldexp(value, exponent);
  return xy;
}

Points moved(Points xy, double dx, double dy) {
  for (std::size_t i = 0; i < xy.size(); ++i) xy[i] += i % 2 == 0 ? dx : dy;
  return xy;
}

Points regular_polygon(int n, double cx, double cy, double r) {
  Points xy;
  for (int k = 0; k < n; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / n;
    xy.insert(xy.end(), {cx + r * same_cos(angle), cy + r * same_sin(angle)});
  }
  return xy;
}

Points parabola_points(std::size_t n) {
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(n) - 0.5;
    xy.insert(xy.end(), {x, x * x});
  }
  return shuffled(xy, 2);
}

Points hub_points(int n) {
  Points xy = regular_polygon(n, 0.0, 0.0, 1.0);
  xy.insert(xy.begin(), {0.0, 0.0});
  return xy;
}

Points skewed_points(std::size_t n) {
  Random random(59);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = random.uniform(), y = random.uniform();
    if (i % 1000 == 0) {
      xy.insert(xy.end(), {x, y});
    } else {
      xy.insert(xy.end(), {0.5 + 1e-12 * x, 0.5 + 1e-12 * y});
    }
  }
  return xy;
}

Points cluster_points(std::size_t n) {
  Random random(54);
  const Points centers = uniform_points(100, 540);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t c = 2 * (i % 100);
    const double dx = random.normal(), dy = random.normal();
    xy.insert(xy.end(), {centers[c] + 1e-6 * dx, centers[c + 1] + 1e-6 * dy});
  }
  return xy;
}

Points two_clusters(std::size_t n) {
  Points xy = uniform_points(n, 12);
  for (std::size_t i = 1; i < n; i += 2) xy[2 * i] += 1e12;
  return xy;
}

Points axis_cross(int arm) {
  Points xy;
  for (int i = 1; i <= arm; ++i) {
    const double d = i;
    xy.insert(xy.end(), {d, 0.0, 0.0, d, -d, 0.0, 0.0, -d});
  }
  return xy;
}

Points reordered(const Points& xy, const std::vector<std::size_t>& order) {
  Points result;
  result.reserve(xy.size());
  for (const std::size_t i : order) result.insert(result.end(), {xy[2 * i], xy[2 * i + 1]});
  return result;
}

std::vector<std::size_t> random_order(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

Points shuffled(const Points& xy, std::uint64_t seed) { return reordered(xy, random_order(xy.size() / 2, seed)); }

}  // namespace cadt::test
