// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/grid/pixel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cadt::constraints {
namespace {

using exact::Line;
using exact::Number;
using exact::Point;

constexpr std::size_t leaf = 8;

/// Below this halves of a width, and of a last place beside it, need not be doubles: filters do not decide.
constexpr double least_width = 0x1p-1000;

/// floor(v / width + 1/2) from a coordinate that is off by half a unit in the last place: v / width is off by 2
/// roundings and the sum by one. False if a whole number is that near.
bool pixel_filter(double v, double width, std::int64_t& pixel) {
  if (width < least_width) return false;
  const double quotient = v / width, moved = quotient + 0.5, floor = std::floor(moved);
  const double margin = 0x1p-50 * (std::abs(quotient) + 1);
  if (!(moved - floor > margin && floor + 1 - moved > margin)) return false;
  pixel = static_cast<std::int64_t>(floor);
  return true;
}

std::int64_t pixel_exact(const Number& v, const Number& w, double width, exact::Arena& arena) {
  const exact::Arithmetic of(arena);
  const Number one = of.multiply(of.number(width), w);
  const Number dividend = of.add(of.add(v, v), one);
  return exact::floor_quotient(dividend, of.add(one, one), arena);
}

/// An odd multiple of half the width: a side of pixels, from its double and exactly.
struct Side {
  double odd;  // below 2^53
  double rounded, error;

  Side(std::int64_t pixel, int direction, double width)
      : odd(static_cast<double>(2 * pixel + direction)),
        rounded(odd * (0.5 * width)),
        error(std::abs(rounded) * 0x1p-52) {
    if (width < least_width) error = std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] Number exact(double width, const exact::Arithmetic& of) const {
    return of.multiply(of.multiply(of.number(odd), of.number(0.5)), of.number(width));
  }
};

/// The sign of v - side.
int compare(double v, const Side& side, double width) {
  if (std::abs(v - side.rounded) > 2 * side.error) return v < side.rounded ? -1 : 1;
  exact::Arena arena;
  const exact::Arithmetic of(arena);
  return exact::compare(of.number(v), side.exact(width, of));
}

/// Positive if the corner is left of the segment.
int orientation(const Line& s, const Side& x, const Side& y, double width) {
  const double ux = s.b.x - s.a.x, uy = s.b.y - s.a.y, vx = x.rounded - s.a.x, vy = y.rounded - s.a.y;
  const double left = ux * vy, right = uy * vx, det = left - right;
  const double bound =
      0x1p-49 * (std::abs(left) + std::abs(right)) + 2 * (std::abs(ux) * y.error + std::abs(uy) * x.error);
  if (std::abs(det) > bound && bound > 0x1p-900 && bound < 0x1p1000) return det > 0 ? 1 : -1;
  exact::Arena arena;
  const exact::Arithmetic of(arena);
  const Number ax = of.number(s.a.x), ay = of.number(s.a.y);
  const Number dx = of.subtract(of.number(s.b.x), ax), dy = of.subtract(of.number(s.b.y), ay);
  const Number cx = of.subtract(x.exact(width, of), ax), cy = of.subtract(y.exact(width, of), ay);
  return exact::compare(of.multiply(dx, cy), of.multiply(dy, cx));
}

}  // namespace

Pixel PixelGrid::pixel_of(const exact::Place& p, const exact::ImplicitPoints& points) const {
  Pixel pixel{};
  const bool x = pixel_filter(p.x, width_, pixel.x), y = pixel_filter(p.y, width_, pixel.y);
  if (x && y) return pixel;
  exact::Arena arena;
  const exact::Homogeneous h = points.homogeneous(p, arena);
  if (!x) pixel.x = pixel_exact(h.x, h.w, width_, arena);
  if (!y) pixel.y = pixel_exact(h.y, h.w, width_, arena);
  return pixel;
}

