// SPDX-License-Identifier: Apache-2.0
// What one triangulation did: work, conflicts, memory and time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cadt {

/// What is counted and timed.
enum class StatisticsDetail {
  none,  ///< sizes, launches and the closing passes only: what is known anyway. No wait for the device between phases
  counters,  ///< and the work and conflicts, flips per edge, time per phase; costs 2 to 3 % on a graphics card
             ///< (docs/evaluation.md)
  timing     ///< and the shares of the device's threads' time (`thread_time`), by kernels with clocks in them: slower
};
/// "none", "counters", "timing".
[[nodiscard]] std::string_view to_string(StatisticsDetail detail) noexcept;

/// What one kernel took in a run.
struct KernelTime {
  /// As in common/portable/kernel_list.h; "sort" and "scan" are a device's own, each call of which counts as a launch.
  std::string name;
  std::uint64_t launches = 0;
  double milliseconds = 0;  ///< of all of them
};

/// Counters of one run. Everything about conflicts (lost claims, retries, deferred work) depends on the schedule and
/// differs from run to run; the mesh does not.
struct Statistics {
  std::string backend;   ///< "host", "opencl", "cuda"
  std::string device;    ///< device name as its driver gives it
  unsigned threads = 0;  ///< host threads, or compute units of the device

  std::uint64_t points = 0;              ///< input points
  std::uint64_t distinct = 0;            ///< distinct points, all of them vertices unless dimension < 2
  std::uint64_t launches = 0;            ///< kernel launches, but those within a device's own sort and scan
  std::uint64_t walk_steps = 0;          ///< triangles visited by the point location
  std::uint64_t lock_attempts = 0;       ///< lock attempts for a whole set of records; one for each change where a
                                         ///< thread owns them without locks (CPUs, from 65,536 points on)
  std::uint64_t lock_failures = 0;       ///< attempts that met a lock held, or a record that had changed:
                                         ///< all claims but splits, edge_splits and flips
  std::uint64_t invalid_restarts = 0;    ///< of these, attempts that met a record that had changed since it was read
  std::uint64_t insert_retries = 0;      ///< point insertions that were tried again in the same launch
  std::uint64_t stale_edges = 0;         ///< worklist edges whose triangle another thread had changed meanwhile
  std::uint64_t deferred_points = 0;     ///< points handed to a later launch
  std::uint64_t deferred_edges = 0;      ///< edges handed to a later launch
  std::uint64_t splits = 0;              ///< points inserted in a face (1 -> 3)
  std::uint64_t edge_splits = 0;         ///< points inserted on an edge (2 -> 4)
  std::uint64_t flips = 0;               ///< edges flipped
  std::uint64_t incircle_tests = 0;      ///< edges examined
  std::uint64_t orientation_tests = 0;   ///< orientation signs asked for
  std::uint64_t exact_orientations = 0;  ///< orientation signs that the filter left to exact arithmetic
  std::uint64_t exact_incircles = 0;     ///< incircle signs that the filter left to exact arithmetic
  std::uint64_t ties = 0;                ///< incircle signs that were zero and were decided symbolically
  std::uint64_t legality_sweeps = 0;     ///< passes over all edges at the end; the last one found nothing
  std::uint64_t sweep_repairs = 0;       ///< illegal edges that the closing passes found and repaired
  std::uint64_t cavities = 0;            ///< conflict regions that were triangulated anew at once (docs/algorithm.md)
  std::uint64_t certified_edges = 0;     ///< edges that the last closing pass examined and found legal
  std::uint64_t stabilized_edges = 0;    ///< times that an illegal edge was left because of `Options::stabilize`
  std::uint64_t illegal_edges = 0;       ///< edges that are illegal in the result: none, but with Stabilize::paper
  std::uint64_t tiles = 0;               ///< squares that the star stage cut the plane into; 0: it was not tried
  std::uint64_t proven_stars = 0;        ///< vertices whose neighbours it found and proved, without locks
  std::uint64_t wrapped_stars = 0;       ///< vertices whose neighbours were found by gift wrapping, without locks
  std::uint64_t sets = 0;                ///< sets of points, in a call with several (Triangulator::triangulate_batch)
  std::uint64_t batched_sets = 0;        ///< of these, sets that were triangulated together, not one by one
  std::uint64_t refined_points = 0;      ///< points whose sort key had to be refined
  std::uint64_t bytes_device_peak = 0;   ///< most bytes held on the device at a time
  bool wide_arithmetic = false;          ///< the exponents span so much that long integers were needed throughout

  /// The closing pass found every edge legal, so the mesh is the Delaunay triangulation. Always, but with
  /// Stabilize::paper.
  bool certified = false;

  /// Edges of the result by the number of flips of their slot: flips_per_edge[k] edges with k flips, the last with 15
  /// or more. An edge keeps its counter when it is flipped and when it becomes part of another triangle; the edges of a
  /// split start at 0 (paper, Fig. 9, 10). Their sum is the number of edges.
  std::array<std::uint64_t, 16> flips_per_edge{};

  /// How the threads of the insertion spend their time (paper, Fig. 6): shares of their sum, e.g. {"locate", 0.31}; the
  /// names are locate, lock, split, test, flip, neighbors, other, wait (for threads that run in step with it). Empty
  /// unless StatisticsDetail::timing, where the device has no clock, and with `wide_arithmetic`.
  std::vector<std::pair<std::string, double>> thread_time;

  /// Milliseconds per phase, in order of execution, e.g. {"sort", 12.3}.
  std::vector<std::pair<std::string, double>> milliseconds;

  /// With Options::kernel_times: the time of each kernel, the longest first; else empty. Copies and fills of memory are
  /// no kernels.
  std::vector<KernelTime> kernels;
};

}  // namespace cadt
