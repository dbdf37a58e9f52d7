// SPDX-License-Identifier: Apache-2.0
// Small meshes, drawn by Cairo: SVG, PDF and PNG from one drawing.
#include "io/picture/colour.hpp"
#include "io/picture/measure.hpp"
#include "io/picture/png.hpp"
#include "io/picture/scene.hpp"
#include "io/picture/sheets.hpp"
#include "io/picture/viewport.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace cadt::io::picture {
namespace {

struct SurfaceDeleter {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};
struct ContextDeleter {
  void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Context = std::unique_ptr<cairo_t, ContextDeleter>;

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) throw InternalError(std::string("Cairo: ") + cairo_status_to_string(status));
}

void set_colour(cairo_t* to, std::uint32_t rgb, double alpha = 1.0) {
  cairo_set_source_rgba(to, ((rgb >> 16) & 255u) / 255.0, ((rgb >> 8) & 255u) / 255.0, (rgb & 255u) / 255.0, alpha);
}

bool drawable(Point2f p) { return std::isfinite(p.x) && std::isfinite(p.y); }
void move_to(cairo_t* to, Point2f p) { cairo_move_to(to, static_cast<double>(p.x), static_cast<double>(p.y)); }
void line_to(cairo_t* to, Point2f p) { cairo_line_to(to, static_cast<double>(p.x), static_cast<double>(p.y)); }

/// Cairo intersects all segments of a path with each other when it fills pixels: a few hundred at a time keep that
/// linear in total. Files keep them in one path.
constexpr std::size_t batch = 256;

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

/// Triangles by colour. The arguments of the ramps are rounded, not the bytes: those steps would change the hue.
std::map<std::uint32_t, std::vector<Facet>> by_colour(const Scene& scene, const std::vector<Point2f>& position,
                                                      float edge) {
  std::vector<float> relief = relative_heights(scene);
  show_upper_sheet(scene, relief);
  const std::vector<Facet> all = facets(scene, position, relief);
  const AreaScale area(scene, position);
  const GroundOpacity opacity(scene, position, edge);

  std::vector<float> slopes;
  for (const Facet& f : all) slopes.push_back(std::hypot(f.gx, f.gy));
  const float steep = quantile(slopes, 0.85);
  const float scale = steep > 0.0f ? 1.0f / steep : 0.0f;

  const auto rounded = [](float v, float steps) { return std::round(v * steps) / steps; };
  std::map<std::uint32_t, std::vector<Facet>> result;
  const std::vector<std::uint32_t> regions = region_numbers(scene);
  for (const Facet& f : all) {
    Rgb colour;
    if (!regions.empty()) {
      colour = region_colour(regions[f.face]);
    } else if (relief.empty()) {
      colour = size_ramp()(rounded(area(f.p[0], f.p[1], f.p[2]), 48.0f));
    } else {
      colour = terrain_ramp()(rounded(f.mean, 48.0f));
      const float light = rounded(hill_shade(scale * f.gx, scale * f.gy), 24.0f);
      colour = {colour.r * light, colour.g * light, colour.b * light};
      colour = mix(from_srgb(paper), colour, rounded(opacity(f.face), 8.0f));
    }
    result[to_srgb(colour)].push_back(f);
  }
  return result;
}

void draw_ground(cairo_t* to, const Scene& scene, const std::vector<Point2f>& position, float edge, bool pixels) {
  // The stroke in the colour of the fill closes the hairlines between anti-aliased neighbours.
  cairo_set_line_width(to, 0.6);
  const auto paint = [&] {
    cairo_fill_preserve(to);
    cairo_stroke(to);
  };
  for (const auto& [colour, some] : by_colour(scene, position, edge)) {
    set_colour(to, colour);
    std::size_t pending = 0;
    for (const Facet& f : some) {
      move_to(to, f.p[0]);
      line_to(to, f.p[1]);
      line_to(to, f.p[2]);
      cairo_close_path(to);
      if (pixels && ++pending % batch == 0) paint();
    }
    paint();
  }
}

void draw_edges(cairo_t* to, const Scene& scene, const std::vector<Point2f>& position, bool pixels) {
  std::size_t pending = 0;
  for_each_edge(scene, [&](std::size_t u, std::size_t v) {
    if (!drawable(position[u]) || !drawable(position[v])) return;
    move_to(to, position[u]);
    line_to(to, position[v]);
    if (pixels && ++pending % batch == 0) cairo_stroke(to);
  });
  cairo_stroke(to);
}

void draw_segments(cairo_t* to, const Scene& scene, const std::vector<Point2f>& position, bool pixels) {
  std::size_t pending = 0;
  for (const Segment& segment : scene.segments) {
    const Point2f from = position[static_cast<std::size_t>(segment[0])];
    const Point2f end = position[static_cast<std::size_t>(segment[1])];
    if (!drawable(from) || !drawable(end)) continue;
    move_to(to, from);
    line_to(to, end);
    if (pixels && ++pending % batch == 0) cairo_stroke(to);
  }
  cairo_stroke(to);
}

