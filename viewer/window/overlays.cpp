// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/overlays.hpp"

#include <algorithm>
#include <cmath>

namespace cadt::viewer {
namespace {

/// What is seen.
struct Sight {
  double low[2], high[2];

  explicit Sight(const Camera& camera) {
    const auto a = camera.place(0, camera.height()), b = camera.place(camera.width(), 0);
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(a[k], b[k]);
      high[k] = std::max(a[k], b[k]);
    }
  }
  [[nodiscard]] double diagonal() const { return std::hypot(high[0] - low[0], high[1] - low[1]); }

  /// Whether some of the segment is seen.
  [[nodiscard]] bool meets(const std::array<double, 4>& s) const {
    for (std::size_t k = 0; k < 2; ++k)
      if (std::max(s[k], s[k + 2]) < low[k] || std::min(s[k], s[k + 2]) > high[k]) return false;
    // Its line has corners on both sides.
    bool left = false, right = false;
    for (const double x : {low[0], high[0]}) {
      for (const double y : {low[1], high[1]}) {
        const double side = (s[2] - s[0]) * (y - s[1]) - (s[3] - s[1]) * (x - s[0]);
        left = left || side >= 0;
        right = right || side <= 0;
      }
    }
    return left && right;
  }
};

}  // namespace

VoronoiLines voronoi_lines(std::span<const double> xy, const VoronoiDiagram& diagram, const Camera& camera,
                           std::size_t most) {
  const Sight sight(camera);
  VoronoiLines lines;
  for (std::size_t e = 0; 2 * e < diagram.edge_vertices.size(); ++e) {
    const std::int32_t from = diagram.edge_vertices[2 * e], to = diagram.edge_vertices[2 * e + 1];
    const auto vertex = [&](std::int32_t v, std::size_t k) {
      return diagram.vertices[2 * static_cast<std::size_t>(v) + k];
    };
    std::array<double, 4> s{vertex(from, 0), vertex(from, 1), 0, 0};
    if (to >= 0) {
      s[2] = vertex(to, 0);
      s[3] = vertex(to, 1);
    } else {  // a ray to the right of the line between its generators
      const auto a = static_cast<std::size_t>(diagram.edge_points[2 * e]),
                 b = static_cast<std::size_t>(diagram.edge_points[2 * e + 1]);
      const double dx = xy[2 * b + 1] - xy[2 * a + 1], dy = xy[2 * a] - xy[2 * b];
      const double length = std::hypot(dx, dy);
      const double far = sight.diagonal() + std::hypot(s[0] - 0.5 * (sight.low[0] + sight.high[0]),
                                                       s[1] - 0.5 * (sight.low[1] + sight.high[1]));
      s[2] = s[0] + dx / length * far;
      s[3] = s[1] + dy / length * far;
    }
    if (!std::all_of(s.begin(), s.end(), [](double v) { return std::isfinite(v); }) || !sight.meets(s)) continue;
    if (++lines.in_view <= most) lines.segments.push_back(s);
  }
  if (lines.in_view > most) lines.segments.clear();
  return lines;
}

}  // namespace cadt::viewer
