// SPDX-License-Identifier: Apache-2.0
// What Jonathan Shewchuk's program Triangle makes of a point set, for those who come from it: docs/triangle.md. The
// program `cadt triangle` and the C function of <cadt/triangulateio.h> share it.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/errors.hpp>
#include <cadt/export.hpp>
#include <cadt/triangulation.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cadt {

/// Switches of Triangle that cadt does not take; `what()` says why of each.
class CADT_API SwitchError : public Error {
 public:
  SwitchError(const std::string& message, std::string switches) : Error(message), switches_(std::move(switches)) {}
  /// Their letters, in the order given, e.g. "pq".
  [[nodiscard]] const std::string& switches() const noexcept { return switches_; }

 private:
  std::string switches_;
};

/// Triangle's switches for points, and for segments, holes and regions.
struct TriangleSwitches {
  bool segments = false;           ///< p: segments, holes and regions are read
  bool region_attributes = false;  ///< A: with p: the attribute of its region for each triangle
  bool ignore_holes = false;       ///< O: with p: holes are not used
  bool neighbors = false;          ///< n: neighbours of each triangle
  bool edges = false;              ///< e: edges
  bool voronoi = false;            ///< v: Voronoi vertices and edges
  bool hull_segments = false;      ///< c: the edges of the convex hull as segments
  bool off = false;                ///< g: the mesh as .off too
  bool jettison = false;           ///< j: without the points that are no vertices, so that numbers change
  bool zero_based = false;         ///< z: count from 0; a file's first number overrides it
  bool no_markers = false;         ///< B
  bool no_poly = false;            ///< P
  bool no_nodes = false;           ///< N
  bool no_elements = false;        ///< E
  bool no_iteration = false;       ///< I: no iteration number in file names, no .poly, and no .node unless the points
                                   ///< were in the .poly
  bool quiet = false;              ///< Q
  bool verbose = false;            ///< V
  bool help = false;               ///< h
  std::string without_effect;      ///< letters given that change nothing here: i F l (algorithms), s (without p: no
                                   ///< segments to split)
};

/// Reads switches: "nev", "-nev" or "-n -e -v"; letters may repeat. \throws SwitchError, which names all that are
/// refused
[[nodiscard]] CADT_API TriangleSwitches parse_triangle_switches(std::string_view text);

/// Why the letter is accepted without effect, as text that follows "-i: "; empty for other letters.
[[nodiscard]] CADT_API std::string_view why_without_effect(char letter) noexcept;

/// Points as Triangle takes them. The arrays must outlive the output made of them.
struct TriangleInput {
  std::span<const double> xy;          ///< n x 2
  std::span<const double> attributes;  ///< n x attributes_per_point
  std::size_t attributes_per_point = 0;
  std::span<const int> markers;  ///< n, or empty: all 0
};

/// Segments, holes and regions as Triangle takes them with switch p. The arrays must outlive the output made of them.
struct TriangleSegments {
  std::span<const Segment> segments;
  std::span<const int> markers;  ///< one a segment, or empty: all 0
  std::span<const std::array<double, 2>> holes;
  std::span<const Region> regions;
};

/// What Triangle writes. Indices are 0-based. Views are of the input, of the mesh, or of members.
struct TriangleOutput {
  TriangleOutput() = default;
  TriangleOutput(TriangleOutput&&) = default;  // keeps what the views point to
  TriangleOutput& operator=(TriangleOutput&&) = default;

  /// All points, duplicates too, in the order of the input; with -j the vertices alone.
  std::span<const double> xy, attributes;
  std::size_t attributes_per_point = 0;
  /// One a point: that of the input unless it is 0; then that of the first segment through the point that has one, also
  /// if it is eaten; then 1 on the boundary, else 0.
  std::vector<int> markers;
  std::span<const std::int32_t> triangles;  ///< n x 3, counterclockwise
  std::span<const std::int32_t> neighbors;  ///< n x 3; the k-th is opposite vertex k, -1 outside
  /// h x 2: the edges of the hull, counterclockwise; with p the parts of segments that are edges, the lower vertex
  /// first.
  std::vector<std::int32_t> segments;
  /// One a segment: 1; with p that of the first given segment there whose marker is not 0; then 1 on the boundary, else
  /// 0.
  std::vector<int> segment_markers;
  /// With A: one a triangle, that of the last place in its region.
  std::vector<double> triangle_attributes;
  std::span<const std::array<double, 2>> holes;  ///< those of the input, as the regions
  std::span<const Region> regions;
  std::size_t number_of_edges = 0;
  /// With -e or -v, number_of_edges x 2: the vertices of each edge, its first triangle on the left.
  std::vector<std::int32_t> edges;
  /// With -e or -v, number_of_edges x 2: the triangles left and right of it, -1 outside: the edges of the Voronoi
  /// diagram. An edge with -1 is on the boundary.
  std::vector<std::int32_t> edge_triangles;
  /// With -e or -v, one an edge: that of the segment there; else 1 on the boundary, else 0.
  std::vector<int> edge_markers;
  /// With -v: the circumcentre of each triangle, which is a vertex of the Voronoi diagram, and the attributes there,
  /// linearly continued from the triangle. Rounded, and infinite where it is beyond the largest double.
  std::vector<double> centers, center_attributes;
  /// With -v, number_of_edges x 2: the direction of the ray, which points out of the hull; 0 0 for finite edges.
  std::vector<double> rays;

  std::vector<double> kept_xy, kept_attributes;  ///< what views point to with -j or p
  std::vector<std::int32_t> kept_triangles, kept_neighbors;
};

/// Arranges a mesh as Triangle does. `mesh` is the triangulation of `input.xy` and must outlive the result. O(points +
/// triangles); threads are not used. Thread-safe. \throws InputError for arrays whose sizes do not fit together
[[nodiscard]] CADT_API TriangleOutput triangle_output(const TriangleInput& input, const Triangulation& mesh,
                                                      const TriangleSwitches& switches);

/// The mesh that Triangle makes with switch p: a vertex where segments cross (Crossing::exact); inside is what neither
/// holes nor the outside reach (Domain::seeds), and with c the hull is a segment all around. \throws what
/// `triangulate_constrained` throws; CrossingError with the pairs whose crossings are so close to others that rounding
/// them turns triangles over
[[nodiscard]] CADT_API ConstrainedTriangulation triangulate_as_triangle(const TriangleInput& input,
                                                                        const TriangleSegments& segments,
                                                                        const TriangleSwitches& switches,
                                                                        const Options& options = {});

/// Arranges a mesh of `triangulate_as_triangle` as Triangle does: triangles inside alone. Added points come behind
/// those of the input, with attributes as on their segment (values_at_crossings). As above
[[nodiscard]] CADT_API TriangleOutput triangle_output(const TriangleInput& input, const TriangleSegments& segments,
                                                      const ConstrainedTriangulation& mesh,
                                                      const TriangleSwitches& switches);

}  // namespace cadt
