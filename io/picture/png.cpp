// SPDX-License-Identifier: Apache-2.0
// The PNG picture: ground by own rasteriser, edges by Cairo or as density.
#include "io/picture/canvas.hpp"
#include "io/picture/colour.hpp"
#include "io/picture/field.hpp"
#include "io/picture/measure.hpp"
#include "io/picture/scene.hpp"
#include "io/picture/sheets.hpp"
#include "io/picture/viewport.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cadt::io::picture {

namespace {

/// Edges are strokes where they can be told apart, and Cairo's time per stroke is bearable.
constexpr float least_stroked_edge = 3.0f;
constexpr std::size_t most_stroked_faces = 400'000;
constexpr double most_stroked_ink = 1.5;  // pixels of edge for each pixel of the picture

struct Drawing {
  const Scene& scene;
  std::vector<Point2f> position;
  std::vector<float> relief;  ///< relative heights, empty: colour by area
  float edge;                 ///< median edge, pixels
};

Field make_ground(const Drawing& d, int width, int height) {
  const AreaScale area(d.scene, d.position);
  const GroundOpacity opacity(d.scene, d.position, d.edge);
  Field field(width, height);
  for (std::size_t t = 0; t < d.scene.faces(); ++t) {
    Point2f p[3];
    float value[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(d.scene.triangles[3 * t + k]);
      p[k] = d.position[v];
      if (!d.relief.empty()) value[k] = d.relief[v];
    }
    float solid = 1.0f;
    if (d.relief.empty()) {
      value[0] = value[1] = value[2] = area(p[0], p[1], p[2]);
    } else {
      solid = opacity(t);
    }
    field.add(p, value, solid);
  }
  field.finish();
  return field;
}

/// Factor that makes the 85 % quantile of the slopes one in one: data in metres over degrees and the reverse both get
/// light and shade.
float exaggeration(const Field& field) {
  std::vector<float> slopes;
  const int step = 1 + std::max(field.width(), field.height()) / 400;
  for (int y = 0; y < field.height(); y += step) {
    for (int x = 0; x < field.width(); x += step) {
      const auto i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(field.width()) + static_cast<std::size_t>(x);
      if (!field.covered(i) || field.opacity(i) < 0.9f) continue;
      const auto [gx, gy] = field.gradient(x, y);
      slopes.push_back(std::hypot(gx, gy));
    }
  }
  const float steep = quantile(slopes, 0.85);
  return steep > 0.0f ? 1.0f / steep : 1.0f;
}

void paint_ground(const Field& field, bool relief, Canvas& canvas) {
  const Rgb blank = from_srgb(paper);
  const float scale = relief ? exaggeration(field) : 0.0f;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const auto i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(field.width()) + static_cast<std::size_t>(x);
      if (!field.covered(i)) continue;
      Rgb colour = relief ? terrain_ramp()(field.value(i)) : size_ramp()(field.value(i));
      if (relief) {
        const auto [gx, gy] = field.gradient(x, y);
        const float light = hill_shade(scale * gx, scale * gy);
        colour = {colour.r * light, colour.g * light, colour.b * light};
      }
      canvas.set(x, y, to_srgb(mix(blank, colour, field.opacity(i))));
    }
  }
}

/// Over a relief, edges show only where single ones can be seen: elsewhere they would be a grey veil.
void ink_over_relief(const Ink& ink, Canvas& canvas) {
  const std::vector<float> around = ink.blurred(4);
  const Rgb dark = from_srgb(line_colour);
  for (std::size_t i = 0; i < around.size(); ++i) {
    const float amount = ink.amounts()[i];
    if (amount <= 0.0f) continue;
    const float crowd = around[i] / 0.25f;
    const float alpha = 0.45f * std::min(amount, 1.0f) / (1.0f + crowd * crowd * crowd);
    canvas.blend(i, dark, alpha);
  }
}

/// Without heights the density itself is the picture, on a log scale up to the 99.9 % quantile.
void ink_as_density(const Ink& ink, const Field* ground, Canvas& canvas) {
  constexpr float lift = 4.0f;  // a lone edge must be visible beside a cluster of thousands
  std::vector<float> used;
  for (const float a : ink.amounts()) {
    if (a > 0.0f) used.push_back(a);
  }
  const float top = std::log1p(lift * std::max(quantile(used, 0.999), 8.0f));
  for (std::size_t i = 0; i < ink.amounts().size(); ++i) {
    const float amount = ink.amounts()[i];
    const bool inside = ground != nullptr && ground->covered(i);
    if (!inside && amount <= 0.0f) continue;
    const float t = std::log1p(lift * amount) / top;
    const Rgb colour = ink_ramp()(t);
    // Outside, anti-aliased borders fade into the paper.
    canvas.blend(i, colour, inside ? 1.0f : std::min(1.0f, amount));
  }
}

void draw_points(const Drawing& d, Canvas& canvas) {
  constexpr std::size_t most_discs = 20'000;
  if (d.position.size() <= most_discs) {
    const double radius = std::clamp(60.0 / std::sqrt(static_cast<double>(d.position.size()) + 1.0), 1.0, 4.0);
    canvas.discs(d.position, radius, line_colour);
    return;
  }
  Ink ink(canvas.width(), canvas.height());
  for (const Point2f p : d.position) ink.dot(p);
  ink_as_density(ink, nullptr, canvas);
}

}  // namespace

std::string png_bytes(const Scene& scene, const PictureOptions& options) {
  const Viewport view(scene.xy, options.width, options.max_height);
  Canvas canvas(view.width(), view.height(), paper);
  Drawing d{scene, view.map_all(scene.xy), {}, 0.0f};
  if (scene.faces() == 0) {
    draw_points(d, canvas);
    return canvas.png();
  }
  const EdgeLengths edges = edge_lengths(scene, d.position);
  d.edge = edges.median;
  if (options.shade) d.relief = relative_heights(scene);
  show_upper_sheet(scene, d.relief);
  const bool relief = !d.relief.empty();
  const double room = most_stroked_ink * static_cast<double>(view.width()) * static_cast<double>(view.height());
  const bool stroked = d.edge >= least_stroked_edge && scene.faces() <= most_stroked_faces && edges.total <= room;

  if (stroked) {
    if (options.shade) paint_ground(make_ground(d, view.width(), view.height()), relief, canvas);
    const double width = std::clamp(0.05 * static_cast<double>(d.edge), 0.45, 1.3);
    // Fine meshes over a relief get fainter lines, or the shading would drown.
    const double alpha = relief ? std::clamp(0.02 * static_cast<double>(d.edge), 0.12, 0.6) : 0.8;
    canvas.edges(scene, d.position, width, line_colour, alpha);
    canvas.loop(scene.hull, d.position, std::max(1.2, 1.8 * width), hull_colour);
    return canvas.png();
  }

  const Field ground = make_ground(d, view.width(), view.height());
  const Ink ink = edge_ink(scene, d.position, view.width(), view.height());
  if (relief) {
    paint_ground(ground, true, canvas);
    ink_over_relief(ink, canvas);
  } else {
    ink_as_density(ink, &ground, canvas);
  }
  // A hull of a million points is no line any more; its edges are in the density.
  if (scene.hull.size() <= 100'000) canvas.loop(scene.hull, d.position, 1.2, hull_colour);
  return canvas.png();
}

}  // namespace cadt::io::picture
