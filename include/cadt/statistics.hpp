// SPDX-License-Identifier: Apache-2.0
// Work, conflicts, memory and time of one triangulation.
#pragma once

#include <array>
#include <cadt/export.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cadt {

/// What is counted and timed.
enum class StatisticsDetail {
  none,  ///< sizes, launches and legality sweeps only, which are known anyway; no waiting for the device between phases
  counters,  ///< also work, conflicts, flips per edge and time per phase; costs up to 2 % on a GPU (docs/evaluation.md)
  timing     ///< also the shares of the threads' time (`thread_time`), by kernels with timers: slower
};
/// "none", "counters", "timing".
[[nodiscard]] CADT_API std::string_view to_string(StatisticsDetail detail) noexcept;

/// Time of one kernel in a call.
struct KernelTime {
  /// Name as in common/portable/kernel_list.h; "sort" and "scan" are primitives of the device, one launch a call.
  std::string name;
  std::uint64_t launches = 0;
  double milliseconds = 0;  ///< of all launches together
};

/// Counters of one call. Those of conflicts (failed locks, retries, deferred work) depend on the schedule and vary from
/// call to call; the mesh does not.
struct Statistics {
  std::string backend;   ///< "host", "opencl", "cuda"
  std::string device;    ///< device name as its driver gives it
  unsigned threads = 0;  ///< of the host as it was opened, by triangulate() with 1 for small sets; or compute units of
                         ///< the device

  std::uint64_t points = 0;    ///< input points; with Crossing::exact the crossings, which have become points, as well
  std::uint64_t distinct = 0;  ///< distinct points, all of them vertices unless dimension < 2
  std::uint64_t launches = 0;  ///< kernel launches, without those inside the device's own sort and scan
  std::uint64_t walk_steps = 0;     ///< triangles visited by point location
  std::uint64_t lock_attempts = 0;  ///< attempts to lock all triangles of a split or flip; one for each split or flip
                                    ///< where a thread owns its triangles without locks (CPUs)
  std::uint64_t lock_failures = 0;  ///< attempts that met a held lock or a changed triangle: all attempts but splits,
                                    ///< edge_splits and flips
  std::uint64_t invalid_restarts = 0;    ///< of these, attempts that met a triangle that had changed since it was read
  std::uint64_t insert_retries = 0;      ///< point insertions that were retried in the same launch
  std::uint64_t stale_edges = 0;         ///< worklist edges whose triangle another thread had changed in the meantime
  std::uint64_t deferred_points = 0;     ///< points deferred to a later launch
  std::uint64_t deferred_edges = 0;      ///< edges deferred to a later launch
  std::uint64_t splits = 0;              ///< points inserted in a face (1 -> 3)
  std::uint64_t edge_splits = 0;         ///< points inserted on an edge (2 -> 4)
  std::uint64_t flips = 0;               ///< edges flipped
  std::uint64_t incircle_tests = 0;      ///< edges examined
  std::uint64_t orientation_tests = 0;   ///< orientation predicates evaluated
  std::uint64_t exact_orientations = 0;  ///< orientation predicates decided by exact arithmetic
  std::uint64_t exact_incircles = 0;     ///< incircle predicates decided by exact arithmetic
  std::uint64_t ties = 0;              ///< incircle predicates that were zero and were decided by symbolic perturbation
  std::uint64_t legality_sweeps = 0;   ///< sweeps over all edges at the end; the last one found no illegal edge
  std::uint64_t sweep_repairs = 0;     ///< illegal edges that the legality sweeps found and repaired
  std::uint64_t certified_edges = 0;   ///< edges that the last legality sweep examined and found legal
  std::uint64_t stabilized_edges = 0;  ///< times that an illegal edge was left because of `Tuning::stabilize`
  std::uint64_t illegal_edges = 0;     ///< illegal edges of the result: 0, except with Stabilize::paper
  std::uint64_t tiles = 0;             ///< tiles of the plane for local stars; 0: not tried
  std::uint64_t proven_stars = 0;      ///< vertices whose local star was proven, without locks
  std::uint64_t wrapped_stars = 0;     ///< vertices whose star was found by gift wrapping, without locks
  std::uint64_t sets = 0;              ///< point sets, in a batch (Triangulator::triangulate_batch)
  std::uint64_t batched_sets = 0;      ///< of these, sets that were triangulated batched, not individually
  std::uint64_t refined_points = 0;    ///< points in over-full cells, whose sort keys were refined
  std::uint64_t inserted_segments = 0;  ///< pieces of segments that were no edges of the Delaunay triangulation
  std::uint64_t segment_retries = 0;    ///< tries to insert one that met another, which went first
  std::uint64_t bytes_device_peak = 0;  ///< peak of the bytes held on the device
  /// Bytes copied between host and device: points and meshes of the host, and the words that steer the call (some
  /// kilobytes). 0 on the host, and for memory that a device uses in place.
  std::uint64_t bytes_to_device = 0, bytes_from_device = 0;
  bool wide_arithmetic = false;  ///< the exponents span so much that the wide kernels ran, which take any double

