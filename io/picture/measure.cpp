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

std::vector<std::uint32_t> region_numbers(const Scene& scene) {
  std::vector<std::int32_t> different(scene.region.begin(), scene.region.end());
  std::sort(different.begin(), different.end());
  different.erase(std::unique(different.begin(), different.end()), different.end());
  if (different.size() < 2) return {};
  std::vector<std::uint32_t> numbers;
  numbers.reserve(scene.region.size());
  for (const std::int32_t region : scene.region) {
    const auto found = std::lower_bound(different.begin(), different.end(), region);
    numbers.push_back(static_cast<std::uint32_t>(found - different.begin()));
  }
  return numbers;
}

std::optional<HeightEnds> height_ends(const Scene& scene) {
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
  HeightEnds ends{at(0.005), at(0.995)};
  if (!(ends.low < ends.high)) ends = {sample.front(), sample.back()};  // nearly all at one level
  // Halves, because high - low may exceed the largest double.
  if (!(0.5 * ends.high - 0.5 * ends.low > 0.0)) return {};
  return ends;
}

std::vector<float> relative_heights(const Scene& scene) {
  const std::optional<HeightEnds> ends = height_ends(scene);
  if (!ends) return {};
  const double span = 0.5 * ends->high - 0.5 * ends->low;
  std::vector<float> out(scene.height.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double h = (0.5 * scene.height[i] - 0.5 * ends->low) / span;
    out[i] = std::isfinite(h) ? static_cast<float>(std::clamp(h, -1.0, 2.0)) : 0.0f;
  }
  return out;
}

EdgeLengths edge_lengths(const Scene& scene, std::span<const Point2f> position) {
  std::vector<float> lengths;
  double sum = 0.0;
  std::size_t taken = 0;
  for (std::size_t t = 0; t < scene.faces(); t += step_for(scene.faces())) {
    ++taken;
    const auto [a, b, c] = corners(scene, position, t);
    for (const float d :
         {std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - b.x, c.y - b.y), std::hypot(a.x - c.x, a.y - c.y)}) {
      if (!std::isfinite(d)) continue;
      lengths.push_back(d);
      sum += static_cast<double>(d);
    }
  }
  if (taken == 0) return {};
  // Nearly every edge has two triangles.
  return {quantile(lengths, 0.5), 0.5 * sum * static_cast<double>(scene.faces()) / static_cast<double>(taken)};
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

GroundOpacity::GroundOpacity(const Scene& scene, std::span<const Point2f> position, float median_edge_pixels)
    : scene_(scene),
      position_(position),
      begin_(std::max(6.0f * median_edge_pixels, 48.0f)),
      end_(3.0f * begin_),
      outer_(scene.points(), 0) {
  std::vector<std::size_t> large;
  for (std::size_t t = 0; t < scene.faces(); ++t) {
    if (longest_edge(t) > begin_) large.push_back(t);
  }
  for (const std::int32_t v : scene.hull) outer_[static_cast<std::size_t>(v)] = 1;
  // Bays are a few triangles deep; a bound keeps a hostile mesh from making this quadratic.
  constexpr int most_rounds = 32;
  bool grown = true;
  for (int round = 0; grown && round < most_rounds; ++round) {
    grown = false;
    for (const std::size_t t : large) {
      const std::int32_t* v = scene.triangles.data() + 3 * t;
      const auto at = [&](int k) -> std::uint8_t& { return outer_[static_cast<std::size_t>(v[k])]; };
      const int known = at(0) + at(1) + at(2);
      if (known == 0 || known == 3) continue;
      at(0) = at(1) = at(2) = 1;
      grown = true;
    }
  }
}

float GroundOpacity::longest_edge(std::size_t t) const {
  const auto [a, b, c] = corners(scene_, position_, t);
  return longest(a, b, c);
}

float GroundOpacity::operator()(std::size_t t) const {
  if (outer_[static_cast<std::size_t>(scene_.triangles[3 * t])] == 0) return 1.0f;
  const float s = std::clamp((longest_edge(t) - begin_) / (end_ - begin_), 0.0f, 1.0f);
  return 1.0f - 0.8f * s;
}

}  // namespace cadt::io::picture
