// SPDX-License-Identifier: Apache-2.0
// The Delaunay triangulation of a set of points in the plane.
#pragma once

#include <cadt/export.hpp>
#include <cadt/points.hpp>
#include <cadt/statistics.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace cadt {

/// Where the triangulation is computed. `automatic` takes the fastest usable device: a GPU if there is one, else the
/// host. The function triangulate() takes the host for fewer than 200,000 points, unless `Options::device` names a
/// device: opening a GPU takes longer.
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

/// How the mesh is computed. The result does not depend on it.
enum class Strategy {
  automatic,  ///< the faster one, as far as is known for the device and the points
  locks,      ///< parallel insertion and flips in one shared mesh
  stars  ///< local stars, proven without locks, where possible; the residual vertices by gift wrapping and insertion
};

/// What happens to an edge that is flipped again and again (paper, section 4.4.4, Algorithm 4). Hull edges are always
/// flipped.
enum class Stabilize {
  off,    ///< nothing: with exact predicates flips terminate
  defer,  ///< after more than `Options::flip_threshold` flips it is left to the legality sweep. The same mesh
  paper   ///< after that it is flipped only if that improves quality enough: the mesh may keep illegal edges
          ///< (`Statistics::illegal_edges`), depends on the schedule, and is not certified
};
/// "off", "defer", "paper".
[[nodiscard]] CADT_API std::string_view to_string(Strategy strategy) noexcept;
[[nodiscard]] CADT_API std::string_view to_string(Stabilize mode) noexcept;

/// Progress of a running triangulation, for `Options::progress`.
struct Progress {
  std::string_view phase;  ///< "sort", "insert", "certify", "output"
  double fraction;         ///< of the whole work, 0 to 1, never decreasing
};

/// The mesh between two launches of a running triangulation.
struct Snapshot {
  std::size_t points;                       ///< number of points inserted so far
  std::span<const std::int32_t> triangles;  ///< n x 3 input indices, counterclockwise; not yet all Delaunay
};

struct Options {
  Backend backend = Backend::automatic;
  /// Device of the back end: its number from `list_devices()`, or a part of its name. Empty: the first usable GPU, else
  /// the first usable device, among those with double precision. Devices without (`DeviceInfo::fp64`) take float
  /// coordinates only: with doubles BackendUnavailable, with Strategy::stars OptionError.
  std::string device;
  /// Host threads at most; 0: one for each core, 1: serial (the reference). Small sets are left to one of them.
  unsigned threads = 0;
  Order order = Order::canonical;
  /// Limit of the device memory that the library holds, in bytes; 0: none. If a call needs more: OutOfMemory, before
  /// any work. (Earlier results of a triangulator that still exist count as well.)
  std::size_t max_memory = 0;
  /// Work-group (block) size on a device; 0: the library chooses.
  unsigned work_group_size = 0;
  /// Consecutive elements that one work-item of a CPU processes; 0: the library chooses. Small numbers make threads
  /// work side by side: slower, with many conflicts (for tests).
  unsigned grain = 0;
  /// The caller's stream (a cudaStream_t, also a default stream) or in-order queue (a cl_command_queue): all work is
  /// enqueued there, on its device. Requires a named back end. It must outlive the triangulator and its results. Not
  /// set: a queue of the library's own.
  std::optional<void*> queue;
  /// Source of device memory. Null: the library allocates it.
  std::shared_ptr<DeviceAllocator> allocator;
  /// Strategy::stars with `stabilize` or `watch` is an OptionError: those apply to insertion.
  Strategy strategy = Strategy::automatic;
  Stabilize stabilize = Stabilize::off;
  /// R of Algorithm 4: flips of an edge slot before `stabilize` applies. At most 1000.
  unsigned flip_threshold = 3;
  /// Epsilon of Algorithm 4 (Stabilize::paper): an illegal edge is left if its incircle determinant, divided by the
  /// fourth power of the largest coordinate difference, is below this, and a flip raises the smallest angle of the two
  /// triangles by at most this many degrees. Not negative, not NaN.
  double quality_epsilon = 1e-4;
  StatisticsDetail statistics = StatisticsDetail::counters;
  /// Times each kernel (Statistics::kernels) by the device's clock. The markers in the queue cost some microseconds a
  /// launch; without this option there are none. A queue of the caller must have CL_QUEUE_PROFILING_ENABLE, else
  /// OptionError.
  bool kernel_times = false;
  /// Called on the calling thread with a copy of the mesh, for pictures: after each launch of a level of points, and
  /// once more if deferred points were inserted. Costs a copy of the whole mesh each time. The snapshot is valid during
  /// the call only. Must not throw.
  std::function<void(const Snapshot&)> watch;
  /// Checked between launches; once triggered, the call throws Cancelled.
  std::stop_token stop;
  /// Called on the calling thread between launches. Must not throw.
  std::function<void(const Progress&)> progress;
};

