// SPDX-License-Identifier: Apache-2.0
#include "io/generate/random.hpp"
#include "io/generate/relief.hpp"
#include "io/generate/sets.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cadt::io::generate_detail {

void terrain(const GenerateOptions& options, PointSet& out) {
  SplitMix64 random(options.seed);
  const Relief relief(options.seed);
  out.xy.resize(2 * options.n);
  out.height.resize(options.n);
  for (std::size_t i = 0; i < options.n; ++i) {
    out.xy[2 * i] = random.uniform();
    out.xy[2 * i + 1] = random.uniform();
    out.height[i] = relief(out.xy[2 * i], out.xy[2 * i + 1]);
  }
}

namespace {

/// The relief on a square sampling, and its crossings with level lines: points along contours, as a digitised map has.
class ContourTracer {
 public:
  ContourTracer(std::uint64_t seed, std::size_t m) : m_(m), samples_((m + 1) * (m + 1)) {
    const Relief relief(seed);
    for (std::size_t j = 0; j <= m; ++j) {
      for (std::size_t i = 0; i <= m; ++i) samples_[j * (m + 1) + i] = relief(at(i), at(j));
    }
    const auto [low, high] = std::minmax_element(samples_.begin(), samples_.end());
    low_ = *low;
    range_ = *high - *low;
  }

  /// Number of levels for which about n points are expected: an edge of the sampling with the height difference d is
  /// crossed by d / interval level lines on average.
  [[nodiscard]] double levels_for(std::size_t n) const {
    double climbed = 0.0;
    for_each_step(
        [&](std::size_t, std::size_t, std::size_t, std::size_t, double a, double b) { climbed += std::fabs(b - a); });
    return static_cast<double>(n) * range_ / climbed;
  }

  /// Calls `emit(x, y, height)` for every crossing with the levels, row by row.
  template <class Emit>
  void trace(double levels, Emit emit) const {
    const double interval = range_ / levels;
    for_each_step([&](std::size_t i, std::size_t j, std::size_t di, std::size_t dj, double za, double zb) {
      const double a = (za - low_) / interval;
      const double b = (zb - low_) / interval;
      const double top = std::fmax(a, b);
      for (double level = std::ceil(std::fmin(a, b)); level < top; level += 1.0) {
        const double t = (level - a) / (b - a);
        emit(at(i) + t * (at(i + di) - at(i)), at(j) + t * (at(j + dj) - at(j)), low_ + interval * level);
      }
    });
  }

 private:
  [[nodiscard]] double at(std::size_t i) const { return static_cast<double>(i) / static_cast<double>(m_); }

  /// All edges of the sampling, with the heights of their ends.
  template <class Step>
  void for_each_step(Step step) const {
    for (std::size_t j = 0; j <= m_; ++j) {
      for (std::size_t i = 0; i <= m_; ++i) {
        const std::size_t k = j * (m_ + 1) + i;
        if (i < m_) step(i, j, 1, 0, samples_[k], samples_[k + 1]);
        if (j < m_) step(i, j, 0, 1, samples_[k], samples_[k + m_ + 1]);
      }
    }
  }

  std::size_t m_;
  std::vector<double> samples_;
  double low_ = 0.0;
  double range_ = 0.0;
};

}  // namespace

void contours(const GenerateOptions& options, PointSet& out) {
  if (options.n == 0) return;
  // Spacing along the lines and distance of the lines shrink together: both the sampling and the levels grow with the
  // root of n, and the work with n.
  const auto m = static_cast<std::size_t>(2.0 * std::sqrt(static_cast<double>(options.n))) + 16;
  const ContourTracer tracer(options.seed, m);
  std::vector<double> xyz;
  xyz.reserve(options.n * 7 / 2);
  for (double levels = 1.02 * tracer.levels_for(options.n) + 1.0;; levels *= 1.05) {
    xyz.clear();
    tracer.trace(levels, [&](double x, double y, double z) { xyz.insert(xyz.end(), {x, y, z}); });
    if (xyz.size() / 3 >= options.n) break;
  }
  // Drop the surplus evenly, so that no part of the map loses its lines.
  const std::size_t found = xyz.size() / 3;
  out.xy.reserve(2 * options.n);
  out.height.reserve(options.n);
  for (std::size_t i = 0; i < options.n; ++i) {
    const auto j =
        static_cast<std::size_t>(static_cast<double>(i) * static_cast<double>(found) / static_cast<double>(options.n));
    out.xy.insert(out.xy.end(), {xyz[3 * j], xyz[3 * j + 1]});
    out.height.push_back(xyz[3 * j + 2]);
  }
}

}  // namespace cadt::io::generate_detail
