// SPDX-License-Identifier: Apache-2.0
// The boundaries between the labels of an image as segments, and the labels of triangles: meshes of microstructures,
// cells, land cover.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace cadt {

/// The label of everything outside of an image. No pixel may have it.
inline constexpr std::int32_t outside_label = std::numeric_limits<std::int32_t>::min();

/// Boundaries between labels. Coordinates are whole numbers, in pixels: pixel i of row j, with row 0 at the top, is the
/// square [i, i + 1] x [height - 1 - j, height - j].
struct LabelSegments {
  std::vector<double> xy;         ///< n x 2: the corners of boundaries, row by row from the top, from left to right
  std::vector<Segment> segments;  ///< rightwards or downwards, none longer than it must be and none in two parts
  /// One a segment: the labels left and right of it; outside_label beyond the border of the image.
  std::vector<std::array<std::int32_t, 2>> sides;
};

/// The edges between neighbouring pixels of different labels, and the border of the image. Each is part of exactly one
/// segment; a segment goes on straight until a boundary turns or a third one meets it. Segments have no point in common
/// but their ends, so they can be triangulated with Crossing::error:
///
///     const cadt::LabelSegments boundary = cadt::label_segments(labels, width, height);
///     const auto mesh = cadt::triangulate_constrained(boundary.xy, boundary.segments);
///     const auto label = cadt::triangle_labels(boundary.xy, mesh.mesh().triangles(), labels, width, height);
///
/// Boundaries have the steps of the pixels. To smooth them, join segments to polylines that end where other than two
/// meet, simplify each of these (such as by Douglas and Peucker's method) without moving its ends, and use the result
/// in place of `segments`; `sides` still holds for each polyline. find_crossings shows polylines that were simplified
/// too far. `labels`: row by row from the top. O(pixels) time, O(width + segments) memory. Thread-safe. \throws
/// InputError if there are not width x height labels or none, or with the index of a pixel that has outside_label;
/// LimitError for 2^31 corners or more
[[nodiscard]] CADT_API LabelSegments label_segments(std::span<const std::int32_t> labels, std::size_t width,
                                                    std::size_t height);

/// One a triangle: the label of the pixel in which its centroid lies. Where triangles have the segments of
/// label_segments as edges, all of a triangle has this label. A centroid outside of the image has the label of the
/// nearest pixel. `triangles`: n x 3 indices of points of `xy`. O(n). Thread-safe. \throws InputError as
/// label_segments, with the index of a triangle that has an index out of range or coordinates that are not finite, or
/// if `xy` has an odd number of values, or triangles have not three points each
[[nodiscard]] CADT_API std::vector<std::int32_t> triangle_labels(std::span<const double> xy,
                                                                 std::span<const std::int32_t> triangles,
                                                                 std::span<const std::int32_t> labels,
                                                                 std::size_t width, std::size_t height);

}  // namespace cadt
