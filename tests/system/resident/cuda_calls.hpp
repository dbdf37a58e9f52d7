// SPDX-License-Identifier: Apache-2.0
// CUDA as a program uses it beside the library: contexts, streams, and calls held up.
#pragma once

#include <cuda.h>
#include <cuda_runtime_api.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <limits>
#include <mutex>
#include <thread>

#include "tests/system/resident/resident.hpp"

namespace cadt::test {

/// A function of the driver as CUDA `version` knows it; null without a driver.
template <class Function>
Function driver_function(const char* name, unsigned version) {
  void* address = nullptr;
  cudaDriverEntryPointQueryResult found{};
#if CUDART_VERSION >= 12050
  const cudaError_t code = cudaGetDriverEntryPointByVersion(name, &address, version, cudaEnableDefault, &found);
#else
  static_cast<void>(version);
  const cudaError_t code = cudaGetDriverEntryPoint(name, &address, cudaEnableDefault, &found);
#endif
  if (code == cudaSuccess && found == cudaDriverEntryPointSuccess) return reinterpret_cast<Function>(address);
  cudaGetLastError();
  return nullptr;
}

inline CUcontext current_context() {
  static const auto get = driver_function<CUresult (*)(CUcontext*)>("cuCtxGetCurrent", 4000);
  CUcontext context = nullptr;
  EXPECT_NE(get, nullptr);
  if (get != nullptr && get(&context) == CUDA_ERROR_NOT_INITIALIZED) context = nullptr;
  return context;
}

/// What must be the same before and after each call.
struct State {
  CUcontext context = current_context();
  int device = [] {
    int current = -1;
    EXPECT_EQ(cudaGetDevice(&current), cudaSuccess);
    return current;
  }();
  friend bool operator==(const State&, const State&) = default;
};

/// Calls that wait until it opens: at the latest after 20 s, which is then a failure.
class Gate {
 public:
  Gate()
      : watchdog_([this] {
          std::unique_lock lock(mutex_);
          if (!changed_.wait_for(lock, std::chrono::seconds(20), [this] { return open_; })) late_ = open_ = true;
          changed_.notify_all();
        }) {}
  ~Gate() { open(); }
  Gate(const Gate&) = delete;
  Gate& operator=(const Gate&) = delete;

  void block(cudaStream_t stream) {
    ASSERT_EQ(cudaLaunchHostFunc(
                  stream, [](void* gate) { static_cast<Gate*>(gate)->wait(); }, this),
              cudaSuccess);
  }
  void open() {
    {
      const std::lock_guard lock(mutex_);
      open_ = true;
    }
    changed_.notify_all();
    if (watchdog_.joinable()) watchdog_.join();
    EXPECT_EQ(cudaDeviceSynchronize(), cudaSuccess);  // the calls that waited here have returned
  }
  [[nodiscard]] bool late() {
    const std::lock_guard lock(mutex_);
    return late_;
  }

 private:
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return open_; });
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false, late_ = false;
  std::thread watchdog_;  // last: starts when the rest is there
};

class CudaCalls : public ResidentTest {
 protected:
  void SetUp() override {
    ResidentTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    ASSERT_EQ(cudaSetDevice(device_index(Backend::cuda)), cudaSuccess);
  }
  void TearDown() override {
    if (memory != nullptr) {
      EXPECT_EQ(cudaGetLastError(), cudaSuccess);
    }
  }
  [[nodiscard]] Options on(cudaStream_t stream) const {
    Options with = options();
    with.queue = stream;
    return with;
  }
  [[nodiscard]] Options without_queue() const {
    Options with = options();
    with.queue.reset();
    return with;
  }
  /// The triangles of a mesh, fetched in the order of a stream.
  static std::vector<std::int32_t> fetch(cudaStream_t stream, const DeviceTriangulation& mesh) {
    std::vector<std::int32_t> triangles(3 * mesh.number_of_triangles());
    EXPECT_EQ(cudaMemcpyAsync(triangles.data(), mesh.triangles(), triangles.size() * sizeof triangles[0],
                              cudaMemcpyDeviceToHost, stream),
              cudaSuccess);
    EXPECT_EQ(cudaStreamSynchronize(stream), cudaSuccess);
    return triangles;
  }
  static std::vector<std::int32_t> triangles_of(const Known& known) {
    return {known.mesh.triangles().begin(), known.mesh.triangles().end()};
  }

  /// All calls of a triangulator, each with the state before and after it.
  static void expect_state_kept(const Options& with, const Known& known, const DevicePoints& points) {
    const State before;
    const auto expect_kept = [&](const char* call) {
      EXPECT_EQ(State(), before) << "after " << call;
      EXPECT_EQ(cudaPeekAtLastError(), cudaSuccess) << "after " << call;
    };
    {
      Triangulator triangulator(with);
      expect_kept("Triangulator");
      triangulator.reserve(1000);
      expect_kept("reserve");
      {
        const DeviceTriangulation mesh = triangulator.triangulate(points);
        expect_kept("triangulate on the device");
        EXPECT_EQ(mesh.download().hash(), known.mesh.hash());
        expect_kept("download");
        EXPECT_TRUE(triangulator.verify(points, mesh).ok);
        expect_kept("verify");
      }
      expect_kept("~DeviceTriangulation");
      EXPECT_EQ(triangulator.triangulate(std::span<const double>(known.xy)).hash(), known.mesh.hash());
      expect_kept("triangulate from the host");
      (void)thrown<InputError>([&] { (void)triangulator.triangulate(DevicePoints{.size = 3}); });
      expect_kept("InputError");
      triangulator.release_memory();
      expect_kept("release_memory");
    }
    expect_kept("~Triangulator");
    EXPECT_EQ(triangulate(std::span<const double>(known.xy), with).hash(), known.mesh.hash());
    expect_kept("cadt::triangulate");
  }

  const Known known{uniform_points(20000)};
};

}  // namespace cadt::test
