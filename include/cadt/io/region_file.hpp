// SPDX-License-Identifier: Apache-2.0
// Writing triangles in regions between segments: domains, polygons, label images.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/io/errors.hpp>
#include <cadt/io/mesh_file.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cadt::io {

/// Views of the caller's arrays. Indices are 0-based.
struct RegionMesh {
  std::span<const double> xy;                         ///< n x 2
  std::span<const double> height;                     ///< one a point, or empty
  std::span<const std::int32_t> triangles;            ///< t x 3, counterclockwise
  std::span<const std::int32_t> region;               ///< one a triangle, or empty: a region, a feature, a label
  std::string region_name = "region";                 ///< what files call that
  std::span<const Segment> segments;                  ///< those to be written or drawn, such as constrained edges
  std::span<const std::int32_t> hull;                 ///< counterclockwise loop to be drawn, or empty
  std::span<const std::array<double, 2>> holes = {};  ///< seeds, for poly alone
  std::span<const Region> regions = {};               ///< the same
  std::string crs = {};                               ///< reference system that a GeoJSON file is to name; empty: none
};

/// Writes a mesh, its segments or a picture; the format comes from the suffix unless given:
///   node ele obj off ply vtu glb  points and triangles; ele, ply and vtu have the regions as an attribute of triangles
///   poly edge                     points, segments, holes and regions; segments
///   geojson                       a polygon a triangle, with its region as a property
///   svg pdf png                   a picture: segments thick, a colour a region, or by size where there is only one
/// All points are written, in their order. The file appears under its name only when complete; "-" is standard output.
/// \throws FileError, also for arrays whose sizes do not fit together, and for pictures of more than
/// most_drawn_triangles (svg, pdf) or ten times as many (png)
void write_region_mesh(const std::string& path, const RegionMesh& mesh, const WriteOptions& options = {});

/// Names of these formats.
[[nodiscard]] std::vector<std::string> region_write_formats();

}  // namespace cadt::io
