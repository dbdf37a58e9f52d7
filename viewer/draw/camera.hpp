// SPDX-License-Identifier: Apache-2.0
// From the plane to the picture, for coordinates of any size: y up in the plane, down in the picture.
#pragma once

#include <array>
#include <span>

namespace cadt::viewer {

/// The box of the points. Empty: low > high.
struct Extent {
  std::array<double, 2> low{1, 1}, high{0, 0};
  [[nodiscard]] bool empty() const noexcept { return low[0] > high[0]; }
  bool operator==(const Extent&) const = default;
};
/// Of interleaved coordinates; those that are not finite are left out.
[[nodiscard]] Extent box_of(std::span<const double> xy);

/// One axis: v -> ((v * before - origin) * first) * second, in pixels from the upper left. Two factors, because one may
/// leave the range of double for spans near 1e-308 or 1e308; `before` keeps differences near the largest double finite.
struct Axis {
  double origin = 0, first = 1, second = 1;
};

/// What of the plane is seen. The middle of the picture is `middle`, a pixel is 1 / scale wide.
class Camera {
 public:
  /// A box longer than `longest_aspect` to one is stretched to that: a parabola would be a line otherwise.
  static constexpr double longest_aspect = 8.0;

  Camera() = default;
  /// The whole box in a picture of so many pixels, with a margin.
  Camera(const Extent& box, int width, int height);
  /// Height of a picture of this width that the box fills, between 8 and `most`.
  [[nodiscard]] static int height_for(const Extent& box, int width, int most);

  void resize(int width, int height);
  /// Moves what is seen by so many pixels, x right and y down; the middle stays within the box.
  void pan(double dx, double dy);
  static constexpr double least_magnification = 1.0 / 16;
  /// Makes everything `factor` times as large; the place at pixel (x, y) stays. Between least_magnification and the
  /// size at which coordinates differ by a tenth of a pixel.
  void zoom(double factor, double x, double y);
  /// Moves the place to the middle, also one outside of the box.
  void look_at(double x, double y);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  /// How many times larger than fitted.
  [[nodiscard]] double magnification() const noexcept { return magnification_; }
  [[nodiscard]] double before() const noexcept { return before_; }
  [[nodiscard]] Axis axis(int k) const noexcept;
  /// The place at a pixel.
  [[nodiscard]] std::array<double, 2> place(double x, double y) const noexcept;
  /// The pixel of a place.
  [[nodiscard]] std::array<double, 2> pixel(double x, double y) const noexcept;
  /// Pixels of a unit of the plane along x; may be inf or 0 for units out of range.
  [[nodiscard]] double scale() const noexcept;

 private:
  void limit();
  Extent box_;
  int width_ = 1, height_ = 1;
  double before_ = 1, magnification_ = 1;
  std::array<double, 2> middle_{0, 0};                ///< times before_
  std::array<double, 2> first_{1, 1}, fitted_{1, 1};  ///< factors of the fitted view; y's are negative
};

}  // namespace cadt::viewer
