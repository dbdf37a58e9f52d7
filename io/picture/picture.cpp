// SPDX-License-Identifier: Apache-2.0
#include <cadt/io/picture.hpp>

#include "io/picture/scene.hpp"
#include "io/support/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cadt::io {

namespace {

picture::Scene small_scene(const std::string& path, const PointSet& points, const Triangulation& mesh) {
  const picture::Scene scene = picture::scene_of(points, mesh);
  if (scene.faces() > most_drawn_triangles || scene.points() > most_drawn_triangles) {
    throw FileError(
        path, 0,
        fmt::format("{} triangles of {} points are too many to be drawn one by one (at most {}): 'cadt render' "
                    "draws them as a .png",
                    scene.faces(), scene.points(), most_drawn_triangles));
  }
  return scene;
}

void write_file(const std::string& path, const std::string& bytes) {
  detail::AtomicFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

}  // namespace

void picture::write_scene(const std::string& path, const std::string& format, const Scene& scene,
                          const PictureOptions& options) {
  const std::size_t most = format == "png" ? 10 * most_drawn_triangles : most_drawn_triangles;
  const std::size_t count = std::max({scene.faces(), scene.points(), scene.segments.size()});
  if (count > most) {
    throw FileError(
        path, 0,
        fmt::format("{} triangles, {} points and {} segments are too many to be drawn one by one (at most "
                    "{}): draw a part of them{}",
                    scene.faces(), scene.points(), scene.segments.size(), most, format == "png" ? "" : ", or a .png"));
  }
  write_file(path, format == "svg"   ? svg_bytes(scene, options)
                   : format == "pdf" ? pdf_bytes(scene, options)
                                     : png_bytes(scene, options));
}

void write_svg(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options) {
  write_file(path, picture::svg_bytes(small_scene(path, points, mesh), options));
}

void write_pdf(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options) {
  write_file(path, picture::pdf_bytes(small_scene(path, points, mesh), options));
}

void write_png(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options) {
  write_file(path, picture::png_bytes(small_scene(path, points, mesh), options));
}

}  // namespace cadt::io
