// SPDX-License-Identifier: Apache-2.0
// From the plane to the picture, for coordinates of any size.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace cadt::io::picture {

struct Point2f {
  float x, y;
};

/// Fits the box of the points into a picture with a margin, y up in the plane and down in the picture. The aspect is
/// kept, except that a box longer than `max_aspect` to one is stretched to that: a parabola would be a line otherwise.
class Viewport {
 public:
  static constexpr double max_aspect = 8.0;

  static constexpr int most_side = 32'000;  ///< of what Cairo draws (32767) and coordinates in single precision hold

  /// Width as given, unless the height would exceed `max_height`: then the picture gets narrower. With a `height` other
  /// than 0 the picture has just that width and height, and the box is in the middle.
  Viewport(std::span<const double> xy, int width, int max_height, int height = 0);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] double margin() const noexcept { return margin_; }

  struct Position {
    double x, y;
  };
  /// Position in the picture; not finite for a point that is not.
  [[nodiscard]] Position map(double x, double y) const noexcept { return {x_.map(x), y_.map(y)}; }

  /// All points. Single precision is 2^-12 of a pixel in the largest picture.
  [[nodiscard]] std::vector<Point2f> map_all(std::span<const double> xy) const;

 private:
  /// v -> offset + ((v * pre - origin) * first) * second. Two factors, because one alone may leave the range of double
  /// for spans near 1e-308 or 1e308; `pre` keeps the difference of coordinates near the largest double finite.
  struct Axis {
    double pre = 1.0, origin = 0.0, first = 1.0, second = 1.0, offset = 0.0;
    [[nodiscard]] double map(double v) const noexcept { return offset + (v * pre - origin) * first * second; }
  };
  static Axis make_axis(double low, double pre, double span, double pixels, double from, bool flip);

  int width_ = 1, height_ = 1;
  double margin_ = 0.0;
  Axis x_, y_;
};

}  // namespace cadt::io::picture
