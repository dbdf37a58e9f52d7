// SPDX-License-Identifier: Apache-2.0
// For many calls, and for points that are in device memory already: the device is opened once, its memory is kept, and
// nothing is copied to the host unless it is asked for.
#pragma once

#include <cadt/batch.hpp>
#include <cadt/devices.hpp>
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

/// Points that are in the memory of the triangulator's device. A handle is what the device's language calls memory:
///
///     cuda     a device pointer (or a managed one)
///     opencl   a cl_mem buffer of the context of the triangulator's queue
///     host     a pointer
///
/// The points are read in the order of the triangulator's stream or queue and never written. They must stay as they are
/// until the call has returned, or its future is ready.
struct DevicePoints {
  const void* x = nullptr;  ///< x0 y0 x1 y1 ..., or only x if `y` is given
  const void* y = nullptr;  ///< y0 y1 ..., or null for interleaved coordinates
  std::size_t size = 0;     ///< points
  Scalar scalar = Scalar::float64;
  /// Points before the first one (OpenCL buffers have no pointer arithmetic), at most 1.6e9; else LimitError.
  std::size_t skip = 0;
};

/// A finished triangulation in device memory: int32 arrays, indices of the input points, 0-based, as in Triangulation.
/// The handles (see DevicePoints) are valid on the triangulator's stream or queue, in its order, until this object is
/// gone; it may outlive the triangulator, but not the caller's stream or queue. It must not be used while another
/// thread uses the triangulator.
class DeviceTriangulation {
 public:
  DeviceTriangulation();
  ~DeviceTriangulation();
  DeviceTriangulation(DeviceTriangulation&&) noexcept;
  DeviceTriangulation& operator=(DeviceTriangulation&&) noexcept;

  [[nodiscard]] std::size_t number_of_points() const noexcept;
  [[nodiscard]] std::size_t number_of_triangles() const noexcept;
  /// Handle of the vertices, number_of_triangles() x 3, counterclockwise; null if there are no triangles.
  [[nodiscard]] void* triangles() const noexcept;
  /// Handle of the neighbours, number_of_triangles() x 3: the k-th is opposite vertex k; -1 outside.
  [[nodiscard]] void* neighbors() const noexcept;
  /// Points that equal another one.
  [[nodiscard]] std::size_t number_of_duplicates() const noexcept;
  /// Handles of number_of_duplicates() words each: the points, ascending, and the lowest index that each one equals;
  /// null if there are none.
  [[nodiscard]] void* duplicate_points() const noexcept;
  [[nodiscard]] void* representatives() const noexcept;
  /// As Triangulation::dimension().
  [[nodiscard]] int dimension() const noexcept;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  /// A copy on the host, with the hull. O(triangles). \throws DeviceError, OutOfMemory
  [[nodiscard]] Triangulation download() const;

