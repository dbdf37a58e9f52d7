// SPDX-License-Identifier: Apache-2.0
// Voronoi cells as GeoJSON and as a picture.
#include "io/picture/colour.hpp"
#include "io/picture/viewport.hpp"
#include "io/support/atomic_file.hpp"
#include "io/support/input_file.hpp"
#include "io/support/number_format.hpp"

#include <cadt/io/query_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace cadt::io {
namespace detail {
namespace {

/// The corners without those that equal the one before, around the polygon.
void take_different(std::span<const double> corners, std::vector<double>& different) {
  different.clear();
  for (std::size_t i = 0; i < corners.size(); i += 2) {
    const std::size_t before = (i == 0 ? corners.size() : i) - 2;
    if (corners[i] == corners[before] && corners[i + 1] == corners[before + 1]) continue;
    different.push_back(corners[i]);
    different.push_back(corners[i + 1]);
  }
}

/// Whether the polygon is more than a point or a line. In units of its own box, so that no product underflows or
/// overflows.
bool has_area(std::span<const double> c) {
  if (c.size() < 6) return false;
  std::array<double, 2> low{c[0], c[1]}, high = low;
  for (std::size_t i = 0; i < c.size(); ++i) {
    low[i % 2] = std::min(low[i % 2], c[i]);
    high[i % 2] = std::max(high[i % 2], c[i]);
  }
  if (low[0] == high[0] || low[1] == high[1]) return false;
  const auto part = [&](std::size_t i) {
    const double scale = std::isfinite(high[i % 2] - low[i % 2]) ? 1 : 0.25;
    return (c[i] * scale - low[i % 2] * scale) / (high[i % 2] * scale - low[i % 2] * scale);
  };
  double twice = 0;
  for (std::size_t i = 2; i + 3 < c.size(); i += 2) {
    twice += (part(i) - part(0)) * (part(i + 3) - part(1)) - (part(i + 2) - part(0)) * (part(i + 1) - part(1));
  }
  return twice > 0;
}

/// Calls `cell(p, corners)` for each point whose polygon has an area. A box along the sides of cells leaves a line or a
/// point of those outside, and corners twice.
template <class Cell>
void for_each_cell(const VoronoiPolygons& polygons, Cell cell) {
  std::vector<double> corners;
  for (std::size_t p = 0; p + 1 < polygons.begin.size(); ++p) {
    const std::size_t from = polygons.begin[p], to = polygons.begin[p + 1];
    take_different(std::span(polygons.xy).subspan(2 * from, 2 * (to - from)), corners);
    if (has_area(corners)) cell(p, std::span<const double>(corners));
  }
}

void write_geojson(AtomicFile& out, const VoronoiPolygons& polygons) {
  out.write("{\"type\":\"FeatureCollection\",\"features\":[");
  const char* before = "\n";
  for_each_cell(polygons, [&](std::size_t p, std::span<const double> corners) {
    out.write(
        fmt::format("{}{{\"type\":\"Feature\",\"properties\":{{\"point\":{}}},\"geometry\":{{\"type\":\"Polygon\","
                    "\"coordinates\":[[",
                    before, p));
    before = ",\n";
    for (std::size_t i = 0; i <= corners.size(); i += 2) {  // the first corner closes the ring
      const std::size_t at = i == corners.size() ? 0 : i;
      out.write(fmt::format("{}[{},{}]", i == 0 ? "" : ",", corners[at], corners[at + 1]));
    }
    out.write("]]}}");
  });
  out.write("\n]}\n");
}

double area(std::span<const double> c) {
  double twice = 0;
  for (std::size_t i = 2; i + 3 < c.size(); i += 2) {
    twice += (c[i] - c[0]) * (c[i + 3] - c[1]) - (c[i + 2] - c[0]) * (c[i + 1] - c[1]);
  }
  return twice / 2;
}

/// Small cells blue, large ones almost paper: the colour is the rank of the area, in 24 steps.
void write_svg(AtomicFile& out, const std::string& path, std::span<const double> xy, const VoronoiPolygons& polygons,
               const Box& box) {
  using namespace picture;
  std::vector<double> areas;
  for_each_cell(polygons, [&](std::size_t, std::span<const double> corners) { areas.push_back(area(corners)); });
  constexpr std::size_t most_cells = 100'000;
  if (areas.size() > most_cells) {
    throw FileError(path, 0,
                    fmt::format("{} cells are too many for an SVG (at most {}): take a smaller box, or write "
                                "a .geojson or .npz",
                                areas.size(), most_cells));
  }
  std::sort(areas.begin(), areas.end());
  const std::array<double, 4> corners_of_box{box.min_x, box.min_y, box.max_x, box.max_y};
  const Viewport view(corners_of_box, 1000, 2000);
  const auto at = [&](double x, double y) {
    const auto position = view.map(x, y);
    return fmt::format("{:.2f} {:.2f}", position.x, position.y);
  };
  constexpr double steps = 24;
  std::map<std::uint32_t, std::string> paths;
  for_each_cell(polygons, [&](std::size_t, std::span<const double> corners) {
    const auto rank = std::lower_bound(areas.begin(), areas.end(), area(corners)) - areas.begin();
    const double share = static_cast<double>(rank) / static_cast<double>(areas.size());
    std::string& text = paths[to_srgb(size_ramp()(static_cast<float>(std::floor(steps * share) / (steps - 1))))];
    for (std::size_t i = 0; i < corners.size(); i += 2) text += (i == 0 ? 'M' : 'L') + at(corners[i], corners[i + 1]);
    text += 'z';
  });
  const double spacing = std::sqrt(static_cast<double>(view.width()) * static_cast<double>(view.height()) /
                                   static_cast<double>(std::max<std::size_t>(areas.size(), 1)));
  out.write(fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\">\n<title>{2} Voronoi cells</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#{3:06x}\"/>\n"
      "<g id=\"cells\" stroke=\"#{4:06x}\" stroke-width=\"{5:.2f}\" stroke-linejoin=\"round\">\n",
      view.width(), view.height(), areas.size(), paper, line_colour, std::clamp(0.03 * spacing, 0.15, 1.5)));
  for (const auto& [colour, text] : paths) out.write(fmt::format("<path fill=\"#{:06x}\" d=\"{}\"/>\n", colour, text));
  out.write(
      fmt::format("</g>\n<path id=\"points\" fill=\"none\" stroke=\"#{:06x}\" stroke-width=\"{:.2f}\" "
                  "stroke-linecap=\"round\" d=\"",
                  line_colour, std::clamp(0.1 * spacing, 0.5, 6.0)));
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    const double x = xy[i], y = xy[i + 1];
    if (x < box.min_x || x > box.max_x || y < box.min_y || y > box.max_y) continue;
    out.write('M' + at(x, y) + "h0");
  }
  out.write("\"/>\n</svg>\n");
}

}  // namespace
}  // namespace detail

std::size_t number_of_cells(const VoronoiPolygons& polygons) {
  std::size_t count = 0;
  detail::for_each_cell(polygons, [&](std::size_t, std::span<const double>) { ++count; });
  return count;
}

void write_voronoi(const std::string& path, std::span<const double> xy, const VoronoiPolygons& polygons, const Box& box,
                   const std::string& asked) {
  using namespace detail;
  const std::string format = choose_format(path == "-" ? "<stdout>" : path, asked, {"geojson", "svg"});
  AtomicFile out(path);
  if (format == "geojson") {
    write_geojson(out, polygons);
  } else {
    write_svg(out, path, xy, polygons, box);
  }
  out.commit();
}

}  // namespace cadt::io
