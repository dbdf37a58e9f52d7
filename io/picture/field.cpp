// SPDX-License-Identifier: Apache-2.0
#include "io/picture/field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cadt::io::picture {

namespace {

std::size_t pixels(int width, int height) { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

/// x of the segment a-b at the height y. \pre a.y < b.y
float cut(Point2f a, Point2f b, float y) { return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)); }

}  // namespace

Field::Field(int width, int height)
    : width_(width),
      height_(height),
      weight_(pixels(width, height)),
      value_(pixels(width, height)),
      opacity_(pixels(width, height)) {}

void Field::add(const Point2f (&p)[3], const float (&value)[3], float opacity) {
  const float cx = (p[0].x + p[1].x + p[2].x) / 3.0f;
  const float cy = (p[0].y + p[1].y + p[2].y) / 3.0f;
  if (!(cx >= 0.0f && cy >= 0.0f && cx < static_cast<float>(width_) && cy < static_cast<float>(height_))) return;

  const float ux = p[1].x - p[0].x, uy = p[1].y - p[0].y;
  const float vx = p[2].x - p[0].x, vy = p[2].y - p[0].y;
  const float det = ux * vy - uy * vx;
  const float area = 0.5f * std::fabs(det);
  const float mean = (value[0] + value[1] + value[2]) / 3.0f;
  if (area < 1.0f) {
    const auto i = static_cast<std::size_t>(cy) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(cx);
    splat(i, std::max(area, 1e-6f), mean, opacity);
  }

  const Point2f* a = &p[0];
  const Point2f* b = &p[1];
  const Point2f* c = &p[2];
  if (b->y < a->y) std::swap(a, b);
  if (c->y < b->y) std::swap(b, c);
  if (b->y < a->y) std::swap(a, b);
  const float rows = c->y - a->y;
  // Triangles do not overlap, so the rows with at least 1/16 pixel each number at most 16 times the pixels. Thinner
  // ones hit hardly a pixel centre, but a million of them across the picture would take a row of work per row each.
  if (rows > 4.0f && area < rows / 16.0f) return;

  const float gx = det != 0.0f ? ((value[1] - value[0]) * vy - (value[2] - value[0]) * uy) / det : 0.0f;
  const float gy = det != 0.0f ? ((value[2] - value[0]) * ux - (value[1] - value[0]) * vx) / det : 0.0f;
  const float low = std::min({value[0], value[1], value[2]});
  const float high = std::max({value[0], value[1], value[2]});
  const int y0 = std::max(0, static_cast<int>(std::ceil(a->y - 0.5f)));
  const int y1 = std::min(height_ - 1, static_cast<int>(std::ceil(c->y - 0.5f)) - 1);
  for (int y = y0; y <= y1; ++y) {
    const float centre = static_cast<float>(y) + 0.5f;
    float left = cut(*a, *c, centre);
    float right = centre < b->y ? cut(*a, *b, centre) : b->y < c->y ? cut(*b, *c, centre) : b->x;
    if (left > right) std::swap(left, right);
    const int x0 = std::max(0, static_cast<int>(std::ceil(left - 0.5f)));
    const int x1 = std::min(width_ - 1, static_cast<int>(std::ceil(right - 0.5f)) - 1);
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = x0; x <= x1; ++x) {
      const float v = value[0] + gx * (static_cast<float>(x) + 0.5f - p[0].x) + gy * (centre - p[0].y);
      splat(row + static_cast<std::size_t>(x), 1.0f, std::clamp(v, low, high), opacity);
    }
  }
}

void Field::finish() {
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    if (weight_[i] <= 0.0f) continue;
    value_[i] /= weight_[i];
    opacity_[i] /= weight_[i];
  }
  std::vector<std::pair<std::size_t, std::pair<float, float>>> holes;
  for (int y = 1; y + 1 < height_; ++y) {
    for (int x = 1; x + 1 < width_; ++x) {
      const std::size_t i = pixels(width_, y) + static_cast<std::size_t>(x);
      if (weight_[i] > 0.0f) continue;
      float sum = 0.0f, see = 0.0f;
      int count = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const std::size_t j = pixels(width_, y + dy) + static_cast<std::size_t>(x + dx);
          if (weight_[j] <= 0.0f) continue;
          sum += value_[j];
          see += opacity_[j];
          ++count;
        }
      }
      // Six of eight: a hole inside, not the outside of an edge.
      if (count >= 6) holes.push_back({i, {sum / static_cast<float>(count), see / static_cast<float>(count)}});
    }
  }
  for (const auto& [i, filling] : holes) {
    weight_[i] = 1.0f;
    value_[i] = filling.first;
    opacity_[i] = filling.second;
  }
}

