// SPDX-License-Identifier: Apache-2.0
// What a caller chooses: where a triangulation is computed, and what else the call does.
#pragma once

#include <cadt/export.hpp>
#include <cadt/statistics.hpp>
#include <cadt/stop_token.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cadt {

/// Where the triangulation is computed. `automatic` takes the fastest usable device: a GPU if there is one, else the
/// host. The function triangulate() takes the host for fewer than 200,000 points, unless `Options::device` names a
/// device: opening a GPU takes longer. Once it has opened one in the process, it times a small set on both and from
/// then on takes the GPU for the sizes for which the whole call is faster there.
enum class Backend { automatic, host, opencl, cuda };

/// "auto", "host", "opencl", "cuda".
[[nodiscard]] CADT_API std::string_view to_string(Backend backend) noexcept;
/// Inverse of `to_string`. \throws BackendUnavailable for any other name
[[nodiscard]] CADT_API Backend backend_from_string(std::string_view name);

class DeviceAllocator;  // triangulator.hpp

/// Order of the triangles in the result.
enum class Order {
  canonical,  ///< each triangle starts with its smallest index, triangles ascend: the same arrays from every device and
              ///< call
  fast        ///< as the device left them: the same set of triangles, in an order that depends on the schedule
};

/// Whether a mesh knows its points (Triangulation::points).
enum class KeepPoints {
  no,
  copy,  ///< the mesh has a copy, as doubles: 16 bytes a point
  view   ///< the mesh has the caller's view: the coordinates must stay where they are and what they are as long as the
         ///< mesh or a copy of it lives. Where crossings of segments have added or moved points (Crossing), the mesh
         ///< has a copy of all of them
};

/// How the mesh is computed. The result does not depend on it.
enum class Strategy {
  automatic,  ///< the faster one, as far as is known for the device and the points
  locks,      ///< parallel insertion and flips in one shared mesh
  stars  ///< local stars, proven without locks, where possible; the residual vertices by gift wrapping and insertion
};

/// What happens to an edge that is flipped again and again (Algorithm 4 of the paper, cuDT, section 4.4.4;
/// docs/evaluation.md). Hull edges are always flipped.
enum class Stabilize {
  off,    ///< nothing: with exact predicates flips terminate
  defer,  ///< after more than `Tuning::flip_threshold` flips it is left to the legality sweep. The same mesh
  paper   ///< after that it is flipped only if that improves quality enough: the mesh may keep illegal edges
          ///< (`Statistics::illegal_edges`), depends on the schedule, and is not certified. OptionError with segments
          ///< and polygons
};
/// "off", "defer", "paper".
[[nodiscard]] CADT_API std::string_view to_string(Strategy strategy) noexcept;
[[nodiscard]] CADT_API std::string_view to_string(Stabilize mode) noexcept;

/// Progress of a running triangulation, for `Options::progress`.
struct Progress {
  std::string_view phase;  ///< what is done now, such as "sort", "stars", "insert", "constrain" or "output"
  /// Of the whole work, 0 to 1, never decreasing, except that Crossing::exact begins anew where segments cross.
  double fraction;
};

/// The mesh between two launches of a running triangulation. The spans are valid during the call only.
struct Snapshot {
  std::size_t points = 0;                        ///< number of points inserted so far
  std::span<const std::int32_t> triangles = {};  ///< n x 3 input indices, counterclockwise; not yet all Delaunay
  /// Of insertion, from 1 on: each level has as many points as all before it together, except the first and the last.
  /// A large one takes several launches.
  unsigned level = 0;
  /// The last snapshot of a Delaunay triangulation: the legality sweep is over, and these are the triangles of the
  /// result; of a call with segments it is that before they are inserted.
  bool complete = false;
  /// Points and edges that got no locks, or had no place in a worklist, and wait for the next launch.
  std::uint64_t waiting_points = 0, waiting_edges = 0;
  /// Work and conflicts of the call up to here; zeros with StatisticsDetail::none. What only the end can tell is not in
  /// it before `complete`: certified_edges, illegal_edges, certified, flips_per_edge, and times.
  Statistics statistics = {};
  /// One a triangle: flips of its three edges, counted as in Statistics::flips_per_edge.
  std::span<const std::uint32_t> flips = {};
  /// One a triangle: how often a thread has locked its slot and changed it, by a split or flip of it or beside it.
  std::span<const std::uint32_t> changes = {};
  /// One a triangle: attempts to lock its slot that failed. With StatisticsDetail::timing alone, and only where
  /// Statistics::thread_time is not empty; else empty. They and those of triangles at the hull's outside, which are not
  /// shown, add up to Statistics::lock_failures.
  std::span<const std::uint32_t> lost_locks = {};
};

