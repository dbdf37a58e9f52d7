// SPDX-License-Identifier: Apache-2.0
// For repeated calls, and for points in device memory: the device is opened once, its memory is reused, and nothing is
// copied to the host unless requested.
#pragma once

#include <cadt/batch.hpp>
#include <cadt/constrained.hpp>
#include <cadt/devices.hpp>
#include <cadt/export.hpp>
#include <cadt/points.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/verify.hpp>

#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <span>

namespace cadt {

/// Type of the coordinates in device memory.
enum class Scalar { float64, float32 };

/// Points in the memory of the triangulator's device. A handle is:
///
///     cuda     a device pointer (or a managed one)
///     opencl   a cl_mem buffer of the context of the triangulator's queue
///     host     a pointer
///
/// The points are read in the order of the triangulator's stream or queue and never written. They must not change until
/// the call has returned, or its future is ready.
struct DevicePoints {
  const void* x = nullptr;  ///< n x 2: x0 y0 x1 y1 ...; only x if `y` is given
  const void* y = nullptr;  ///< y0 y1 ...; null for interleaved coordinates
  std::size_t size = 0;     ///< points
  Scalar scalar = Scalar::float64;
  /// Points to skip at the start (OpenCL buffers have no pointer arithmetic); at most 1.6e9, else LimitError.
  std::size_t skip = 0;
};

/// Memory of the caller's on the triangulator's device, for results. Handles as for DevicePoints.
struct DeviceArray {
  void* memory = nullptr;
  std::size_t size =
      0;  ///< elements (int32 or double); a result that needs more is an InputError, and nothing is written
};

/// A triangulation in device memory: int32 arrays of 0-based indices, as in Triangulation. The handles (see
/// DevicePoints) are valid on the triangulator's stream or queue, in its order, as long as this object lives; it may
/// outlive the triangulator, but not the caller's stream or queue. Not thread-safe: do not use it while another thread
/// uses the triangulator.
class CADT_API DeviceTriangulation {
 public:
  DeviceTriangulation();
  ~DeviceTriangulation();
  DeviceTriangulation(DeviceTriangulation&&) noexcept;
  DeviceTriangulation& operator=(DeviceTriangulation&&) noexcept;

  [[nodiscard]] std::size_t number_of_points() const noexcept;
  [[nodiscard]] std::size_t number_of_triangles() const noexcept;
  /// Handle of the vertices: number_of_triangles() x 3 words, counterclockwise; null if there are no triangles.
  [[nodiscard]] void* triangles() const noexcept;
  /// Handle of the neighbours: number_of_triangles() x 3 words; the k-th is opposite vertex k, -1 outside; null if
  /// there are no triangles.
  [[nodiscard]] void* neighbors() const noexcept;
  /// Of triangulate_constrained: handle of the constrained edges, a word a triangle: bit k for the edge opposite vertex
  /// k. Null if there are no triangles, or of triangulate.
  [[nodiscard]] void* edge_flags() const noexcept;
  /// Handles of the vertices along the segments, as ConstrainedTriangulation::chain_vertices(): segment s has those
  /// from word s of the offsets to that before word s + 1. The offsets are null without segments; chain_length() is 0
  /// if all are degenerate.
  [[nodiscard]] void* chain_offsets() const noexcept;
  [[nodiscard]] void* chain_vertices() const noexcept;
  [[nodiscard]] std::size_t chain_length() const noexcept;
  /// With a ConstraintOptions::domain other than hull: handles of the region of each triangle, numbered by their lowest
  /// triangles from 0, and of whether it is inside, a word each: 1 or 0; of the value of each region, a word, and its
  /// attribute, a double (ConstrainedTriangulation::region_value, region_attribute). Null if there are none.
  [[nodiscard]] void* regions() const noexcept;
  [[nodiscard]] void* inside() const noexcept;
  [[nodiscard]] std::size_t number_of_regions() const noexcept;
  [[nodiscard]] void* region_values() const noexcept;
  [[nodiscard]] void* region_attributes() const noexcept;
  /// The triangles inside alone, 3 words each, in the same order, and their neighbours, -1 for one that is not inside.
  /// Null with Domain::hull, or if there are none.
  [[nodiscard]] void* triangles_inside() const noexcept;
  [[nodiscard]] void* neighbors_inside() const noexcept;
  [[nodiscard]] std::size_t number_inside() const noexcept;
  /// Of segments that cross: how many crossings are vertices, numbered behind the input's points and counted by
  /// number_of_points(). Handles of the coordinates of all of these, two doubles each, crossings rounded to the
  /// nearest, and of the lowest pair of segments that cross at each crossing, two words; null without crossings. With
  /// Crossing::grid coordinates are there of any points: where all have moved.
  [[nodiscard]] std::size_t number_added() const noexcept;
  [[nodiscard]] void* all_points() const noexcept;
  [[nodiscard]] void* added_parents() const noexcept;
  /// Whether the triangles are still counterclockwise with the rounded coordinates. True without crossings.
  [[nodiscard]] bool rounded_valid() const noexcept;
  /// Number of points that equal an earlier one.
  [[nodiscard]] std::size_t number_of_duplicates() const noexcept;
  /// Handles of number_of_duplicates() words each: the points, ascending, and the representative of each; null if there
  /// are none.
  [[nodiscard]] void* duplicate_points() const noexcept;
  [[nodiscard]] void* representatives() const noexcept;
  /// As Triangulation::dimension().
  [[nodiscard]] int dimension() const noexcept;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  /// A copy on the host, with the hull; waits for the device. O(triangles). \throws DeviceError, OutOfMemory
  [[nodiscard]] Triangulation download() const;
  /// The same with all of the segments. O(triangles + segments). \throws DeviceError, OutOfMemory
  [[nodiscard]] ConstrainedTriangulation download_constrained() const;

