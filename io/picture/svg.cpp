// SPDX-License-Identifier: Apache-2.0
// The SVG picture: a few paths, one for each colour of the ground, one for all edges, one for the hull.
#include "io/picture/colour.hpp"
#include "io/picture/measure.hpp"
#include "io/picture/scene.hpp"
#include "io/picture/sheets.hpp"
#include "io/picture/viewport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace cadt::io::picture {

namespace {

/// Two decimals: 1/100 of a user unit is far below what a screen or printer resolves. Trailing zeros are dropped.
void number(std::string& out, double v) {
  std::int64_t hundredths = std::llround(v * 100.0);
  if (hundredths < 0) {
    out += '-';
    hundredths = -hundredths;
  }
  const std::int64_t rest = hundredths % 100;
  fmt::format_to(std::back_inserter(out), "{}", hundredths / 100);
  if (rest == 0) return;
  if (rest % 10 == 0) {
    fmt::format_to(std::back_inserter(out), ".{}", rest / 10);
  } else {
    fmt::format_to(std::back_inserter(out), ".{:02}", rest);
  }
}

void point(std::string& out, char command, Point2f p) {
  out += command;
  number(out, static_cast<double>(p.x));
  out += ' ';
  number(out, static_cast<double>(p.y));
}

bool drawable(Point2f p) { return std::isfinite(p.x) && std::isfinite(p.y); }

struct Facet {
  Point2f p[3];
  float gx = 0, gy = 0;  ///< gradient of the relative height, per pixel
  float mean = 0;
  std::size_t face = 0;
};

/// The drawable triangles with their gradients.
std::vector<Facet> facets(const Scene& scene, const std::vector<Point2f>& position, const std::vector<float>& relief) {
  std::vector<Facet> out;
  out.reserve(scene.faces());
  for (std::size_t t = 0; t < scene.faces(); ++t) {
    Facet f;
    f.face = t;
    float h[3] = {0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(scene.triangles[3 * t + k]);
      f.p[k] = position[v];
      if (!relief.empty()) h[k] = relief[v];
    }
    if (!drawable(f.p[0]) || !drawable(f.p[1]) || !drawable(f.p[2])) continue;
    const float ux = f.p[1].x - f.p[0].x, uy = f.p[1].y - f.p[0].y;
    const float vx = f.p[2].x - f.p[0].x, vy = f.p[2].y - f.p[0].y;
    const float det = ux * vy - uy * vx;
    if (std::fabs(det) > 1e-6f) {
      f.gx = ((h[1] - h[0]) * vy - (h[2] - h[0]) * uy) / det;
      f.gy = ((h[2] - h[0]) * ux - (h[1] - h[0]) * vx) / det;
    }
    f.mean = (h[0] + h[1] + h[2]) / 3.0f;
    out.push_back(f);
  }
  return out;
}

void fill(std::string& out, const Scene& scene, const std::vector<Point2f>& position, float edge) {
  std::vector<float> relief = relative_heights(scene);
  show_upper_sheet(scene, relief);
  const std::vector<Facet> all = facets(scene, position, relief);
  const AreaScale area(scene, position);
  const GroundOpacity opacity(scene, position, edge);

  std::vector<float> slopes;
  for (const Facet& f : all) slopes.push_back(std::hypot(f.gx, f.gy));
  const float steep = quantile(slopes, 0.85);
  const float scale = steep > 0.0f ? 1.0f / steep : 0.0f;

  // One path for each colour. The arguments are rounded, not the bytes of the colour: those steps would change the hue.
  const auto rounded = [](float v, float steps) { return std::round(v * steps) / steps; };
  std::map<std::uint32_t, std::string> paths;
  for (const Facet& f : all) {
    Rgb colour;
    if (relief.empty()) {
      colour = size_ramp()(rounded(area(f.p[0], f.p[1], f.p[2]), 48.0f));
    } else {
      colour = terrain_ramp()(rounded(f.mean, 48.0f));
      const float light = rounded(hill_shade(scale * f.gx, scale * f.gy), 24.0f);
      colour = {colour.r * light, colour.g * light, colour.b * light};
      colour = mix(from_srgb(paper), colour, rounded(opacity(f.face), 8.0f));
    }
    std::string& path = paths[to_srgb(colour)];
    point(path, 'M', f.p[0]);
    point(path, 'L', f.p[1]);
    point(path, 'L', f.p[2]);
    path += 'z';
  }
  // The stroke in the colour of the fill closes the hairlines between anti-aliased neighbours.
  out += "<g stroke-width=\"0.6\" stroke-linejoin=\"round\">\n";
  for (const auto& [colour, path] : paths) {
    fmt::format_to(std::back_inserter(out), "<path fill=\"#{0:06x}\" stroke=\"#{0:06x}\" d=\"{1}\"/>\n", colour, path);
  }
  out += "</g>\n";
}

}  // namespace

std::string svg_text(const Scene& scene, const PictureOptions& options) {
  const Viewport view(scene.xy, options.width, options.max_height);
  const std::vector<Point2f> position = view.map_all(scene.xy);
  const float edge = edge_lengths(scene, position).median;

  std::string out;
  fmt::format_to(std::back_inserter(out),
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n"
                 "<title>{2} points, {3} triangles</title>\n"
                 "<rect width=\"100%\" height=\"100%\" fill=\"#{4:06x}\"/>\n",
                 view.width(), view.height(), scene.points(), scene.faces(), paper);

  const double stroke = std::clamp(0.045 * static_cast<double>(edge), 0.12, 1.5);
  if (scene.faces() != 0) {
    if (options.shade) fill(out, scene, position, edge);
    fmt::format_to(std::back_inserter(out),
                   "<path id=\"edges\" fill=\"none\" stroke=\"#{:06x}\" stroke-opacity=\"0.75\" "
                   "stroke-width=\"{:.2f}\" stroke-linecap=\"round\" d=\"",
                   line_colour, stroke);
    for_each_edge(scene, [&](std::size_t u, std::size_t v) {
      if (!drawable(position[u]) || !drawable(position[v])) return;
      point(out, 'M', position[u]);
      point(out, 'L', position[v]);
    });
    out += "\"/>\n";
  }
  if (!scene.hull.empty()) {
    fmt::format_to(std::back_inserter(out),
                   "<path id=\"hull\" fill=\"none\" stroke=\"#{:06x}\" stroke-width=\"{:.2f}\" "
                   "stroke-linejoin=\"round\" d=\"",
                   hull_colour, std::max(1.0, 1.8 * stroke));
    char command = 'M';
    for (const std::int32_t v : scene.hull) {
      const Point2f p = position[static_cast<std::size_t>(v)];
      if (!drawable(p)) continue;
      point(out, command, p);
      command = 'L';
    }
    out += "z\"/>\n";
  }
  // Dots where they stay apart, or where there is nothing else. A segment of no length with round caps is a disc.
  if (scene.faces() == 0 || edge > 12.0f) {
    const double diameter = scene.faces() == 0 ? 5.0 : std::clamp(0.12 * static_cast<double>(edge), 1.5, 6.0);
    fmt::format_to(std::back_inserter(out),
                   "<path id=\"points\" fill=\"none\" stroke=\"#{:06x}\" stroke-width=\"{:.2f}\" "
                   "stroke-linecap=\"round\" d=\"",
                   line_colour, diameter);
    for (const Point2f p : position) {
      if (!drawable(p)) continue;
      point(out, 'M', p);
      out += "h0";
    }
    out += "\"/>\n";
  }
  out += "</svg>\n";
  return out;
}

}  // namespace cadt::io::picture
