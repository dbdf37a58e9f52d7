// SPDX-License-Identifier: Apache-2.0
// Reading and writing segments between points: planar straight-line graphs, polylines, polygons.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/io/errors.hpp>
#include <cadt/points.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cadt::io {

/// Points with segments between them, as read. All indices are 0-based, whatever they are in the file. The view is
/// valid as long as `xy` is unchanged.
struct SegmentsFile {
  std::vector<double> xy;          ///< n x 2
  std::vector<double> attributes;  ///< n x attributes_per_point; the third coordinate where a format has one
  std::size_t attributes_per_point = 0;
  std::vector<std::int32_t> markers;  ///< n, or empty if the file has none
  std::vector<Segment> segments;
  std::vector<std::int32_t> segment_markers;  ///< one a segment, or empty if the file has none
  std::vector<std::array<double, 2>> holes;
  /// Where a line of .poly has one number, it is both attribute and largest area, as in Triangle.
  std::vector<Region> regions;
  bool some_heights = false;  ///< GeoJSON: some positions have a height and others none; then there are none here
  bool nodes_beside = false;  ///< the points are those of the .node file beside it
  int base = 0;               ///< the first index in the file: 0 or 1
  std::string crs;     ///< reference system that a GeoJSON file names in "crs", as RFC 7946 no longer does; or empty
  std::string format;  ///< the format that was read
  [[nodiscard]] std::size_t size() const noexcept { return xy.size() / 2; }
  [[nodiscard]] PointsView view() const { return PointsView(std::span<const double>(xy)); }
};

/// Reads points and segments; the format comes from the suffix unless given:
///   poly     Triangle: points (or those of the .node file beside it), segments, holes, regions
///   edge     Triangle: segments between the points of the .node file beside it
///   edg cin  CGAL: a number of segments, then x1 y1 x2 y2 each; or sites, lines "p x y" and "s x1 y1 x2 y2"
///   obj      Wavefront: vertices and lines (l); z becomes the attribute, faces are not read
///   geojson json
///            all geometries, also of features and collections; or a bare array of rings, as earcut takes it. The
///            last position of a ring, which repeats the first, is left out. A third coordinate becomes the attribute
///            if all positions have one
///   txt      CDT (points, edges: a first line of two numbers) or detria (points, polylines, edges: of three).
///            Polylines are closed. CDT's edges count from 1 if they use the number of points and not 0
///   dat      poly2tri: an outline, rings behind HOLE, points behind STEINER
/// "-" is standard input, for which `format` is required. Numbers do not depend on the C locale. Memory is bounded by
/// the size of the file, whatever its header claims. Points that are equal stay apart: each end of a segment of edg and
/// cin is a point of its own. \throws FileError with the line, also for NaN, infinity, an index that is out of range,
/// truncated files, wrong counts, and files without points
[[nodiscard]] SegmentsFile read_segments(const std::string& path, const std::string& format = {});

/// The .node file that read_segments() would read the points from; empty if they are in the file itself, or if it is no
/// regular file that can be read.
[[nodiscard]] std::string node_file_of(const std::string& path, const std::string& format = {});

/// Names of the formats that segments can be read from.
[[nodiscard]] std::vector<std::string> segment_read_formats();

/// Polygons with holes, in the layout of GeoArrow: polygon p has the rings polygon_offsets[p] to polygon_offsets[p + 1]
/// - 1, the outer one first; ring r has the points ring_offsets[r] to ring_offsets[r + 1] - 1 of xy. No ring repeats
/// its first point at its end.
struct PolygonsFile {
  std::vector<double> xy;
  std::vector<double> height;  ///< one a point, if all positions have a third coordinate; or empty
  bool some_heights = false;   ///< some have one, and others none
  std::vector<std::int64_t> ring_offsets{0};
  std::vector<std::int64_t> polygon_offsets{0};
  std::vector<std::int32_t> features;  ///< one a polygon: the number of its feature in the file, from 0
  std::size_t number_of_features = 0;
  std::size_t other_geometries = 0;  ///< points and lines, which are not read
  std::string crs;                   ///< as of a SegmentsFile
  [[nodiscard]] std::size_t size() const noexcept { return features.size(); }
};

/// Reads the polygons of a GeoJSON file (geojson, json), also of features and collections; or a bare array of rings as
/// one polygon. Rings are not examined. \throws FileError as `read_segments`, also if there is no polygon
[[nodiscard]] PolygonsFile read_polygons(const std::string& path, const std::string& format = {});

struct WriteSegmentsOptions {
  std::string format;  ///< overrides the suffix: poly, edge
  int base = 0;        ///< first index: 0 or 1
};

/// Writes points, segments, holes and regions as .poly, or the segments alone as .edge, for a .node file of the points.
/// Numbers are the shortest decimals that read back to the same doubles. The file appears under its name only when
/// complete; "-" is standard output. \throws FileError
void write_segments(const std::string& path, const SegmentsFile& graph, const WriteSegmentsOptions& options = {});

}  // namespace cadt::io
