// SPDX-License-Identifier: Apache-2.0
// Triangles in regions: choice of the writer, and polygons in GeoJSON.
#include <cadt/io/region_file.hpp>

#include "io/mesh/mesh_parts.hpp"
#include "io/picture/scene.hpp"
#include "io/segments/readers.hpp"
#include "io/support/number_format.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace cadt::io {
namespace detail {
namespace {

void require_fitting(const std::string& path, const RegionMesh& mesh) {
  const std::size_t points = mesh.xy.size() / 2, triangles = mesh.triangles.size() / 3;
  if (mesh.xy.size() % 2 != 0 || (!mesh.height.empty() && mesh.height.size() != points) ||
      mesh.triangles.size() % 3 != 0 || (!mesh.region.empty() && mesh.region.size() != triangles)) {
    throw FileError(path, 0, "coordinates, heights, triangles and regions to be written differ in number");
  }
  const auto fits = [&](std::int32_t v) { return v >= 0 && static_cast<std::size_t>(v) < points; };
  const bool all_fit = std::all_of(mesh.triangles.begin(), mesh.triangles.end(), fits) &&
                       std::all_of(mesh.hull.begin(), mesh.hull.end(), fits) &&
                       std::all_of(mesh.segments.begin(), mesh.segments.end(),
                                   [&](const Segment& s) { return fits(s[0]) && fits(s[1]); });
  if (!all_fit) throw FileError(path, 0, "an index to be written is out of range");
}

void write_triangles_as_geojson(AtomicFile& out, const RegionMesh& mesh) {
  out.write("{\"type\":\"FeatureCollection\",");
  if (!mesh.crs.empty()) {
    out.write(R"("crs":{"type":"name","properties":{"name":)" + nlohmann::json(mesh.crs).dump() + "}},");
  }
  out.write("\"features\":[");
  const std::string property = "\"" + mesh.region_name + "\":";
  for (std::size_t t = 0; 3 * t < mesh.triangles.size(); ++t) {
    out.write(t == 0 ? "\n" : ",\n");
    out.write("{\"type\":\"Feature\",\"properties\":{");
    if (!mesh.region.empty()) {
      out.write(property);
      out.advance(put(out.room(number_room), std::int64_t{mesh.region[t]}));
    }
    out.write("},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[");
    for (std::size_t k = 0; k < 4; ++k) {  // the first corner closes the ring
      const auto v = static_cast<std::size_t>(mesh.triangles[3 * t + k % 3]);
      char* at = out.room(4 * number_room);
      if (k != 0) *at++ = ',';
      *at++ = '[';
      at = put(at, mesh.xy[2 * v]);
      *at++ = ',';
      at = put(at, mesh.xy[2 * v + 1]);
      if (!mesh.height.empty()) {
        *at++ = ',';
        at = put(at, mesh.height[v]);
      }
      *at++ = ']';
      out.advance(at);
    }
    out.write("]]}}");
  }
  out.write("\n]}\n");
}

void write_graph(const std::string& path, const RegionMesh& mesh, const std::string& format, int base) {
  SegmentsFile graph;
  graph.xy.assign(mesh.xy.begin(), mesh.xy.end());
  graph.attributes.assign(mesh.height.begin(), mesh.height.end());
  graph.attributes_per_point = mesh.height.empty() ? 0 : 1;
  graph.segments.assign(mesh.segments.begin(), mesh.segments.end());
  graph.holes.assign(mesh.holes.begin(), mesh.holes.end());
  graph.regions.assign(mesh.regions.begin(), mesh.regions.end());
  write_segments(path, graph, {format, base});
}

}  // namespace
}  // namespace detail

std::vector<std::string> region_write_formats() {
  return {"node", "ele", "obj", "off", "ply", "vtu", "glb", "poly", "edge", "geojson", "svg", "pdf", "png"};
}

void write_region_mesh(const std::string& path, const RegionMesh& mesh, const WriteOptions& options) {
  const std::string format =
      detail::choose_format(path == "-" ? "<stdout>" : path, options.format, region_write_formats());
  detail::require_fitting(path, mesh);
  if (format == "poly" || format == "edge") return detail::write_graph(path, mesh, format, options.base);
  if (format == "geojson") {
    detail::AtomicFile out(path);
    detail::write_triangles_as_geojson(out, mesh);
    return out.commit();
  }
  if (picture::is_picture(format))
    return picture::write_scene(path, format, picture::scene_of(mesh), picture::options_of(options));
  detail::MeshParts parts;
  parts.xy = mesh.xy;
  parts.height = mesh.height;
  parts.triangles = mesh.triangles;
  parts.region = mesh.region;
  parts.region_name = mesh.region_name;
  WriteOptions mesh_options = options;
  mesh_options.format = format;
  detail::write_mesh_parts(path, parts, mesh_options);
}

}  // namespace cadt::io
