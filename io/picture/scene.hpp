// SPDX-License-Identifier: Apache-2.0
// The content of a picture, as plain arrays: pictures do not depend on how the mesh was computed.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/io/mesh_file.hpp>
#include <cadt/io/picture.hpp>
#include <cadt/io/region_file.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace cadt::io::picture {

/// Views of the caller's arrays. Points with a coordinate that is not finite, and triangles that use them, are left
/// out.
struct Scene {
  std::span<const double> xy;                 ///< interleaved
  std::span<const double> height;             ///< one a point, or empty
  std::span<const std::int32_t> triangles;    ///< n x 3, counterclockwise
  std::span<const std::int32_t> hull;         ///< counterclockwise loop, or empty
  std::span<const std::int32_t> region = {};  ///< one a triangle, or empty: equal ones have a colour of their own
  std::span<const Segment> segments = {};     ///< drawn thick

  [[nodiscard]] std::size_t points() const noexcept { return xy.size() / 2; }
  [[nodiscard]] std::size_t faces() const noexcept { return triangles.size() / 3; }
};

[[nodiscard]] inline Scene scene_of(const PointSet& points, const Triangulation& mesh) {
  return {points.xy, points.height, mesh.triangles(), mesh.hull()};
}
[[nodiscard]] inline Scene scene_of(const RegionMesh& mesh) {
  return {mesh.xy, mesh.height, mesh.triangles, mesh.hull, mesh.region, mesh.segments};
}

[[nodiscard]] inline bool is_picture(const std::string& format) {
  return format == "svg" || format == "pdf" || format == "png";
}
[[nodiscard]] inline PictureOptions options_of(const WriteOptions& options) {
  return {.width = options.width, .max_height = options.max_height, .height = options.height};
}

/// Calls `edge(u, v)` for every edge once. Counterclockwise triangles pass an interior edge once in each direction, so
/// u < v takes each of them once; edges of the hull are passed in one direction only.
template <class Edge>
void for_each_edge(const Scene& scene, Edge edge) {
  for (std::size_t t = 0; t + 2 < scene.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t u = scene.triangles[t + k];
      const std::int32_t v = scene.triangles[t + (k + 1) % 3];
      if (u < v) edge(static_cast<std::size_t>(u), static_cast<std::size_t>(v));
    }
  }
  for (std::size_t i = 0; i < scene.hull.size(); ++i) {
    const std::int32_t u = scene.hull[i];
    const std::int32_t v = scene.hull[(i + 1) % scene.hull.size()];
    if (u > v) edge(static_cast<std::size_t>(u), static_cast<std::size_t>(v));
  }
}

/// Writes the picture; format: svg, pdf or png. \throws FileError for too many triangles, too
void write_scene(const std::string& path, const std::string& format, const Scene& scene, const PictureOptions& options);

/// The whole file. \pre scene.faces() <= most_drawn_triangles, and as many points
[[nodiscard]] std::string svg_bytes(const Scene& scene, const PictureOptions& options);
[[nodiscard]] std::string pdf_bytes(const Scene& scene, const PictureOptions& options);
[[nodiscard]] std::string png_bytes(const Scene& scene, const PictureOptions& options);

}  // namespace cadt::io::picture
