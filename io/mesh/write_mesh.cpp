// SPDX-License-Identifier: Apache-2.0
// Converts a Triangulation for the writers; the only file that sees both.
#include "io/mesh/mesh_parts.hpp"

#include <cadt/io/mesh_file.hpp>
#include <cadt/io/picture.hpp>

namespace cadt::io {

void write_mesh(const std::string& path, const PointSet& points, const Triangulation& mesh,
                const WriteOptions& options) {
  const std::string format = detail::mesh_write_format(path, options);
  if (mesh.number_of_points() != points.size()) {
    throw FileError(path, 0,
                    "the triangulation is not that of the points: it has " + std::to_string(mesh.number_of_points()) +
                        " points, not " + std::to_string(points.size()));
  }
  if (format == "svg" || format == "pdf" || format == "png") {
    PictureOptions picture;
    picture.width = options.width;
    picture.max_height = options.max_height;
    picture.height = options.height;
    const auto write = format == "svg" ? write_svg : format == "pdf" ? write_pdf : write_png;
    write(path, points, mesh, picture);
    return;
  }
  detail::MeshParts parts;
  parts.xy = points.xy;
  parts.height = points.height;
  parts.triangles = mesh.triangles();
  parts.neighbors = mesh.neighbors();
  parts.hull = mesh.hull();
  parts.duplicates = mesh.duplicates();
  detail::write_mesh_parts(path, parts, options);
}

}  // namespace cadt::io
