// SPDX-License-Identifier: Apache-2.0
#include "io/generate/random.hpp"
#include "io/generate/sets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <stdexcept>

namespace cadt::io::generate_detail {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// Columns of the near-square lattice that holds n points row by row; the last row may be short.
std::size_t columns(std::size_t n) {
  const auto root = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n))));
  return std::max<std::size_t>(root, 1);
}

/// Calls `point(i, column, row)` for the n points of the near-square lattice.
template <class Point>
void lattice(PointSet& out, std::size_t n, Point point) {
  const std::size_t wide = columns(n);
  out.xy.resize(2 * n);
  std::size_t i = 0;
  for (std::size_t row = 0; i < n; ++row) {
    for (std::size_t column = 0; column < wide && i < n; ++column, ++i) {
      point(static_cast<double>(column), static_cast<double>(row), out.xy[2 * i], out.xy[2 * i + 1]);
    }
  }
}

void push(PointSet& out, double x, double y) {
  out.xy.push_back(x);
  out.xy.push_back(y);
}

}  // namespace

void grid(const GenerateOptions& options, PointSet& out) {
  lattice(out, options.n, [](double column, double row, double& x, double& y) {
    x = column;
    y = row;
  });
}

void tilted(const GenerateOptions& options, PointSet& out) {
  const double angle = 302.328 * std::numbers::pi / 180.0;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  lattice(out, options.n, [=](double column, double row, double& x, double& y) {
    x = column * c - row * s;
    y = column * s + row * c;
  });
}

void hex(const GenerateOptions& options, PointSet& out) {
  const double step = std::sqrt(3.0) / 2.0;
  lattice(out, options.n, [=](double column, double row, double& x, double& y) {
    x = column + (std::fmod(row, 2.0) == 1.0 ? 0.5 : 0.0);
    y = row * step;
  });
}

void collinear(const GenerateOptions& options, PointSet& out) {
  // (3 t, 2 t) with integer t: exactly on one line of slope 2/3. The multiplier is odd and the range a power of two, so
  // that t visits every residue once and the points come in no order.
  std::size_t range = 1;
  while (range < options.n) range *= 2;
  out.xy.reserve(2 * options.n);
  for (std::size_t i = 0, made = 0; made < options.n; ++i) {
    const std::size_t t = (i * 0x9E3779B1u + static_cast<std::size_t>(options.seed)) & (range - 1);
    if (t >= options.n) continue;
    push(out, 3.0 * static_cast<double>(t), 2.0 * static_cast<double>(t));
    ++made;
  }
}

void circles(const GenerateOptions& options, PointSet& out) {
  if (options.k < 1) throw std::invalid_argument("circles need at least one point each (k >= 1)");
  const auto k = static_cast<std::size_t>(options.k);
  const double per_side = std::sqrt(static_cast<double>(options.n) / static_cast<double>(k));
  const auto m = static_cast<std::size_t>(std::max(1.0, std::round(per_side)));
  const double cell = 1.0 / static_cast<double>(m);

  // Equations 7 and 8 of the paper, the same k directions for every circle.
  std::vector<double> direction(2 * k);
  for (std::size_t q = 0; q < k; ++q) {
    const double angle = two_pi * static_cast<double>(q) / static_cast<double>(k);
    direction[2 * q] = options.radius * std::cos(angle);
    direction[2 * q + 1] = options.radius * std::sin(angle);
  }
  SplitMix64 random(options.seed);
  out.xy.resize(2 * m * m * k);
  double* xy = out.xy.data();
  for (std::size_t row = 0; row < m; ++row) {
    for (std::size_t column = 0; column < m; ++column) {
      for (std::size_t q = 0; q < k; ++q, xy += 2) {
        const double dx = random.symmetric(options.epsilon);
        const double dy = random.symmetric(options.epsilon);
        xy[0] = cell * (static_cast<double>(column) + 0.5 + direction[2 * q] + dx);
        xy[1] = cell * (static_cast<double>(row) + 0.5 + direction[2 * q + 1] + dy);
      }
    }
  }
}

void concentric(const GenerateOptions& options, PointSet& out) {
  // 1105^2 = (5 * 13 * 17)^2 is a sum of two squares in 4 * 3^3 = 108 ways: 108 integer points on each circle.
  constexpr std::int64_t radius = 1105;
  std::vector<std::array<double, 2>> base;
  for (std::int64_t x = -radius; x <= radius; ++x) {
    const std::int64_t square = radius * radius - x * x;
    auto y = static_cast<std::int64_t>(std::llround(std::sqrt(static_cast<double>(square))));
    if (y * y != square) continue;
    base.push_back({static_cast<double>(x), static_cast<double>(y)});
    if (y != 0) base.push_back({static_cast<double>(x), static_cast<double>(-y)});
  }
  out.xy.reserve(2 * options.n);
  for (std::size_t i = 0; i < options.n; ++i) {
    const auto scale = static_cast<double>(i / base.size() + 1);
    const auto& p = base[i % base.size()];
    push(out, scale * p[0], scale * p[1]);
  }
}

void ngon(const GenerateOptions& options, PointSet& out) {
  out.xy.reserve(2 * options.n);
  for (std::size_t i = 0; i < options.n; ++i) {
    const double angle = two_pi * static_cast<double>(i) / static_cast<double>(options.n);
    push(out, std::cos(angle), std::sin(angle));
  }
}

void spiral(const GenerateOptions& options, PointSet& out) {
  out.xy.reserve(2 * options.n);
  for (std::size_t i = 1; i <= options.n; ++i) {
    const double root = std::sqrt(static_cast<double>(i));
    push(out, root * std::cos(4.0 * root), root * std::sin(4.0 * root));
  }
}

void parabola(const GenerateOptions& options, PointSet& out) {
  out.xy.reserve(2 * options.n);
  for (std::size_t i = 0; i < options.n; ++i) {
    const auto x = static_cast<double>(i);
    push(out, x, x * x);
  }
}

}  // namespace cadt::io::generate_detail
