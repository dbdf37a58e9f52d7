// SPDX-License-Identifier: Apache-2.0
// Converts a Triangulation for the writers; the only file that sees both.
#include "io/mesh/mesh_parts.hpp"
#include "io/picture/scene.hpp"

namespace cadt::io {

void write_mesh(const std::string& path, const PointSet& points, const Triangulation& mesh,
                const WriteOptions& options) {
  const std::string format = detail::mesh_write_format(path, options);
  if (mesh.number_of_points() != points.size()) {
    throw FileError(path, 0,
                    "the triangulation is not that of the points: it has " + std::to_string(mesh.number_of_points()) +
                        " points, not " + std::to_string(points.size()));
  }
  if (picture::is_picture(format)) {
    const auto write = format == "svg" ? write_svg : format == "pdf" ? write_pdf : write_png;
    return write(path, points, mesh, picture::options_of(options));
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