/// How the work is done: for those who measure, tune or repeat the paper. The mesh does not depend on it, but with
/// Stabilize::paper.
struct Tuning {
  /// Strategy::stars with `stabilize` or `watch` is an OptionError: those apply to insertion.
  Strategy strategy = Strategy::automatic;
  /// Work-group (block) size on a device; 0: the library chooses.
  unsigned work_group_size = 0;
  /// Consecutive elements that one work-item of a CPU processes; 0: the library chooses. Small numbers make threads
  /// work side by side: slower, with many conflicts (for tests).
  unsigned grain = 0;
  /// Times each kernel (Statistics::kernels) by the device's clock. The markers in the queue cost some microseconds a
  /// launch; without this there are none. A queue of the caller must have CL_QUEUE_PROFILING_ENABLE, else OptionError.
  bool kernel_times = false;
  Stabilize stabilize = Stabilize::off;
  /// R of Algorithm 4: flips of an edge slot before `stabilize` applies. At most 1000.
  unsigned flip_threshold = 3;
  /// Epsilon of Algorithm 4 (Stabilize::paper): an illegal edge is left if its incircle determinant, divided by the
  /// fourth power of the largest coordinate difference, is below this, and a flip raises the smallest angle of the two
  /// triangles by at most this many degrees. Not negative, not NaN.
  double quality_epsilon = 1e-4;
  /// Called on the calling thread with a copy of the mesh, for pictures: after each launch of a level of points, and
  /// once more when the mesh is complete; segments are not shown. Never for points without triangles. Costs a copy of
  /// the whole mesh each time. Must not throw.
  std::function<void(const Snapshot&)> watch;
  /// With `watch`: a launch inserts at most this many points, so a level is seen in several steps, along the curve.
  /// 0: the library chooses.
  std::size_t watch_points = 0;
};

struct Options {
  Backend backend = Backend::automatic;
  /// Device of the back end: its number from `list_devices()`, or a part of its name. Empty: the first usable GPU, else
  /// the first usable device, among those with double precision. Devices without (`DeviceInfo::fp64`) take float
  /// coordinates only: with doubles BackendUnavailable, with Strategy::stars OptionError.
  std::string device;
  /// Host threads at most; 0: one for each core, 1: serial (the reference). Small sets are left to one of them. Where
  /// the system starts fewer, those do the work (Statistics::threads).
  /// With a GPU: those that copy large sets and results and make the pages of results.
  unsigned threads = 0;
  Order order = Order::canonical;
  /// For points of the host, and not for batches.
  KeepPoints keep_points = KeepPoints::no;
  /// Limit of the device memory that the library holds, in bytes; 0: none. If a call needs more: OutOfMemory.
  /// Triangulations, batches and polygons of at most 512 points say before any work what all of it needs. Segments and
  /// larger polygons (what their mesh without segments needs is told before any work), queries, verify_on_device,
  /// finish_leaf and finish_join keep to the limit step by step: OutOfMemory::needed() is that of the first step that
  /// did not fit, and later ones may need more. (Earlier results of a triangulator that still exist count as well.)
  std::size_t max_memory = 0;
  /// The caller's stream (a cudaStream_t, also a default stream) or in-order queue (a cl_command_queue): all work is
  /// enqueued there, on its device. Requires a named back end. It must outlive the triangulator and its results. Not
  /// set: a queue of the library's own.
  std::optional<void*> queue;
  /// Source of device memory. Null: the library allocates it.
  std::shared_ptr<DeviceAllocator> allocator;
  StatisticsDetail statistics = StatisticsDetail::counters;
  /// Checked between launches, which take a second or more on CPUs where millions of segments cross or millions of
  /// queries are asked, and during work on the host; once triggered, the call throws Cancelled. std::stop_token where
  /// the standard library has it.
  cadt::stop_token stop;
  /// Called on the calling thread between launches. Must not throw.
  std::function<void(const Progress&)> progress;
  /// For those who measure, tune or repeat the paper.
  Tuning tuning;
};

}  // namespace cadt
