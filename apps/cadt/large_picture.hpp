// SPDX-License-Identifier: Apache-2.0
// Pictures of meshes that are too large for Cairo, which io takes: the viewer draws them.
#pragma once

#include <cadt/io/mesh_file.hpp>
#include <cadt/io/picture.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/triangulation.hpp>

#include <algorithm>
#include <string>

namespace cadt::cli {

[[nodiscard]] inline bool is_large_picture(const io::PointSet& points, const Triangulation& mesh) {
  return std::max(points.size(), mesh.number_of_triangles()) > io::most_drawn_triangles;
}

/// A PNG. Throws Failure for a width that OpenGL has no room for, and where the program was built without the viewer,
/// DisplayError without OpenGL.
void write_large_picture(const std::string& path, const io::PointSet& points, const Triangulation& mesh,
                         const io::WriteOptions& how);

}  // namespace cadt::cli