  struct Data;  // internal
  explicit DeviceTriangulation(std::unique_ptr<Data> data);
  [[nodiscard]] const Data& data() const noexcept { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// An open device with its memory. Not thread-safe: one thread at a time may use a triangulator; different ones are
/// independent.
///
/// CUDA: device and context are those of `Options::queue`, else the device that `Options::device` names, else the
/// caller's current one. Each call makes its context current and restores the caller's. No call synchronises the device
/// or the default stream, but opening may (it loads the kernels), and so may allocating more memory (see reserve).
///
///     cadt::Options options;
///     options.backend = cadt::Backend::cuda;
///     options.queue = stream;                                    // a cudaStream_t
///     cadt::Triangulator triangulator(options);
///     auto mesh = triangulator.triangulate(cadt::DevicePoints{.x = xy, .size = n});
///     kernel<<<blocks, threads, 0, stream>>>(static_cast<const int*>(mesh.triangles()), mesh.number_of_triangles());
class CADT_API Triangulator {
 public:
  /// Opens the device and runs its self-test. \throws BackendUnavailable, KernelBuildError, DeviceError, OptionError
  explicit Triangulator(const Options& options = {});
  ~Triangulator();
  Triangulator(Triangulator&&) noexcept;
  Triangulator& operator=(Triangulator&&) noexcept;

  [[nodiscard]] const DeviceInfo& device() const noexcept;
  /// `backend`, `device`, `threads`, `queue` and `allocator`, and of `tuning` `work_group_size` and `kernel_times`, are
  /// read once, when the device is opened; the other options may be changed between calls.
  [[nodiscard]] Options& options() noexcept;
  /// Theoretical occupancy of the insertion kernel with work groups of this size: resident warps over the maximum, 0 to
  /// 1; 0 if groups of this size cannot be launched (a call then uses the largest size that can). Empty where the
  /// device does not report it: only CUDA does.
  [[nodiscard]] std::optional<double> occupancy(unsigned work_group_size) const;

  /// Triangulates points on the host; the mesh is on the host. \throws as cadt::triangulate
  [[nodiscard]] Triangulation triangulate(PointsView points);
  /// Triangulates points on the device; the mesh is on the device and complete when the call returns. With a queue of
  /// the caller (Options::queue), StatisticsDetail::none and no Tuning::kernel_times it is complete in the order of
  /// that queue: its last kernels may still be pending. \throws as cadt::triangulate, and InputError for a null handle.
  /// After an error the triangulator can be used again.
  [[nodiscard]] DeviceTriangulation triangulate(const DevicePoints& points);

  /// Triangulates points with segments between them, as cadt::triangulate_constrained. \throws as that
  [[nodiscard]] ConstrainedTriangulation triangulate_constrained(PointsView points, std::span<const Segment> segments,
                                                                 const ConstraintOptions& constraints = {});
  /// The same with points and segments on the device, where the mesh stays: `segments` are pairs of indices, two words
  /// a segment. Points and segments are copied to the host, and the mesh back, with Crossing::grid and where the device
  /// cannot find what crosses (several segments through one place, very many through the same triangles); with
  /// Domain::seeds, points and triangles are copied there. \throws as cadt::triangulate_constrained
  [[nodiscard]] DeviceTriangulation triangulate_constrained(const DevicePoints& points, const DeviceArray& segments,
                                                            const ConstraintOptions& constraints = {});

  /// The mesh in arrays of the caller's, three words a triangle: on the host, or on the device, e.g. in buffers that a
  /// graphics library has mapped. There are at most 2 triangles a point; an array that is empty is left out. Returns
  /// the number of triangles. Costs a copy on the device, or what a copy to the host costs. \throws InputError if there
  /// are more than an array takes, with the number that it takes as index: then nothing is written
  std::size_t triangulate(PointsView points, std::span<std::int32_t> triangles, std::span<std::int32_t> neighbors);
  std::size_t triangulate(const DevicePoints& points, const DeviceArray& triangles, const DeviceArray& neighbors);

  /// The first two on a thread of their own, so that the caller's thread is free: a call waits for the device some ten
  /// times. Until the future is ready the triangulator must not be used otherwise, and points, offsets and options must
  /// not change. `Options::progress` is called on that thread. The future rethrows what the call throws; destroying it
  /// waits.
  [[nodiscard]] std::future<Triangulation> triangulate_async(PointsView points);
  [[nodiscard]] std::future<DeviceTriangulation> triangulate_async(const DevicePoints& points);

  /// Many point sets, as cadt::triangulate_batch. Sets of up to 32,768 points (CPUs: 8,192) are triangulated batched,
  /// some 16 million points at a time: with common launches, and without locks. Larger sets, on graphics cards those
  /// with a vertex of more than 39 neighbours and all sets with Strategy::locks, and everywhere all sets with
  /// `Tuning::stabilize` or on a device without double precision, are triangulated individually within the same call.
  /// \throws OptionError for `Tuning::watch`
  [[nodiscard]] TriangulationBatch triangulate_batch(PointsView points, std::span<const std::size_t> offsets);
  [[nodiscard]] DeviceTriangulationBatch triangulate_batch(const DevicePoints& points,
                                                           std::span<const std::size_t> offsets);
  [[nodiscard]] std::future<TriangulationBatch> triangulate_batch_async(PointsView points,
                                                                        std::span<const std::size_t> offsets);
  [[nodiscard]] std::future<DeviceTriangulationBatch> triangulate_batch_async(const DevicePoints& points,
                                                                              std::span<const std::size_t> offsets);

  /// Verifies a mesh on the device (verify.hpp: verify_on_device) without copying it to the host, except for the
  /// boundary and what the device cannot decide. A mesh without triangles is checked on the host, and so is any mesh of
  /// a device without double precision. Of constrained edges the circle is not asked; whether each segment is there,
  /// cadt::verify of download_constrained() tells. \throws as cadt::verify_on_device, and InputError for a mesh of
  /// another triangulator, or in which crossings have moved or added points
  [[nodiscard]] VerifyReport verify(const DevicePoints& points, const DeviceTriangulation& mesh,
                                    const VerifyOptions& options = {});

  /// Upper bound of the device memory for a first call with `points` points, in bytes: with its result and the memory
  /// cached for the next call, without the caller's points on the device. 124 a point where the device or
  /// `Options::allocator` pools memory, else 176, and 228 with local stars (Tuning::strategy); and up to 256 KiB. With
  /// `Options::max_memory` 124 are enough, on the host 97 for a mesh on the host; with local stars 71, or 83 for points
  /// on the host (below 85 and 101 a call takes about 5 % more time, 45 % in the canonical order), unless more than
  /// about 4 % of the vertices are residual. Over-full cells (more than 16 points in 2^-16 of the bounding box's width)
  /// need up to 32 bytes more for each of their points while they are sorted. Of more than max_points() points: the
  /// largest number.
  [[nodiscard]] std::size_t memory_needed(std::size_t points) const noexcept;
  /// Memory for results of queries, from where the triangulator's own comes (`Options::allocator`, else the library):
  /// its handle, as for DevicePoints; null for 0 bytes. It is used in the order of the triangulator's stream or queue,
  /// counts in `Options::max_memory`, and lives as a DeviceTriangulation does. \throws OutOfMemory
  [[nodiscard]] std::shared_ptr<void> allocate(std::size_t bytes);
  /// Allocates the memory for calls with up to `points` points now; with a caller's allocator it does nothing. Keeps no
  /// more than `Options::max_memory`. \throws LimitError, OutOfMemory
  void reserve(std::size_t points);
  /// Releases all memory that no result holds.
  void release_memory();

  struct State;  // internal
  [[nodiscard]] const std::shared_ptr<State>& state() const noexcept { return state_; }

 private:
  std::shared_ptr<State> state_;
};

/// Device memory from the caller, e.g. from a framework's pool. The triangulator and its results share it; calls come
/// from one thread at a time. Must not throw.
class CADT_API DeviceAllocator {
 public:
  virtual ~DeviceAllocator() = default;
  /// Returns memory of at least `bytes` bytes, aligned to 256: a device pointer that may be used on `queue` (a
  /// cudaStream_t) from now on, a new cl_mem of the context of `queue` (a cl_command_queue), or a host pointer (`queue`
  /// is null). Null if there is none left.
  [[nodiscard]] virtual void* allocate(std::size_t bytes, void* queue) noexcept = 0;
  /// Takes the memory back; work that uses it may still be pending in `queue`.
  virtual void deallocate(void* memory, std::size_t bytes, void* queue) noexcept = 0;
};

}  // namespace cadt
