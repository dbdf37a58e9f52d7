// SPDX-License-Identifier: Apache-2.0
// The Delaunay triangulation of a point set of the plane.
#pragma once

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

/// Where the work is done. `automatic` takes the fastest usable device: a GPU if there is one, else the host.
enum class Backend { automatic, host, opencl, cuda };

/// "auto", "host", "opencl", "cuda".
[[nodiscard]] std::string_view to_string(Backend backend) noexcept;
/// Inverse of `to_string`; throws BackendUnavailable for any other word.
[[nodiscard]] Backend backend_from_string(std::string_view name);

class DeviceAllocator;  // triangulator.hpp

/// Order of the triangles in the result.
enum class Order {
  canonical,  ///< each triangle starts with its smallest index, triangles ascend: equal arrays from every device and
              ///< run
  fast        ///< as the device left them: the same set, in an order that depends on the schedule
};

/// How the mesh is made. The result is the same.
enum class Strategy {
  automatic,  ///< what is faster, as far as the device is known
  locks,      ///< insertion and flips in one shared mesh
  stars       ///< as many stars as can be proven without locks; the other points by insertion
};

/// What is done with an edge that is flipped again and again (paper, section 4.4.4, Algorithm 4). Hull edges are always
/// flipped.
enum class Stabilize {
  off,    ///< nothing: with exact predicates flips cannot go round in circles
  defer,  ///< flipped more than `Options::flip_threshold` times, it is left to the closing pass. The same mesh
  paper   ///< from then on it is flipped only if that gains enough quality: the mesh may keep illegal edges
          ///< (`Statistics::illegal_edges`), depends on the schedule, and is not certified
};
/// "off", "defer", "paper".
[[nodiscard]] std::string_view to_string(Strategy strategy) noexcept;
[[nodiscard]] std::string_view to_string(Stabilize mode) noexcept;

/// State of a running triangulation, as told to `Options::progress`.
struct Progress {
  std::string_view phase;  ///< "sort", "insert", "certify", "output"
  double fraction;         ///< of the whole work, 0 to 1, never decreasing
};

/// The mesh between two launches of a running triangulation.
struct Snapshot {
  std::size_t points;                       ///< in the mesh by now
  std::span<const std::int32_t> triangles;  ///< of input indices, n x 3, counterclockwise; not all Delaunay yet
};

struct Options {
  Backend backend = Backend::automatic;
  /// Device of the back end: its number as `list_devices()` gives it, or a part of its name. Empty: the
  /// first usable GPU, else the first usable one, of those with double precision. Others (`DeviceInfo::fp64`) take
  /// float coordinates alone: doubles are BackendUnavailable, Strategy::stars is an OptionError.
  std::string device;
  /// Host threads; 0 takes all cores, 1 runs serially (the reference).
  unsigned threads = 0;
  Order order = Order::canonical;
  /// Upper bound for the device memory that the library holds, in bytes; 0 means no bound. Above it: OutOfMemory,
  /// before any work. (A triangulator counts its earlier results that are still there as well.)
  std::size_t max_memory = 0;
  /// Work-group (block) size on a device; 0 lets the library choose.
  unsigned work_group_size = 0;
  /// Neighbouring elements that one work-item of a CPU takes in a row; 0 lets the library choose. Small numbers put
  /// several threads to work in one place: slower, and full of conflicts.
  unsigned grain = 0;
  /// The caller's stream (a cudaStream_t, the default stream too) or in-order queue (a cl_command_queue): all work is
  /// put there, on its device. Needs the back end to be named. Not given: one of the library's own.
  std::optional<void*> queue;
  /// Where device memory comes from. Null: the library allocates it.
  std::shared_ptr<DeviceAllocator> allocator;
  /// Strategy::stars with `stabilize` or `watch` is refused: they show insertion.
  Strategy strategy = Strategy::automatic;
  Stabilize stabilize = Stabilize::off;
  /// R of Algorithm 4: flips of an edge slot before `stabilize` applies to it. At most 1000.
  unsigned flip_threshold = 3;
  /// Epsilon of Algorithm 4 (Stabilize::paper): an edge is left as it is if its incircle determinant, divided by the
  /// fourth power of the largest coordinate difference, is below this, and a flip raises the smallest angle of the two
  /// triangles by at most so many degrees. Not negative and not NaN.
  double quality_epsilon = 1e-4;
  StatisticsDetail statistics = StatisticsDetail::counters;
  /// Times each kernel (Statistics::kernels), by the device's own clock. The marks in its queue cost some microseconds
  /// a launch; without this there are none. A queue of the caller's must have been made with CL_QUEUE_PROFILING_ENABLE,
  /// else OptionError.
  bool kernel_times = false;
  /// Called from the calling thread with a copy of the mesh, for pictures: after each launch of a level of points, and
  /// once more if some were left over. Costs a copy of all records each time. Must not throw.
  std::function<void(const Snapshot&)> watch;
  /// Checked between launches; when triggered the call throws Cancelled.
  std::stop_token stop;
  /// Called from the calling thread between launches. Must not throw.
  std::function<void(const Progress&)> progress;
};

