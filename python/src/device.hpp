// SPDX-License-Identifier: Apache-2.0
// An open device that Python objects share, and meshes in its memory.
#pragma once

#include "common.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace cadt_python {

/// A triangulator, which one thread at a time may use, and so may no other thread destroy its meshes meanwhile. Python
/// destroys objects in any thread, and with the GIL, which a running call may need to report progress: what is
/// destroyed while the triangulator is busy waits for the next call.
class SharedTriangulator {
 public:
  /// `stream`: the Python object whose stream or queue `options` names; it lives as long as this and its meshes.
  SharedTriangulator(const cadt::Options& options, nb::object stream)
      : stream_(std::move(stream)),
        triangulator_(without_gil([&] { return std::make_unique<cadt::Triangulator>(options); })) {}

  ~SharedTriangulator() {
    if (forks_ == forks()) return;
    // A driver does not survive a fork: for ever, with what waited for the next call.
    static_cast<void>(triangulator_.release());
    static_cast<void>(new auto(std::move(retired_)));
  }
  SharedTriangulator(const SharedTriangulator&) = delete;
  SharedTriangulator& operator=(const SharedTriangulator&) = delete;

  /// Runs `work()` without the GIL, after other threads' calls. `options` are those that the work looks at.
  template <class Work>
  auto run_with(cadt::Options& options, Work&& work) {
    const nb::object none = nb::none();
    Call call(none);
    return without_gil([&] {
      const auto turn = wait_for_turn();
      return call.run(options, work);
    });
  }

  /// Runs `work(triangulator)` without the GIL, after other threads' calls.
  template <class Work>
  auto run(const nb::object& progress, Work&& work) {
    Call call(progress);
    return without_gil([&] {
      const auto turn = wait_for_turn();
      return call.run(triangulator_->options(), [&] { return work(*triangulator_); });
    });
  }

  /// The same with the options that may change between calls.
  template <class Work>
  auto run(const cadt::Options& options, const nb::object& progress, Work&& work) {
    Call call(progress);
    return without_gil([&] {
      const auto turn = wait_for_turn();
      cadt::Options& own = triangulator_->options();
      own.order = options.order;
      own.statistics = options.statistics;
      const LimitOfCall limit(*triangulator_, options.max_memory);
      return call.run(own, [&] { return work(*triangulator_); });
    });
  }

  void retire(std::shared_ptr<void> object) {
    if (forks_ != forks()) return static_cast<void>(new std::shared_ptr<void>(std::move(object)));  // for ever
    if (const std::unique_lock turn(turns_, std::try_to_lock); turn) return object.reset();
    const std::lock_guard lock(retired_mutex_);
    retired_.push_back(std::move(object));
  }

  [[nodiscard]] const cadt::DeviceInfo& device() const noexcept { return triangulator_->device(); }

 private:
  /// While what it returns lives, the triangulator is the calling thread's.
  [[nodiscard]] std::unique_lock<Turns> wait_for_turn() {
    require_usable();
    std::unique_lock turn(turns_);
    const std::lock_guard retired(retired_mutex_);
    retired_.clear();
    return turn;
  }

  /// `Options::max_memory` for one call: it is not that of the meshes that others have made, and of their queries.
  class LimitOfCall {
   public:
    LimitOfCall(cadt::Triangulator& of, std::size_t bytes) : of_(of) { of_.options().max_memory = bytes; }
    ~LimitOfCall() {
      if (std::exchange(of_.options().max_memory, 0) == 0) return;
      try {
        of_.reserve(0);  // begins a new budget
      } catch (const std::exception&) {
        return;  // the next call does
      }
    }
    LimitOfCall(const LimitOfCall&) = delete;
    LimitOfCall& operator=(const LimitOfCall&) = delete;

   private:
    cadt::Triangulator& of_;
  };

  void require_usable() const {
    const std::string backend(cadt::to_string(device().backend));
    if (forks_ != forks())
      throw cadt::BackendUnavailable(
          backend,
          "this process was forked after the device had been opened, which drivers do not survive: use "
          "multiprocessing.set_start_method(\"spawn\"), or backend=\"host\"");
    if (turns_.is_mine())
      throw cadt::BackendUnavailable(backend,
                                     "the device is in a call that reports to this progress function: use it after "
                                     "that call, or backend=\"host\" here");
  }

  Turns turns_;
  std::mutex retired_mutex_;
  nb::object stream_;
  std::unique_ptr<cadt::Triangulator> triangulator_;
  std::vector<std::shared_ptr<void>> retired_;
  unsigned forks_ = forks();
};

using Shared = std::shared_ptr<SharedTriangulator>;

/// A mesh in device memory; it may outlive all other objects of Python.
class DeviceMesh {
 public:
  DeviceMesh(std::shared_ptr<SharedTriangulator> shared, cadt::DeviceTriangulation&& mesh)
      : shared_(std::move(shared)), mesh_(std::make_shared<cadt::DeviceTriangulation>(std::move(mesh))) {}
  ~DeviceMesh() {
    if (mesh_) shared_->retire(std::move(mesh_));
  }
  DeviceMesh(DeviceMesh&&) = default;
  DeviceMesh& operator=(DeviceMesh&&) = delete;

  [[nodiscard]] const cadt::DeviceTriangulation& mesh() const noexcept { return *mesh_; }
  [[nodiscard]] SharedTriangulator& shared() const noexcept { return *shared_; }

 private:
  std::shared_ptr<SharedTriangulator> shared_;
  std::shared_ptr<cadt::DeviceTriangulation> mesh_;
};

/// Memory for the result of a query, of words or doubles; as a mesh it may outlive all other objects.
class DeviceMemory {
 public:
  DeviceMemory(std::shared_ptr<SharedTriangulator> shared, std::vector<std::size_t> shape, bool float64)
      : shared_(std::move(shared)), shape_(std::move(shape)), float64_(float64) {
    std::size_t bytes = float64_ ? sizeof(double) : sizeof(std::int32_t);
    for (const std::size_t n : shape_) bytes *= n;
    memory_ = shared_->run(nb::none(), [&](cadt::Triangulator& own) { return own.allocate(bytes); });
  }
  ~DeviceMemory() {
    if (memory_) shared_->retire(std::move(memory_));
  }
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;

  [[nodiscard]] SharedTriangulator& shared() const noexcept { return *shared_; }
  [[nodiscard]] void* get() const noexcept { return memory_.get(); }
  [[nodiscard]] const std::vector<std::size_t>& shape() const noexcept { return shape_; }
  [[nodiscard]] nb::dlpack::dtype type() const { return float64_ ? nb::dtype<double>() : nb::dtype<std::int32_t>(); }

 private:
  std::shared_ptr<SharedTriangulator> shared_;
  std::vector<std::size_t> shape_;
  bool float64_;
  std::shared_ptr<void> memory_;
};

/// n x 2 coordinates in device memory, as numbers.
struct DeviceCoordinates {
  std::uintptr_t x = 0;
  std::size_t size = 0;
  bool float32 = false;
  std::size_t skip = 0;
  [[nodiscard]] cadt::DevicePoints points() const noexcept {
    return {.x = reinterpret_cast<const void*>(x),
            .y = nullptr,
            .size = size,
            .scalar = float32 ? cadt::Scalar::float32 : cadt::Scalar::float64,
            .skip = skip};
  }
};

}  // namespace cadt_python