// Two convex sets are apart if their shadows on a line are: on the axes, and across the segment. The sides at the right
// and at the top are no part of the pixel, as if they were moved inwards by less than any number: a corner there that
// is on the line of the segment is on the inner side of it.
bool PixelGrid::passes(const Line& s, const Pixel& pixel) const {
  const Side left(pixel.x, -1, width_), right(pixel.x, 1, width_), bottom(pixel.y, -1, width_), top(pixel.y, 1, width_);
  if (compare(s.a.x, right, width_) >= 0 || compare(s.b.x, left, width_) < 0) return false;
  if (compare(std::min(s.a.y, s.b.y), top, width_) >= 0 || compare(std::max(s.a.y, s.b.y), bottom, width_) < 0)
    return false;
  if (s.a.x == s.b.x || s.a.y == s.b.y) return true;
  if (s.a.y < s.b.y) return orientation(s, left, top, width_) > 0 && orientation(s, right, bottom, width_) < 0;
  return orientation(s, left, bottom, width_) <= 0 && orientation(s, right, top, width_) > 0;
}

PixelTree::PixelTree(const PixelGrid& grid, const std::vector<Pixel>& pixels)
    : grid_(grid), pixels_(pixels), order_(pixels.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!pixels.empty()) build(1, 0, pixels.size(), true);
}

void PixelTree::build(std::size_t node, std::size_t first, std::size_t last, bool by_x) {
  if (boxes_.size() <= node) boxes_.resize(2 * node + 2);
  Pixel low = pixels_[static_cast<std::size_t>(order_[first])], high = low;
  for (std::size_t i = first; i < last; ++i) {
    const Pixel& p = pixels_[static_cast<std::size_t>(order_[i])];
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto side = [&](std::int64_t pixel, double direction) {  // more than a rounding farther out
    const double k = static_cast<double>(pixel) + direction;
    return (k + direction * 0x1p-48 * (std::abs(k) + 1)) * grid_.width();
  };
  boxes_[node] = {side(low.x, -0.5), side(low.y, -0.5), side(high.x, 0.5), side(high.y, 0.5)};
  if (last - first <= leaf) return;
  const std::size_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                   order_.begin() + static_cast<std::ptrdiff_t>(middle),
                   order_.begin() + static_cast<std::ptrdiff_t>(last), [&](std::int32_t a, std::int32_t b) {
                     const Pixel &p = pixels_[static_cast<std::size_t>(a)], &q = pixels_[static_cast<std::size_t>(b)];
                     return by_x ? p < q : (p.y != q.y ? p.y < q.y : p.x < q.x);
                   });
  build(2 * node, first, middle, !by_x);
  build(2 * node + 1, middle, last, !by_x);
}

void PixelTree::find(const Line& segment, std::vector<std::int32_t>& passed) const {
  passed.clear();
  if (!pixels_.empty()) find(1, 0, pixels_.size(), segment, passed);
  // A segment runs through columns from left to right, and through the pixels of one in its direction.
  const bool up = segment.a.y <= segment.b.y;
  std::sort(passed.begin(), passed.end(), [&](std::int32_t a, std::int32_t b) {
    const Pixel &p = pixels_[static_cast<std::size_t>(a)], &q = pixels_[static_cast<std::size_t>(b)];
    if (p.x != q.x) return p.x < q.x;
    return up ? p.y < q.y : p.y > q.y;
  });
}

void PixelTree::find(std::size_t node, std::size_t first, std::size_t last, const Line& s,
                     std::vector<std::int32_t>& passed) const {
  const Box& box = boxes_[node];
  if (s.a.x > box.right || s.b.x < box.left) return;
  if (std::min(s.a.y, s.b.y) > box.top || std::max(s.a.y, s.b.y) < box.bottom) return;
  // The box is on one side of the line, for certain: each product of differences is off by 4 roundings at most, and by
  // less than 2^-1000 where it underflows.
  const double ux = s.b.x - s.a.x, uy = s.b.y - s.a.y;
  bool above = true, below = true;
  for (const double x : {box.left, box.right})
    for (const double y : {box.bottom, box.top}) {
      const double p = ux * (y - s.a.y), q = uy * (x - s.a.x);
      const double bound = 0x1p-50 * (std::abs(p) + std::abs(q)) + 0x1p-1000;
      above = above && p - q > bound;
      below = below && p - q < -bound;
    }
  if (above || below) return;
  if (last - first <= leaf) {
    for (std::size_t i = first; i < last; ++i)
      if (grid_.passes(s, pixels_[static_cast<std::size_t>(order_[i])])) passed.push_back(order_[i]);
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  find(2 * node, first, middle, s, passed);
  find(2 * node + 1, middle, last, s, passed);
}

}  // namespace cadt::constraints
