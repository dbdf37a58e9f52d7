// SPDX-License-Identifier: Apache-2.0
// Pictures of a mesh.
#pragma once

#include <cadt/io/errors.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/triangulation.hpp>

#include <cstddef>
#include <string>

namespace cadt::io {

struct PictureOptions {
  int width = 1600;  ///< pixels, user units of an SVG, or points of a PDF, at most 32000; the height follows from the
                     ///< bounding box of the points
  int max_height = 4000;  ///< where it would be more, the picture gets narrower; 32000 lets the width be as it is
  bool shade = true;      ///< fill triangles by height (if given) or by size
  int height = 0;         ///< not 0: width and height exactly, the mesh in the middle
};

/// Triangles and points that a picture takes. More are drawn by the program: cadt render.
inline constexpr std::size_t most_drawn_triangles = 200'000;

/// Edges, ground by height or size, hull and, where they stay apart, points; drawn by Cairo. O(triangles + pixels).
/// \throws FileError also above most_drawn_triangles
void write_svg(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options = {});
void write_pdf(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options = {});
void write_png(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options = {});

}  // namespace cadt::io