  /// The last legality sweep found every edge legal, so the mesh is the Delaunay triangulation. Always true, except
  /// with Stabilize::paper.
  bool certified = false;

  /// Edges of a mesh that insertion has made alone (Strategy::locks) by the number of flips of their slot:
  /// flips_per_edge[k] edges with k flips, the last entry with 15 or more. An edge keeps its counter when it is flipped
  /// and when it becomes part of another triangle; the edges of a split start at 0 (paper, Fig. 9, 10). The sum is the
  /// number of edges; 0 for meshes from stars and for batched sets.
  std::array<std::uint64_t, 16> flips_per_edge{};

  /// How the threads of the insertion spend their time (paper, Fig. 6): shares of their sum, e.g. {"locate", 0.31}; the
  /// names are locate, lock, split, test, flip, neighbors, other, wait (for threads that run in lockstep).
  /// Empty without StatisticsDetail::timing, on devices without a clock, and with `wide_arithmetic`.
  std::vector<std::pair<std::string, double>> thread_time;

  /// Milliseconds per phase, in order of execution, e.g. {"sort", 12.3}. The host's work between launches is in none of
  /// them, such as that for crossings on a grid or by exact places.
  std::vector<std::pair<std::string, double>> milliseconds;

  /// With Tuning::kernel_times: the time of each kernel, the longest first; else empty. Copies and fills of memory do
  /// not count.
  std::vector<KernelTime> kernels;
};

/// A counter of Statistics with its name, as programs print it.
struct NamedCounter {
  const char* name;
  std::uint64_t Statistics::*value;
};

/// What a call counts of its work: all counters but those of the input and of bytes.
inline constexpr NamedCounter counters_of_work[] = {
    {"launches", &Statistics::launches},
    {"walk_steps", &Statistics::walk_steps},
    {"lock_attempts", &Statistics::lock_attempts},
    {"lock_failures", &Statistics::lock_failures},
    {"invalid_restarts", &Statistics::invalid_restarts},
    {"insert_retries", &Statistics::insert_retries},
    {"stale_edges", &Statistics::stale_edges},
    {"deferred_points", &Statistics::deferred_points},
    {"deferred_edges", &Statistics::deferred_edges},
    {"splits", &Statistics::splits},
    {"edge_splits", &Statistics::edge_splits},
    {"flips", &Statistics::flips},
    {"incircle_tests", &Statistics::incircle_tests},
    {"orientation_tests", &Statistics::orientation_tests},
    {"exact_orientations", &Statistics::exact_orientations},
    {"exact_incircles", &Statistics::exact_incircles},
    {"ties", &Statistics::ties},
    {"legality_sweeps", &Statistics::legality_sweeps},
    {"sweep_repairs", &Statistics::sweep_repairs},
    {"certified_edges", &Statistics::certified_edges},
    {"stabilized_edges", &Statistics::stabilized_edges},
    {"illegal_edges", &Statistics::illegal_edges},
    {"tiles", &Statistics::tiles},
    {"proven_stars", &Statistics::proven_stars},
    {"wrapped_stars", &Statistics::wrapped_stars},
    {"refined_points", &Statistics::refined_points},
    {"inserted_segments", &Statistics::inserted_segments},
    {"segment_retries", &Statistics::segment_retries},
};

}  // namespace cadt
