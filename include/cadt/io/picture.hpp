// SPDX-License-Identifier: Apache-2.0
// Pictures of a mesh.
#pragma once

#include <cadt/io/errors.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/triangulation.hpp>

#include <string>

namespace cadt::io {

struct PictureOptions {
  int width = 1600;  ///< pixels, or user units of an SVG; the height follows from the bounding box of the points
  int max_height = 4000;
  bool shade = true;  ///< fill triangles by height (if given) or by size
};

/// SVG of a small mesh (edges as one path, hull emphasised). \throws FileError above 200,000 triangles, which need PNG
void write_svg(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options = {});

/// PNG: anti-aliased edges for meshes whose triangles are larger than a few pixels, edge density (or shaded heights)
/// for millions of triangles. O(triangles + pixels). \throws FileError
void write_png(const std::string& path, const PointSet& points, const Triangulation& mesh,
               const PictureOptions& options = {});

}  // namespace cadt::io