Field::Gradient Field::gradient(int x, int y) const {
  const auto slope = [&](int dx, int dy) {
    const auto at = [&](int s) -> std::size_t {
      const int u = std::clamp(x + s * dx, 0, width_ - 1);
      const int v = std::clamp(y + s * dy, 0, height_ - 1);
      return pixels(width_, v) + static_cast<std::size_t>(u);
    };
    std::size_t before = at(-1), after = at(1);
    float steps = 2.0f;
    if (!covered(before)) before = at(0), steps -= 1.0f;
    if (!covered(after)) after = at(0), steps -= 1.0f;
    return steps > 0.0f ? (value_[after] - value_[before]) / steps : 0.0f;
  };
  return {slope(1, 0), slope(0, 1)};
}

Ink::Ink(int width, int height) : width_(width), height_(height), amount_(pixels(width, height)) {}

void Ink::line(Point2f a, Point2f b, int stride, std::uint32_t key) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const bool steep = std::fabs(dy) > std::fabs(dx);
  const float major = steep ? std::fabs(dy) : std::fabs(dx);
  const float length = std::hypot(dx, dy);
  if (!(major >= 0.0f && major < 1e6f)) return;  // not finite
  const int steps = std::max(1, static_cast<int>(std::lround(major)));
  const float share = length / static_cast<float>(steps) * static_cast<float>(stride);
  // Mixed key: neighbouring edges must not leave out the same columns.
  const int phase = stride == 1 ? 0 : static_cast<int>((key * 2654435761u >> 8) % static_cast<std::uint32_t>(stride));
  for (int i = phase; i < steps; i += stride) {
    const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(steps);
    const float x = a.x + t * dx, y = a.y + t * dy;
    // Linear split between the two pixels across the line.
    const float across = (steep ? x : y) - 0.5f;
    const float base = std::floor(across);
    const float upper = across - base;
    const int j = static_cast<int>(base);
    if (steep) {
      const int row = static_cast<int>(std::floor(y));
      put(j, row, share * (1.0f - upper));
      put(j + 1, row, share * upper);
    } else {
      const int column = static_cast<int>(std::floor(x));
      put(column, j, share * (1.0f - upper));
      put(column, j + 1, share * upper);
    }
  }
}

void Ink::dot(Point2f p) {
  if (!(std::fabs(p.x) < 1e6f && std::fabs(p.y) < 1e6f)) return;
  const float fx = std::floor(p.x - 0.5f), fy = std::floor(p.y - 0.5f);
  const float s = p.x - 0.5f - fx, t = p.y - 0.5f - fy;
  const int x = static_cast<int>(fx), y = static_cast<int>(fy);
  put(x, y, (1.0f - s) * (1.0f - t));
  put(x + 1, y, s * (1.0f - t));
  put(x, y + 1, (1.0f - s) * t);
  put(x + 1, y + 1, s * t);
}

std::vector<float> Ink::blurred(int r) const {
  const auto pass = [&](const std::vector<float>& in, bool across) {
    std::vector<float> out(in.size());
    const int lines = across ? height_ : width_;
    const int length = across ? width_ : height_;
    const auto at = [&](int line, int k) {
      return across ? pixels(width_, line) + static_cast<std::size_t>(k)
                    : pixels(width_, k) + static_cast<std::size_t>(line);
    };
    for (int line = 0; line < lines; ++line) {
      double sum = 0.0;  // running sum: floats would drift after a pixel with much ink
      for (int k = -r; k < length; ++k) {
        if (k + r < length) sum += static_cast<double>(in[at(line, k + r)]);
        if (k - r - 1 >= 0) sum -= static_cast<double>(in[at(line, k - r - 1)]);
        if (k >= 0) out[at(line, k)] = static_cast<float>(sum / (2.0 * r + 1.0));
      }
    }
    return out;
  };
  return pass(pass(amount_, true), false);
}

Ink edge_ink(const Scene& scene, std::span<const Point2f> position, int width, int height) {
  double steps = 0.0;
  std::size_t edges = 0;
  const auto reach = [&](std::size_t u, std::size_t v) {
    return std::max(std::fabs(position[u].x - position[v].x), std::fabs(position[u].y - position[v].y));
  };
  for_each_edge(scene, [&](std::size_t u, std::size_t v) {
    const float d = reach(u, v);
    if (std::isfinite(d)) steps += static_cast<double>(d);
    ++edges;
  });
  const double budget = 16.0 * static_cast<double>(pixels(width, height)) + 4.0 * static_cast<double>(edges) + 1e6;
  const int stride = static_cast<int>(std::clamp(std::ceil(steps / budget), 1.0, 1e6));

  Ink ink(width, height);
  std::uint32_t key = 0;
  // Short edges are always taken whole: they are cheap, and all that the picture has of dense places.
  for_each_edge(scene, [&](std::size_t u, std::size_t v) {
    const bool is_short = reach(u, v) < 4.0f;
    ink.line(position[u], position[v], is_short ? 1 : stride, ++key);
  });
  return ink;
}

}  // namespace cadt::io::picture