void draw_hull(cairo_t* to, const Scene& scene, const std::vector<Point2f>& position) {
  for (const std::int32_t v : scene.hull)
    if (const Point2f p = position[static_cast<std::size_t>(v)]; drawable(p)) line_to(to, p);
  cairo_close_path(to);
  cairo_stroke(to);
}

void draw_points(cairo_t* to, const std::vector<Point2f>& position, double diameter) {
  cairo_set_line_width(to, diameter);  // a segment of no length with round caps is a disc
  for (const Point2f p : position) {
    if (!drawable(p)) continue;
    move_to(to, p);
    cairo_close_path(to);
  }
  cairo_stroke(to);
}

/// `pixels`: into an image and not into a file of shapes.
void draw(cairo_t* to, const Scene& scene, const Viewport& view, const PictureOptions& options, bool pixels) {
  const std::vector<Point2f> position = view.map_all(scene.xy);
  const float edge = edge_lengths(scene, position).median;
  const double stroke = std::clamp(0.045 * static_cast<double>(edge), pixels ? 0.45 : 0.12, 1.5);
  cairo_set_line_join(to, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(to, CAIRO_LINE_CAP_ROUND);
  set_colour(to, paper);
  cairo_paint(to);
  if (scene.faces() != 0) {
    if (options.shade) draw_ground(to, scene, position, edge, pixels);
    // In pixels, fine meshes get fainter lines, above all over a relief, or the ground would drown.
    const double strength = scene.height.empty() ? 0.06 : 0.02;
    const double alpha = pixels ? std::clamp(strength * static_cast<double>(edge), 0.12, 0.75) : 0.75;
    cairo_set_line_width(to, stroke);
    if (pixels) {
      // Strokes go to a mask first: drawn one over the other with alpha, the joints would be darker than the edges.
      cairo_push_group_with_content(to, CAIRO_CONTENT_ALPHA);
      draw_edges(to, scene, position, pixels);
      const std::unique_ptr<cairo_pattern_t, decltype(&cairo_pattern_destroy)> mask(cairo_pop_group(to),
                                                                                    cairo_pattern_destroy);
      set_colour(to, line_colour, alpha);
      cairo_mask(to, mask.get());
    } else {
      set_colour(to, line_colour, alpha);
      draw_edges(to, scene, position, pixels);
    }
  }
  if (!scene.hull.empty()) {
    set_colour(to, hull_colour);
    cairo_set_line_width(to, std::max(1.0, 1.8 * stroke));
    draw_hull(to, scene, position);
  }
  if (!scene.segments.empty()) {
    set_colour(to, segment_colour);
    cairo_set_line_width(to, std::clamp(3.0 * stroke, pixels ? 0.9 : 0.3, 3.5));
    draw_segments(to, scene, position, pixels);
  }
  // Dots where they stay apart, or where there is nothing else.
  if (scene.faces() == 0 || (edge > 12.0f && scene.height.empty())) {
    set_colour(to, line_colour);
    draw_points(to, position, scene.faces() == 0 ? 5.0 : std::clamp(0.12 * static_cast<double>(edge), 1.5, 6.0));
  }
  check(cairo_status(to));
}

cairo_status_t append(void* closure, const unsigned char* data, unsigned size) {
  try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), size);
  } catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

template <class Create>
std::string file_of(const Scene& scene, const PictureOptions& options, Create create) {
  const Viewport view(scene.xy, options.width, options.max_height, options.height);
  std::string bytes;
  {
    const Surface surface(
        create(append, &bytes, static_cast<double>(view.width()), static_cast<double>(view.height())));
    check(cairo_surface_status(surface.get()));
    const Context context(cairo_create(surface.get()));
    draw(context.get(), scene, view, options, false);
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
  }
  return bytes;
}

}  // namespace

std::string svg_bytes(const Scene& scene, const PictureOptions& options) {
  std::string svg = file_of(scene, options, [](auto... of) {
    cairo_surface_t* surface = cairo_svg_surface_create_for_stream(of...);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_USER);
    return surface;
  });
  // Cairo counts the surfaces of the process; the same mesh has the same bytes.
  const std::string counted = "id=\"surface";
  if (const auto at = svg.find(counted); at != std::string::npos)
    svg.replace(at, svg.find('"', at + counted.size()) + 1 - at, "id=\"mesh\"");
  return svg;
}

std::string pdf_bytes(const Scene& scene, const PictureOptions& options) {
  return file_of(scene, options, [](auto... of) {
    cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(of...);
    // The same bytes in each run.
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "1970-01-01T00:00:00Z");
    return surface;
  });
}

std::string png_bytes(const Scene& scene, const PictureOptions& options) {
  const Viewport view(scene.xy, options.width, options.max_height, options.height);
  Pixels pixels(view.width(), view.height(), paper);
  {
    const Surface surface(cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(pixels.row(0)),
                                                              CAIRO_FORMAT_RGB24, pixels.width(), pixels.height(),
                                                              4 * pixels.width()));
    const Context context(cairo_create(surface.get()));
    check(cairo_status(context.get()));
    draw(context.get(), scene, view, options, true);
    cairo_surface_finish(surface.get());
  }
  return pixels.png();
}

}  // namespace cadt::io::picture
