// SPDX-License-Identifier: Apache-2.0
// What boundaries between labels have to be, edge by edge.
#pragma once

#include <cadt/label_image.hpp>

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace cadt::test {

/// A side of a pixel: where it starts, whether it is horizontal, and the labels above and below, or right and left.
using UnitEdges = std::map<std::array<int, 3>, std::array<std::int32_t, 2>>;

/// All sides of pixels between different labels.
inline UnitEdges unit_edges(std::span<const std::int32_t> labels, int width, int height) {
  const auto at = [&](int x, int y) {  // y up
    const bool inside = x >= 0 && x < width && y >= 0 && y < height;
    return inside ? labels[static_cast<std::size_t>((height - 1 - y) * width + x)] : outside_label;
  };
  UnitEdges edges;
  for (int y = 0; y <= height; ++y) {
    for (int x = 0; x <= width; ++x) {
      if (x < width && at(x, y) != at(x, y - 1)) edges[{x, y, 1}] = {at(x, y), at(x, y - 1)};
      if (y < height && at(x, y) != at(x - 1, y)) edges[{x, y, 0}] = {at(x, y), at(x - 1, y)};
    }
  }
  return edges;
}

/// "" if the segments are exactly these sides, joined as far as can be; else what is wrong.
inline std::string why_wrong(std::span<const std::int32_t> labels, std::size_t width, std::size_t height,
                             const LabelSegments& found) {
  UnitEdges left = unit_edges(labels, static_cast<int>(width), static_cast<int>(height));
  if (found.sides.size() != found.segments.size()) return "sides are missing";
  std::map<std::array<double, 2>, int> places;
  for (std::size_t i = 0; i < found.xy.size(); i += 2) {
    if (++places[{found.xy[i], found.xy[i + 1]}] > 1) return "a corner twice";
  }
  std::vector<std::vector<std::array<double, 2>>> directions(found.xy.size() / 2);
  for (std::size_t s = 0; s < found.segments.size(); ++s) {
    const auto from = static_cast<std::size_t>(found.segments[s][0]),
               to = static_cast<std::size_t>(found.segments[s][1]);
    if (from >= found.xy.size() / 2 || to >= found.xy.size() / 2) return "an end out of range";
    const double dx = found.xy[2 * to] - found.xy[2 * from], dy = found.xy[2 * to + 1] - found.xy[2 * from + 1];
    if (!((dx > 0 && dy == 0) || (dx == 0 && dy < 0))) return "a segment neither rightwards nor downwards";
    const double length = std::abs(dx) + std::abs(dy);
    directions[from].push_back({dx / length, dy / length});
    directions[to].push_back({-dx / length, -dy / length});
    for (int step = 0; step < static_cast<int>(length); ++step) {
      const bool horizontal = dx > 0;
      const int x = static_cast<int>(found.xy[2 * from]) + (horizontal ? step : 0);
      const int y = static_cast<int>(found.xy[2 * from + 1]) - (horizontal ? 0 : step + 1);
      const auto side = left.find({x, y, horizontal ? 1 : 0});
      if (side == left.end()) return "a side between equal labels, or twice";
      if (side->second != found.sides[s]) return "wrong labels beside a segment";
      left.erase(side);
    }
  }
  if (!left.empty()) return "a side is missing";
  for (const auto& around : directions) {
    if (around.size() < 2) return "a corner with one segment or none";
    if (around.size() == 2 && around[0][0] == -around[1][0] && around[0][1] == -around[1][1])
      return "a corner where nothing turns";
  }
  return "";
}

}  // namespace cadt::test
