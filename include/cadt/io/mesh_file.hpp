// SPDX-License-Identifier: Apache-2.0
// Reading and writing meshes.
#pragma once

#include <cadt/io/errors.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/triangulation.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cadt::io {

struct WriteOptions {
  std::string format;     ///< overrides the suffix: node ele neigh obj off ply vtu glb npz svg pdf png
  int base = 0;           ///< first index in Triangle's .node .ele .neigh: 0 or 1
  bool ascii = false;     ///< text instead of binary where the format has both (ply)
  int width = 1600;       ///< pictures: pixels (png) or user units (svg)
  int max_height = 4000;  ///< of pictures, which get narrower then; 32000 lets the width be as it is
  int height = 0;         ///< pictures: width and height exactly, the mesh in the middle; 0: as the points need
};

/// Writes a mesh or a picture of it. Formats with three coordinates take `PointSet::height`, else 0. All input points
/// are written, in input order, so indices stay those of the input. The file appears only when complete (temporary file
/// and rename); "-" is standard output. Throws FileError.
void write_mesh(const std::string& path, const PointSet& points, const Triangulation& mesh,
                const WriteOptions& options = {});

/// Triangles as read from a mesh file of any program: ele (with or without its .node file), obj, off, ply, vtu (as
/// written by cadt), npz (keys as written by cadt).
struct MeshFile {
  std::vector<std::int32_t> triangles;  ///< n x 3, 0-based
  std::vector<std::int32_t> neighbors;  ///< n x 3 or empty
};

/// Reads triangles; `number_of_points` is that of the point file that they index. `base` as in WriteOptions, -1:
/// detected (from the .node beside an .ele, else the indices, else the number of the first triangle). Neighbours come
/// from .npz and from the .neigh beside an .ele. \throws FileError, also for an index out of range
[[nodiscard]] MeshFile read_mesh(const std::string& path, std::size_t number_of_points, const std::string& format = {},
                                 int base = -1);

/// First index of the .node file beside `path`, by which other files of Triangle's beside it are read: 0 or 1, or
/// nothing if there is none. \throws FileError
[[nodiscard]] std::optional<int> base_beside(const std::string& path);

[[nodiscard]] std::vector<std::string> mesh_write_formats();
[[nodiscard]] std::vector<std::string> mesh_read_formats();

}  // namespace cadt::io
