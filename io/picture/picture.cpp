// SPDX-License-Identifier: Apache-2.0
#include <cadt/io/picture.hpp>

#include "io/picture/scene.hpp"
#include "io/support/atomic_file.hpp"

#include <fmt/format.h>

namespace cadt::io {

namespace {

picture::Scene scene_of(const PointSet& points, const Triangulation& mesh) {
  return {points.xy, points.height, mesh.triangles(), mesh.hull()};
}

void write_file(const std::string& path, const std::string& bytes) {
  detail::AtomicFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

}  // namespace

void write_svg(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options) {
  const picture::Scene scene = scene_of(points, mesh);
  if (scene.faces() > picture::svg_max_faces || scene.points() > picture::svg_max_faces) {
    throw FileError(path, 0,
                    fmt::format("{} triangles of {} points are too many for an SVG (at most {}): write a .png instead",
                                scene.faces(), scene.points(), picture::svg_max_faces));
  }
  write_file(path, picture::svg_text(scene, options));
}

void write_png(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options) {
  write_file(path, picture::png_bytes(scene_of(points, mesh), options));
}

}  // namespace cadt::io
