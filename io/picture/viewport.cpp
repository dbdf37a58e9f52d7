// SPDX-License-Identifier: Apache-2.0
#include "io/picture/viewport.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadt::io::picture {

namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

/// a / b for two spans, either of which may be 0 or subnormal.
double ratio(double a, double b) {
  if (b == 0.0) return a == 0.0 ? 1.0 : std::numeric_limits<double>::infinity();
  int ea = 0;
  int eb = 0;
  const double ma = std::frexp(a, &ea);
  const double mb = std::frexp(b, &eb);
  return std::ldexp(ma / mb, std::clamp(ea - eb, -1000, 1000));
}

}  // namespace

Viewport::Axis Viewport::make_axis(double low, double pre, double span, double pixels, double from, bool flip) {
  Axis axis;
  axis.pre = pre;
  axis.origin = low * pre;
  axis.offset = from;
  if (span == 0.0) {
    axis.first = 0.0;
    axis.offset = from + (flip ? -0.5 : 0.5) * pixels;
    return axis;
  }
  int exponent = 0;
  const double mantissa = std::frexp(span, &exponent);
  const int half = exponent / 2;
  axis.first = std::ldexp(1.0, -half);
  axis.second = std::ldexp(pixels / mantissa, -(exponent - half)) * (flip ? -1.0 : 1.0);
  return axis;
}

Viewport::Viewport(std::span<const double> xy, int width, int max_height, int height) {
  Range x;
  Range y;
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) {
    if (!std::isfinite(xy[i]) || !std::isfinite(xy[i + 1])) continue;
    x.add(xy[i]);
    y.add(xy[i + 1]);
  }
  if (x.low > x.high) x = y = Range{0.0, 0.0};  // no points

  // Quarters of the largest doubles have a finite difference; small coordinates would lose bits by that.
  const auto factor = [](Range r) {
    const double largest = std::max(std::fabs(r.low), std::fabs(r.high));
    return largest > 0.25 * std::numeric_limits<double>::max() ? 0.25 : 1.0;
  };
  const double pre_x = factor(x);
  const double pre_y = factor(y);
  const double span_x = x.high * pre_x - x.low * pre_x;
  const double span_y = y.high * pre_y - y.low * pre_y;
  const double height_to_width = ratio(span_y, span_x) * (pre_x / pre_y);
  const double aspect = std::clamp(height_to_width, 1.0 / max_aspect, max_aspect);

  width_ = std::clamp(width, 16, most_side);
  max_height = std::clamp(max_height, 16, most_side);
  margin_ = std::max(3.0, 0.015 * width_);
  if (height != 0) {
    height_ = std::clamp(height, 16, most_side);
    margin_ = std::min(margin_, 0.1 * std::min(width_, height_));
    const double room_x = width_ - 2.0 * margin_, room_y = height_ - 2.0 * margin_;
    const double inner_x = std::min(room_x, room_y / aspect), inner_y = inner_x * aspect;
    x_ = make_axis(x.low, pre_x, span_x, inner_x, 0.5 * (width_ - inner_x), false);
    y_ = make_axis(y.low, pre_y, span_y, inner_y, 0.5 * (height_ + inner_y), true);
    return;
  }
  double inner_x = width_ - 2.0 * margin_;
  double inner_y = inner_x * aspect;
  if (inner_y + 2.0 * margin_ > max_height) {
    margin_ = std::min(margin_, 0.1 * max_height);
    inner_y = max_height - 2.0 * margin_;
    inner_x = inner_y / aspect;
    width_ = std::min(width_, std::max(8, static_cast<int>(std::lround(inner_x + 2.0 * margin_))));
  }
  height_ = std::clamp(static_cast<int>(std::lround(inner_y + 2.0 * margin_)), 8, max_height);
  inner_x = width_ - 2.0 * margin_;
  inner_y = height_ - 2.0 * margin_;

  x_ = make_axis(x.low, pre_x, span_x, inner_x, margin_, false);
  y_ = make_axis(y.low, pre_y, span_y, inner_y, height_ - margin_, true);
}

std::vector<Point2f> Viewport::map_all(std::span<const double> xy) const {
  std::vector<Point2f> out(xy.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Position p = map(xy[2 * i], xy[2 * i + 1]);
    out[i] = {static_cast<float>(p.x), static_cast<float>(p.y)};
  }
  return out;
}

}  // namespace cadt::io::picture