  struct Data;  // internal
  explicit DeviceTriangulation(std::unique_ptr<Data> data);
  [[nodiscard]] const Data& data() const noexcept { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// An opened device with its memory. One thread at a time may use a triangulator; different ones are independent.
///
/// CUDA: the device and the context are those of `Options::queue`, else the device that `Options::device` names, else
/// the caller's current one. Each call makes its context current and restores the caller's; no call synchronises the
/// device or the default stream, but opening may (it loads the kernels), and so may taking more memory (see reserve).
///
///     cadt::Options options;
///     options.backend = cadt::Backend::cuda;
///     options.queue = stream;                                    // a cudaStream_t
///     cadt::Triangulator triangulator(options);
///     auto mesh = triangulator.triangulate(cadt::DevicePoints{.x = xy, .size = n});
///     kernel<<<blocks, threads, 0, stream>>>(static_cast<const int*>(mesh.triangles()), mesh.number_of_triangles());
class Triangulator {
 public:
  /// Opens the device and tests it. \throws BackendUnavailable, KernelBuildError, DeviceError, OptionError
  explicit Triangulator(const Options& options = {});
  ~Triangulator();
  Triangulator(Triangulator&&) noexcept;
  Triangulator& operator=(Triangulator&&) noexcept;

  [[nodiscard]] const DeviceInfo& device() const noexcept;
  /// What says where and how the device works (`backend`, `device`, `threads`, `work_group_size`, `queue`,
  /// `allocator`), and `kernel_times`, is read once, when it is opened; the rest may be changed between calls.
  [[nodiscard]] Options& options() noexcept;
  /// Theoretical occupancy of the insertion with work groups of this size: resident warps over the most that there can
  /// be, 0 to 1; 0 if it does not start with so many (a run then takes the largest size that does). Empty where the
  /// device tells no more than that: only CUDA does.
  [[nodiscard]] std::optional<double> occupancy(unsigned work_group_size) const;

  /// Points on the host to a mesh on the host. \throws as cadt::triangulate
  [[nodiscard]] Triangulation triangulate(PointsView points);
  /// Points on the device to a mesh on the device, which is complete when the call returns; with a queue of the
  /// caller's (Options::queue), StatisticsDetail::none and no Options::kernel_times it is complete in the order of that
  /// queue: the last kernels may still be waiting there. \throws as cadt::triangulate. After an error the triangulator
  /// can be used again.
  [[nodiscard]] DeviceTriangulation triangulate(const DevicePoints& points);

  /// The same on a thread of its own, so that the caller's goes on: the driver has to wait for the device some ten
  /// times. Until the future is ready nothing else may be asked of this triangulator, and points, offsets and options
  /// must stay as they are. `Options::progress` is called on that thread. What the call throws the future throws; one
  /// that is dropped waits.
  [[nodiscard]] std::future<Triangulation> triangulate_async(PointsView points);
  [[nodiscard]] std::future<DeviceTriangulation> triangulate_async(const DevicePoints& points);

  /// Many sets of points, as cadt::triangulate_batch. Sets with up to 32,768 points (CPUs: 2,048) are triangulated
  /// together, some 16 million points at a time: without a launch for each of them, and without locks. The others,
  /// those with a vertex of more than 39 neighbours, and all where `Options::strategy` or `stabilize` ask for
  /// insertion, come one after another within the same call; so do all on devices without double precision. \throws
  /// OptionError for `Options::watch`
  [[nodiscard]] TriangulationBatch triangulate_batch(PointsView points, std::span<const std::size_t> offsets);
  [[nodiscard]] DeviceTriangulationBatch triangulate_batch(const DevicePoints& points,
                                                           std::span<const std::size_t> offsets);
  [[nodiscard]] std::future<TriangulationBatch> triangulate_batch_async(PointsView points,
                                                                        std::span<const std::size_t> offsets);
  [[nodiscard]] std::future<DeviceTriangulationBatch> triangulate_batch_async(const DevicePoints& points,
                                                                              std::span<const std::size_t> offsets);

  /// The independent check of a mesh on the device (verify.hpp: verify_on_device) without a copy to the host, but for
  /// the boundary and what the device cannot decide. A mesh without triangles is checked on the host, and so is any
  /// mesh of a device without double precision. \throws as cadt::verify_on_device, and InputError for a mesh of another
  /// triangulator
  [[nodiscard]] VerifyReport verify(const DevicePoints& points, const DeviceTriangulation& mesh,
                                    const VerifyOptions& options = {});

  /// Device memory that the first call with so many points takes at most, in bytes: its result and the memory kept for
  /// the next call included, points of the caller's that are on the device not. 124 a point where the device or
  /// `Options::allocator` keeps the memory, else 176, and 228 with the star stage (Options::strategy). With
  /// `Options::max_memory` 124 are enough, on the host 97 for a mesh on the host; with the star stage 71, or 83 for
  /// points of the host's (below 85 and 101 a call takes about 5 % more time, 15 % in the canonical order), unless more
  /// than about 4 % of the points are left to the insertion. Crowded cells (more than
  /// 16 points in 2^-16 of the box's width) need up to 32 bytes more for each of their points while they are sorted.
  [[nodiscard]] std::size_t memory_needed(std::size_t points) const noexcept;
  /// Takes the memory for calls with up to so many points now; with an allocator of the caller's there is nothing to
  /// take. Keeps no more than `Options::max_memory`. \throws LimitError, OutOfMemory
  void reserve(std::size_t points);
  /// Gives back all memory that no result holds.
  void release_memory();

  struct State;  // internal

 private:
  std::shared_ptr<State> state_;
};

/// Memory for a triangulator that has its own allocator, e.g. that of a framework. Called by one thread at a time. Must
/// not throw.
class DeviceAllocator {
 public:
  virtual ~DeviceAllocator() = default;
  /// Memory of at least so many bytes, aligned to 256: a device pointer that may be used on `queue` (a cudaStream_t)
  /// from now on, a new cl_mem of the context of `queue` (a cl_command_queue), or a host pointer (`queue` is null).
  /// Null if there is none left.
  [[nodiscard]] virtual void* allocate(std::size_t bytes, void* queue) noexcept = 0;
  /// Gives it back; work that uses it may still be waiting in `queue`.
  virtual void deallocate(void* memory, std::size_t bytes, void* queue) noexcept = 0;
};

}  // namespace cadt
