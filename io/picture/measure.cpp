// SPDX-License-Identifier: Apache-2.0
#include "io/picture/measure.hpp"

#include <algorithm>
#include <cmath>

namespace cadt::io::picture {

namespace {

constexpr std::size_t samples = 60'000;

/// Step that takes about `samples` of n. Odd, so that it does not resonate with rows of a power-of-two lattice.
std::size_t step_for(std::size_t n) { return std::max<std::size_t>(1, n / samples) | 1; }

float log_area(Point2f a, Point2f b, Point2f c) {
  const float det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return std::log2(std::max(0.5f * std::fabs(det), 1e-6f));
}

float longest(Point2f a, Point2f b, Point2f c) {
  return std::max(
      {std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - b.x, c.y - b.y), std::hypot(a.x - c.x, a.y - c.y)});
}

/// The corners of triangle t.
struct Corners {
  Point2f a, b, c;
};
Corners corners(const Scene& scene, std::span<const Point2f> position, std::size_t t) {
  const auto at = [&](std::size_t k) { return position[static_cast<std::size_t>(scene.triangles[3 * t + k])]; };
  return {at(0), at(1), at(2)};
}

}  // namespace

float quantile(std::vector<float>& values, double q) {
  if (values.empty()) return 0.0f;
  const auto k = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

std::vector<float> relative_heights(const Scene& scene) {
  if (scene.height.size() != scene.points() || scene.height.empty()) return {};
  std::vector<double> sample;
  for (std::size_t i = 0; i < scene.height.size(); i += step_for(scene.height.size())) {
    if (std::isfinite(scene.height[i])) sample.push_back(scene.height[i]);
  }
  if (sample.empty()) return {};
  std::sort(sample.begin(), sample.end());
  const auto at = [&](double q) {
    return sample[static_cast<std::size_t>(q * static_cast<double>(sample.size() - 1) + 0.5)];
  };
  double low = at(0.005);
  double high = at(0.995);
  if (!(low < high)) low = sample.front(), high = sample.back();  // nearly all at one level
  if (!(low < high)) return {};
  // Halves, because high - low may exceed the largest double.
  const double span = 0.5 * high - 0.5 * low;
  if (!(span > 0.0)) return {};
  std::vector<float> out(scene.height.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double h = (0.5 * scene.height[i] - 0.5 * low) / span;
    out[i] = std::isfinite(h) ? static_cast<float>(std::clamp(h, -1.0, 2.0)) : 0.0f;
  }
  return out;
}

float median_edge(const Scene& scene, std::span<const Point2f> position) {
  std::vector<float> lengths;
  for (std::size_t t = 0; t < scene.faces(); t += step_for(scene.faces())) {
    const auto [a, b, c] = corners(scene, position, t);
    for (const float d : {std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - b.x, c.y - b.y)}) {
      if (std::isfinite(d)) lengths.push_back(d);
    }
  }
  return quantile(lengths, 0.5);
}

AreaScale::AreaScale(const Scene& scene, std::span<const Point2f> position) {
  std::vector<float> logs;
  for (std::size_t t = 0; t < scene.faces(); t += step_for(scene.faces())) {
    const auto [a, b, c] = corners(scene, position, t);
    const float v = log_area(a, b, c);
    if (std::isfinite(v)) logs.push_back(v);
  }
  low_ = quantile(logs, 0.03);
  high_ = quantile(logs, 0.97);
  // At least a factor of 32 from end to end: rounding noise of a lattice must not look like structure.
  const float missing = 5.0f - (high_ - low_);
  if (missing > 0.0f) low_ -= 0.5f * missing, high_ += 0.5f * missing;
}

float AreaScale::operator()(Point2f a, Point2f b, Point2f c) const {
  return std::clamp((log_area(a, b, c) - low_) / (high_ - low_), 0.0f, 1.0f);
}

GroundOpacity::GroundOpacity(float median_edge_pixels)
    : begin_(std::max(6.0f * median_edge_pixels, 48.0f)), end_(3.0f * begin_) {}

float GroundOpacity::operator()(Point2f a, Point2f b, Point2f c) const {
  const float t = std::clamp((longest(a, b, c) - begin_) / (end_ - begin_), 0.0f, 1.0f);
  return 1.0f - 0.8f * t;
}

}  // namespace cadt::io::picture
