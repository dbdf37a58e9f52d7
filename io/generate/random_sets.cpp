// SPDX-License-Identifier: Apache-2.0
#include "io/generate/random.hpp"
#include "io/generate/sets.hpp"

#include <cadt/uniform_cells.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace cadt::io::generate_detail {

namespace {

/// Fills `out.xy` with `n` points made by `point(i, x, y)`; one resize, no growth checks in the loop.
template <class Point>
void fill(PointSet& out, std::size_t n, Point point) {
  out.xy.resize(2 * n);
  double* xy = out.xy.data();
  for (std::size_t i = 0; i < n; ++i, xy += 2) point(i, xy[0], xy[1]);
}

}  // namespace

void uniform(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed, 2 * options.first);
  fill(out, options.n - options.first, [&](std::size_t, double& x, double& y) {
    x = random.uniform();
    y = random.uniform();
  });
}

void cells(const GenerateOptions& options, PointSet& out) {
  out.xy.resize(2 * options.n);
  UniformCells(options.n, options.seed).generate(0, options.n, out.xy.data());
}

void gaussian(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed, 2 * options.first);
  fill(out, options.n - options.first, [&](std::size_t, double& x, double& y) {
    // Both deviates of one Box-Muller pair: half the logarithms.
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    x = radius * std::cos(angle);
    y = radius * std::sin(angle);
  });
}

void kuzmin(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed, 2 * options.first);
  fill(out, options.n - options.first, [&](std::size_t, double& x, double& y) {
    const double rest = 1.0 - random.uniform();
    const double radius = std::sqrt(1.0 / (rest * rest) - 1.0);
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    x = radius * std::cos(angle);
    y = radius * std::sin(angle);
  });
}

void line(const GenerateOptions& options, PointSet& out) {
  constexpr double b = 0.001;
  SplitMix64 random(options.seed, 2 * options.first);
  fill(out, options.n - options.first, [&](std::size_t, double& x, double& y) {
    const double u = random.uniform();
    x = b / (u - b * u + b);
    y = random.uniform();
  });
}

void ring(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed, 2 * options.first);
  fill(out, options.n - options.first, [&](std::size_t, double& x, double& y) {
    const double radius = 0.45 + 0.001 * random.uniform();
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    x = 0.5 + radius * std::cos(angle);
    y = 0.5 + radius * std::sin(angle);
  });
}

void clusters(const GenerateOptions& options, PointSet& out) {
  constexpr std::size_t count = 100;
  constexpr double sigma = 1e-6;
  SplitMix64 random(options.seed);
  std::array<double, 2 * count> centres;
  for (double& c : centres) c = random.uniform();
  fill(out, options.n, [&](std::size_t i, double& x, double& y) {
    x = centres[2 * (i % count)] + sigma * random.normal();
    y = centres[2 * (i % count) + 1] + sigma * random.normal();
  });
}

void skewed(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed);
  fill(out, options.n, [&](std::size_t i, double& x, double& y) {
    const bool spread = i % 1000 == 0;
    x = spread ? random.uniform() : 0.5 + 1e-12 * random.uniform();
    y = spread ? random.uniform() : 0.5 + 1e-12 * random.uniform();
  });
}

void two_clusters(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed);
  fill(out, options.n, [&](std::size_t i, double& x, double& y) {
    x = random.uniform() + (i % 2 == 0 ? 0.0 : 1e12);
    y = random.uniform() + (i % 2 == 0 ? 0.0 : 1e12);
  });
}

void duplicates(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed);
  fill(out, options.n, [&](std::size_t i, double& x, double& y) {
    // Every other point is a copy of an earlier one, so early points have the most copies.
    if (i % 2 == 1) {
      const std::size_t j = static_cast<std::size_t>(random.next() % i);
      x = out.xy[2 * j];
      y = out.xy[2 * j + 1];
    } else {
      x = random.uniform();
      y = random.uniform();
    }
  });
}

}  // namespace cadt::io::generate_detail
