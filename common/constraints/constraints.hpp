// SPDX-License-Identifier: Apache-2.0
// From the Delaunay mesh to the constrained one: segments are found in it, those that are no edges are inserted, all
// are traced, and the mesh is certified.
#pragma once

#include <cadt/constrained.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/constraints/crossings/device_crossings.hpp"
#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/key_grid.hpp"

namespace cadt {

using DeviceMesh = std::unique_ptr<DeviceTriangulation::Data>;

/// What is wanted of segments that cross.
enum class FindCrossings { no, pairs, places };

/// What a call is told of its segments and tells of them.
struct SegmentJob {
  std::span<const Segment> on_host;  ///< pairs of input points, or
  Allocation segments;               ///< the same on the device
  std::size_t count = 0;             ///< of segments, below 2^30
  bool wants_chains = false;
  FindCrossings wants_crossings = FindCrossings::no;
  /// Points of which those from `exact_points` on are rounded crossings, and segments between them: the mesh is
  /// examined whether it is right for the exact places (certify_places).
  const Allocation* rounded_places = nullptr;
  std::size_t exact_points = 0;

  bool crossed = false;                     ///< segments cross: there is no mesh
  std::optional<FoundCrossings> crossings;  ///< if they cross, and the device could find them
  bool divided = false;                     ///< a vertex lies on a segment
  std::optional<std::vector<std::uint32_t>> suspects;
  Allocation edge_flags;     ///< a word a triangle of the result; null if dimension < 2
  Allocation chain_offsets;  ///< count + 1 words, if wanted
  Allocation chains;         ///< input points along each segment
  std::size_t chain_length = 0;
};

/// The results of a job, copied to the host.
struct SegmentResults {
  std::vector<std::uint32_t> edge_flags;
  std::vector<std::uint32_t> chain_offsets, chains;
};
[[nodiscard]] SegmentResults read_results(Context& ctx, const SegmentJob& job, std::size_t triangles);

/// \throws LimitError
void require_segments(std::size_t count);
/// \throws OptionError for a number that is no constant, or for holes and regions that the domain has no use for
void require_valid(const ConstraintOptions& options);
/// \throws OptionError with Stabilize::paper, which leaves edges that are not legal
void require_legal_edges(const Options& options);

/// Duplicates of input points and what they equal; null if there are none.
struct DuplicateLists {
  const Allocation &points, &representatives;
  std::size_t count;
};

/// Makes the segments edges of the Delaunay mesh of `points` input points, of which `distinct` are vertices, in the
/// order of the keys of `grid`: any other order is right as well, but slow for long segments on GPUs. If segments
/// cross, only `job.crossed` and `job.crossings` are set. \pre the mesh is unfinished and has triangles, ghosts and
/// points (MeshUse::constrained) \throws InputError for the first segment with an end that is no point, InternalError
void constrain(Context& ctx, Mesh& mesh, const KeyGrid& grid, std::size_t points, std::size_t distinct,
               const DuplicateLists& duplicates, SegmentJob& job);

/// As Triangulator::triangulate.
[[nodiscard]] Triangulation triangulate_on_host(const std::shared_ptr<Triangulator::State>& state, PointsView points);

/// The mesh of a call with segments, on the host; without triangles if `job.crossed`.
[[nodiscard]] Triangulation triangulate_with_segments(const std::shared_ptr<Triangulator::State>& state,
                                                      PointsView points, SegmentJob& job, SegmentResults& segments,
                                                      KeepPoints keep);
/// Of points that only this call has in device memory: it keeps none.
[[nodiscard]] std::unique_ptr<Triangulation::Data> triangulate_with_segments(
    const std::shared_ptr<Triangulator::State>& state, const DevicePoints& points, SegmentJob& job,
    SegmentResults& segments);

}  // namespace cadt
