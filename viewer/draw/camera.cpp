// SPDX-License-Identifier: Apache-2.0
#include "viewer/draw/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadt::viewer {
namespace {

constexpr double margin_share = 0.015;

/// A 256th of the largest doubles leaves room for what is seen around the box from afar; small coordinates would lose
/// bits by that.
double factor_before(const Extent& box) {
  double largest = 0;
  for (std::size_t k = 0; k < 2; ++k) largest = std::max({largest, std::fabs(box.low[k]), std::fabs(box.high[k])});
  constexpr double factor = 1.0 / 256;
  return largest > factor * std::numeric_limits<double>::max() ? factor : 1.0;
}

/// a / b for two spans, either of which may be 0 or subnormal.
double ratio(double a, double b) {
  if (b == 0.0) return a == 0.0 ? 1.0 : std::numeric_limits<double>::infinity();
  int ea = 0, eb = 0;
  const double ma = std::frexp(a, &ea), mb = std::frexp(b, &eb);
  return std::ldexp(ma / mb, std::clamp(ea - eb, -1000, 1000));
}

double span_of(const Extent& box, std::size_t k, double before) { return box.high[k] * before - box.low[k] * before; }

double aspect_of(const Extent& box) {
  const double before = factor_before(box);
  return std::clamp(ratio(span_of(box, 1, before), span_of(box, 0, before)), 1.0 / Camera::longest_aspect,
                    Camera::longest_aspect);
}

/// Two factors whose product makes `span` so many pixels.
void split_scale(double span, double pixels, double& first, double& second) {
  if (span == 0.0) {
    first = second = 1.0;
    return;
  }
  int exponent = 0;
  const double mantissa = std::frexp(span, &exponent);
  const int half_exponent = exponent / 2;
  first = std::ldexp(1.0, -half_exponent);
  second = std::ldexp(pixels / mantissa, -(exponent - half_exponent));
}

}  // namespace

Extent box_of(std::span<const double> xy) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Extent box{{inf, inf}, {-inf, -inf}};
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) {
    if (!std::isfinite(xy[i]) || !std::isfinite(xy[i + 1])) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      box.low[k] = std::min(box.low[k], xy[i + k]);
      box.high[k] = std::max(box.high[k], xy[i + k]);
    }
  }
  return box.empty() ? Extent{{0, 0}, {0, 0}} : box;
}

int Camera::height_for(const Extent& box, int width, int most) {
  const double inner = width * (1 - 2 * margin_share);
  return std::clamp(static_cast<int>(std::lround(inner * aspect_of(box) + 2 * margin_share * width)), 8,
                    std::max(8, most));
}

Camera::Camera(const Extent& box, int width, int height) : box_(box), before_(factor_before(box)) {
  resize(width, height);
}

void Camera::resize(int width, int height) {
  const bool fresh = width_ == 1 && height_ == 1;
  width_ = std::max(1, width);
  height_ = std::max(1, height);
  const double margin = std::max(3.0, margin_share * std::max(width_, height_));
  const double room_x = std::max(1.0, width_ - 2 * margin), room_y = std::max(1.0, height_ - 2 * margin);
  const double spans[] = {span_of(box_, 0, before_), span_of(box_, 1, before_)};
  // One scale for both axes, but for boxes that are longer than the limit.
  const double aspect = aspect_of(box_);
  double pixels[] = {room_x, room_x * aspect};
  if (pixels[1] > room_y) {
    pixels[0] = room_y / aspect;
    pixels[1] = room_y;
  }
  for (std::size_t k = 0; k < 2; ++k) split_scale(spans[k], pixels[k], first_[k], fitted_[k]);
  for (std::size_t k = 0; k < 2; ++k) {  // a box without width: the scale of the other axis
    if (spans[k] == 0.0 && spans[1 - k] != 0.0) {
      first_[k] = first_[1 - k];
      fitted_[k] = fitted_[1 - k];
    }
  }
  if (fresh)
    for (std::size_t k = 0; k < 2; ++k) middle_[k] = 0.5 * (box_.low[k] * before_) + 0.5 * (box_.high[k] * before_);
  limit();
}

void Camera::limit() {
  // Neighbouring doubles at the middle must not lie further apart than a tenth of a pixel.
  double most = 1e12;
  for (std::size_t k = 0; k < 2; ++k) {
    const double ulp =
        std::nextafter(std::fabs(middle_[k]), std::numeric_limits<double>::infinity()) - std::fabs(middle_[k]);
    const double pixels = ulp * first_[k] * fitted_[k];
    if (pixels > 0) most = std::min(most, 0.1 / pixels);
  }
  magnification_ = std::clamp(magnification_, least_magnification, std::max(1.0, most));
}

void Camera::pan(double dx, double dy) {
  if (dx == 0 && dy == 0) return;
  middle_[0] -= dx / fitted_[0] / magnification_ / first_[0];
  middle_[1] += dy / fitted_[1] / magnification_ / first_[1];
  for (std::size_t k = 0; k < 2; ++k)  // what is seen stays in reach
    middle_[k] = std::clamp(middle_[k], box_.low[k] * before_, box_.high[k] * before_);
}

void Camera::zoom(double factor, double x, double y) {
  const double old = magnification_;
  magnification_ *= factor;
  limit();
  const double grown = magnification_ / old;
  // The place under the cursor stays: the middle moves towards it.
  pan((x - 0.5 * width_) * (1 - grown), (y - 0.5 * height_) * (1 - grown));
}

void Camera::look_at(double x, double y) {
  middle_ = {x * before_, y * before_};
  limit();
}

Axis Camera::axis(int k) const noexcept {
  const auto i = static_cast<std::size_t>(k);
  const double sign = k == 0 ? 1.0 : -1.0;
  const double middle = 0.5 * (k == 0 ? width_ : height_);
  const double second = fitted_[i] * magnification_ * sign;
  return {middle_[i] - middle / second / first_[i], first_[i], second};
}

std::array<double, 2> Camera::place(double x, double y) const noexcept {
  const Axis h = axis(0), v = axis(1);
  return {(x / h.second / h.first + h.origin) / before_, (y / v.second / v.first + v.origin) / before_};
}

std::array<double, 2> Camera::pixel(double x, double y) const noexcept {
  const Axis h = axis(0), v = axis(1);
  return {(x * before_ - h.origin) * h.first * h.second, (y * before_ - v.origin) * v.first * v.second};
}

double Camera::scale() const noexcept { return first_[0] * fitted_[0] * magnification_ * before_; }

}  // namespace cadt::viewer
