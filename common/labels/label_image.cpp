// SPDX-License-Identifier: Apache-2.0
// Boundaries between the labels of an image, in one pass over the corners of its pixels.
#include <cadt/label_image.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace cadt {
namespace {

/// The labels of an image; those around it are outside_label.
class Pixels {
 public:
  Pixels(std::span<const std::int32_t> labels, std::size_t width, std::size_t height)
      : labels_(labels), width_(width), height_(height) {
    // The product could overflow.
    if (width == 0 || height == 0 || labels.size() / width != height || labels.size() % width != 0) {
      throw InputError("there are " + std::to_string(labels.size()) + " labels for " + std::to_string(width) + " x " +
                           std::to_string(height) + " pixels: give each pixel one, and at least one pixel",
                       0);
    }
  }
  /// Pixels with x or y -1, or behind the last, are outside.
  [[nodiscard]] std::int32_t at(std::size_t x, std::size_t y) const noexcept {
    return x < width_ && y < height_ ? labels_[y * width_ + x] : outside_label;
  }
  [[nodiscard]] std::size_t width() const noexcept { return width_; }
  [[nodiscard]] std::size_t height() const noexcept { return height_; }

 private:
  std::span<const std::int32_t> labels_;
  std::size_t width_, height_;
};

void require_labels(std::span<const std::int32_t> labels) {
  const auto bad = std::find(labels.begin(), labels.end(), outside_label);
  if (bad == labels.end()) return;
  throw InputError("a pixel has the label " + std::to_string(outside_label) +
                       ", which stands for the outside of the image: give it another one",
                   static_cast<std::size_t>(bad - labels.begin()));
}

/// Infinite if the sum is no double: on the same side of an image as the mean.
double mean(const std::array<double, 3>& of) { return (of[0] + of[1] + of[2]) / 3; }

}  // namespace

LabelSegments label_segments(std::span<const std::int32_t> labels, std::size_t width, std::size_t height) {
  const Pixels pixels(labels, width, height);
  require_labels(labels);
  LabelSegments result;
  std::vector<std::int32_t> above(width + 1);  // the last corner on the boundary that comes down in each column
  for (std::size_t row = 0; row <= height; ++row) {
    std::int32_t before = 0;  // the last corner on the boundary that comes from the left
    for (std::size_t column = 0; column <= width; ++column) {
      //    north west | north east      Boundaries leave a corner to the left, right, up and down,
      //    -----------+-----------      each between two of the four pixels around it.
      //    south west | south east
      const std::int32_t north_west = pixels.at(column - 1, row - 1), north_east = pixels.at(column, row - 1);
      const std::int32_t south_west = pixels.at(column - 1, row), south_east = pixels.at(column, row);
      const bool left = north_west != south_west, right = north_east != south_east;
      const bool up = north_west != north_east, down = south_west != south_east;
      const bool straight = left == right && up == down && left != up;
      if (straight || !(left || right || up || down)) continue;

      const std::size_t corners = result.xy.size() / 2;
      constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
      if (corners >= most) throw LimitError("the boundaries have too many corners", corners, most);
      const auto here = static_cast<std::int32_t>(corners);
      result.xy.push_back(static_cast<double>(column));
      result.xy.push_back(static_cast<double>(height - row));
      if (left) {
        result.segments.push_back({before, here});
        result.sides.push_back({north_west, south_west});
      }
      if (up) {
        result.segments.push_back({above[column], here});
        result.sides.push_back({north_east, north_west});
      }
      if (right) before = here;
      if (down) above[column] = here;
    }
  }
  return result;
}

std::vector<std::int32_t> triangle_labels(std::span<const double> xy, std::span<const std::int32_t> triangles,
                                          std::span<const std::int32_t> labels, std::size_t width, std::size_t height) {
  if (xy.size() % 2 != 0)
    throw InputError("points have two coordinates each, these have " + std::to_string(xy.size()) + " in all",
                     xy.size() / 2);
  if (triangles.size() % 3 != 0)
    throw InputError("triangles have three points each, these have " + std::to_string(triangles.size()) + " in all",
                     triangles.size() / 3);
  const Pixels pixels(labels, width, height);
  require_labels(labels);
  // A centroid on the border, or beyond it by rounding, belongs to the next pixel.
  const auto pixel = [](double at, std::size_t size) {
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(size - 1)));
  };
  std::vector<std::int32_t> result;
  result.reserve(triangles.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    std::array<double, 3> x{}, y{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t corner = triangles[t + k];
      const auto vertex = static_cast<std::size_t>(corner);
      if (corner < 0 || vertex >= xy.size() / 2) {
        throw InputError("a triangle has the corner " + std::to_string(corner) + ", and there are " +
                             std::to_string(xy.size() / 2) + " points",
                         t / 3);
      }
      x[k] = xy[2 * vertex];
      y[k] = xy[2 * vertex + 1];
      if (!std::isfinite(x[k]) || !std::isfinite(y[k]))
        throw InputError("a triangle has a corner that is not finite", t / 3);
    }
    result.push_back(pixels.at(pixel(mean(x), width), pixel(static_cast<double>(height) - mean(y), height)));
  }
  return result;
}

}  // namespace cadt