/// A 128-bit hash of a canonical mesh.
struct CADT_API Hash128 {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const Hash128&, const Hash128&) = default;
  /// 32 lower-case hexadecimal digits.
  [[nodiscard]] std::string to_string() const;
};

/// An input point that equals an earlier one (-0.0 equals 0.0), and the lowest index that it equals: its
/// representative, which is the vertex. Both 0-based.
struct Duplicate {
  std::int32_t point;
  std::int32_t representative;
  friend bool operator==(const Duplicate&, const Duplicate&) = default;
};

/// A triangulation. Indices are those of the input, 0-based. The set of triangles is a function of the point set alone:
/// ties between cocircular points are broken by the symbolic perturbation of Devillers and Teillaud ("Perturbations and
/// vertex removal in a 3D Delaunay triangulation", SODA 2003) in the lexicographic order of the points, as in CGAL.
/// Spans are valid as long as this object lives and is not moved from. const functions may run concurrently.
class CADT_API Triangulation {
 public:
  Triangulation();
  ~Triangulation();
  Triangulation(Triangulation&&) noexcept;
  Triangulation& operator=(Triangulation&&) noexcept;

  /// Number of input points.
  [[nodiscard]] std::size_t number_of_points() const noexcept;
  /// Number of triangles: 2 * distinct - 2 - (points on the hull), or 0 if dimension() < 2.
  [[nodiscard]] std::size_t number_of_triangles() const noexcept;

  /// Vertices: number_of_triangles() x 3 input indices, counterclockwise.
  [[nodiscard]] std::span<const std::int32_t> triangles() const noexcept;
  /// Neighbours: number_of_triangles() x 3 triangle indices; the k-th is opposite vertex k, -1 outside.
  [[nodiscard]] std::span<const std::int32_t> neighbors() const noexcept;
  /// The hull: input indices as one counterclockwise loop that starts with the smallest, including points on hull
  /// edges. Empty if dimension() < 2.
  [[nodiscard]] std::span<const std::int32_t> hull() const noexcept;
  /// Points that are not vertices because they equal an earlier one, ascending by point.
  [[nodiscard]] std::span<const Duplicate> duplicates() const noexcept;
  /// Dimension of the point set: -1 no points, 0 one distinct point, 1 collinear points, 2 otherwise.
  [[nodiscard]] int dimension() const noexcept;
  /// For each input point the lowest triangle that has it as a vertex; -1 if dimension() < 2. A duplicate has that of
  /// its representative. O(points + triangles).
  [[nodiscard]] std::vector<std::int32_t> vertex_triangle() const;
  /// Hash of the set of triangles, the hull size and the duplicates; the same for every device, order of triangles and
  /// call. O(triangles).
  [[nodiscard]] Hash128 hash() const;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  struct Data;  // internal
  explicit Triangulation(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// Number of triangles of `mesh` that are not in `other`, both over the same points. O(n log n).
[[nodiscard]] CADT_API std::size_t count_differing(const Triangulation& mesh, const Triangulation& other);

/// Most points that one call accepts: a triangle index and an edge number share 32 bits, and there are two triangle
/// slots a point.
[[nodiscard]] constexpr std::size_t max_points() noexcept { return (std::size_t{1} << 29) - 2; }

/// Triangulates the points, which are read only and need to live until the call returns. For repeated calls with many
/// points use a Triangulator, which keeps the device open. With up to 16,383 points on the host the calling thread
/// works alone and keeps up to 8 MiB of memory for its next call, until it ends. Expected O(n log n) work for the sort
/// and O(n) for the rest on well-spread points. Thread-safe; calls from `Options::progress` are allowed.
[[nodiscard]] CADT_API Triangulation triangulate(PointsView points, const Options& options = {});

}  // namespace cadt