/// A 128-bit fingerprint of a canonical mesh.
struct Hash128 {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const Hash128&, const Hash128&) = default;
  /// 32 lower-case hexadecimal digits.
  [[nodiscard]] std::string to_string() const;
};

/// An input point that equals another one (-0.0 equals 0.0) and the one with the lowest index, which stands for it.
struct Duplicate {
  std::int32_t point;
  std::int32_t representative;
  friend bool operator==(const Duplicate&, const Duplicate&) = default;
};

/// A finished triangulation. Indices are those of the input, 0-based. The set of triangles is a function of the point
/// set alone: cocircular points are decided by the symbolic perturbation of Devillers and Teillaud ("Perturbations and
/// vertex removal in a 3D Delaunay triangulation", SODA 2003) by the lexicographic order of the points, as CGAL does.
class Triangulation {
 public:
  Triangulation();
  ~Triangulation();
  Triangulation(Triangulation&&) noexcept;
  Triangulation& operator=(Triangulation&&) noexcept;

  /// Number of input points.
  [[nodiscard]] std::size_t number_of_points() const noexcept;
  /// Number of triangles: 2 * distinct - 2 - (points on the hull), or 0 if dimension() < 2.
  [[nodiscard]] std::size_t number_of_triangles() const noexcept;

  /// Vertices, number_of_triangles() x 3, counterclockwise.
  [[nodiscard]] std::span<const std::int32_t> triangles() const noexcept;
  /// Neighbours, number_of_triangles() x 3: the k-th is opposite vertex k; -1 outside.
  [[nodiscard]] std::span<const std::int32_t> neighbors() const noexcept;
  /// Boundary as one counterclockwise loop from its smallest index, with the points that lie on its edges.
  /// Empty if dimension() < 2.
  [[nodiscard]] std::span<const std::int32_t> hull() const noexcept;
  /// Points that are not vertices because they equal another one, ascending by point.
  [[nodiscard]] std::span<const Duplicate> duplicates() const noexcept;
  /// Dimension of the point set: -1 no points, 0 one distinct point, 1 all on a line, 2 else.
  [[nodiscard]] int dimension() const noexcept;
  /// For each input point the lowest triangle that has it as a vertex; -1 if dimension() < 2. A duplicate gets that of
  /// its representative. O(points + triangles).
  [[nodiscard]] std::vector<std::int32_t> vertex_triangle() const;
  /// Fingerprint of the set of triangles, the hull size and the duplicates; the same for every device, order of
  /// triangles and run. O(triangles).
  [[nodiscard]] Hash128 hash() const;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  struct Data;  // internal
  explicit Triangulation(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// Triangles of `mesh` that are none of `other`, both over the same points. O(n log n).
[[nodiscard]] std::size_t count_differing(const Triangulation& mesh, const Triangulation& other);

/// Most points that one call accepts: a record index and an edge number share 32 bits, and there are two records a
/// point.
[[nodiscard]] constexpr std::size_t max_points() noexcept { return (std::size_t{1} << 29) - 2; }

/// Triangulates the points. Expected O(n log n) work for the sort and O(n) for the rest on well-spread points.
///
/// Throws OptionError, InputError (NaN or infinity, with the index of the first), LimitError (more than max_points()),
/// BackendUnavailable, OutOfMemory, DeviceError, KernelBuildError, Cancelled.
[[nodiscard]] Triangulation triangulate(PointsView points, const Options& options = {});

}  // namespace cadt
