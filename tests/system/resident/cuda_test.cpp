// SPDX-License-Identifier: Apache-2.0
// What a CUDA program relies on beside the mesh: its current device and context, its streams, its errors.
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
namespace {

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

CUcontext current_context() {
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

TEST_P(CudaCalls, KeepTheCurrentContext) {
  const DevicePoints points = upload(known.xy);
  expect_state_kept(options(), known, points);
  // memory of the test's own stream is ready, so that any stream of the library's may read it
  expect_state_kept(without_queue(), known, points);
  EXPECT_FALSE(list_devices().empty());
}

/// No context is current in a thread that has not called CUDA yet.
TEST_P(CudaCalls, KeepAFreshThreadWithoutContext) {
  const DevicePoints points = upload(known.xy);
  for (const Options& with : {options(), without_queue(), on(cudaStreamLegacy), on(nullptr), on(cudaStreamPerThread)}) {
    std::thread([&] {
      EXPECT_EQ(current_context(), nullptr);
      expect_state_kept(with, known, points);
      EXPECT_EQ(current_context(), nullptr);
    }).join();
  }
}

TEST_P(CudaCalls, InAContextOfTheCallers) {
  // cuCtxCreate has other parameters in later versions; these are those of version 3.2.
  const auto create = driver_function<CUresult (*)(CUcontext*, unsigned, CUdevice)>("cuCtxCreate", 3020);
  const auto destroy = driver_function<CUresult (*)(CUcontext)>("cuCtxDestroy", 4000);
  if (CUDART_VERSION < 12050 || create == nullptr || destroy == nullptr) GTEST_SKIP() << "no cuCtxCreate";
  const State before;
  const DevicePoints of_primary = upload(known.xy);
  CUcontext own = nullptr;
  ASSERT_EQ(create(&own, 0, before.device), CUDA_SUCCESS);
  ASSERT_EQ(current_context(), own);
  {
    // the triangulator works in the primary context meanwhile
    expect_state_kept(options(), known, of_primary);
    expect_state_kept(without_queue(), known, of_primary);
    ASSERT_EQ(current_context(), own);

    void* xy = nullptr;
    cudaStream_t stream = nullptr;
    ASSERT_EQ(cudaMalloc(&xy, known.xy.size() * sizeof(double)), cudaSuccess);
    ASSERT_EQ(cudaMemcpy(xy, known.xy.data(), known.xy.size() * sizeof(double), cudaMemcpyHostToDevice), cudaSuccess);
    ASSERT_EQ(cudaDeviceSynchronize(), cudaSuccess);
    ASSERT_EQ(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), cudaSuccess);
    const DevicePoints points{.x = xy, .size = known.size()};
    expect_state_kept(on(stream), known, points);
    expect_state_kept(on(nullptr), known, points);  // the default stream of this context
    {
      Triangulator triangulator(on(stream));
      const DeviceTriangulation mesh = triangulator.triangulate(points);
      EXPECT_TRUE(fetch(stream, mesh) == triangles_of(known));
    }
    EXPECT_EQ(cudaStreamDestroy(stream), cudaSuccess);
    EXPECT_EQ(cudaFree(xy), cudaSuccess);
  }
  EXPECT_EQ(destroy(own), CUDA_SUCCESS);
  ASSERT_EQ(cudaSetDevice(before.device), cudaSuccess);
}

TEST_P(CudaCalls, WorkInAnyStream) {
  const DevicePoints points = upload(known.xy);
  cudaStream_t blocking = nullptr;
  ASSERT_EQ(cudaStreamCreate(&blocking), cudaSuccess);
  for (cudaStream_t stream : {cudaStream_t{nullptr}, cudaStreamLegacy, cudaStreamPerThread, blocking}) {
    Triangulator triangulator(on(stream));
    const DeviceTriangulation mesh = triangulator.triangulate(points);
    EXPECT_TRUE(fetch(stream, mesh) == triangles_of(known));
    EXPECT_EQ(mesh.download().hash(), known.mesh.hash());
  }
  EXPECT_EQ(cudaStreamDestroy(blocking), cudaSuccess);
}

/// Neither the device nor the default stream is waited for. A triangulator may be opened, and take its memory, before
/// the others are busy, and all kernels be loaded then; here it has not been called before.
TEST_P(CudaCalls, DoNotWaitForOtherStreamsAtTheFirstCall) {
  const DevicePoints points = upload(known.xy);
  cudaStream_t other = nullptr;
  ASSERT_EQ(cudaStreamCreate(&other), cudaSuccess);
  Triangulator triangulator(options());
  triangulator.reserve(known.size());
  DeviceTriangulation mesh;
  {
    Gate gate;
    gate.block(cudaStreamLegacy);
    gate.block(other);
    mesh = triangulator.triangulate(points);
    EXPECT_FALSE(gate.late()) << "the call returned only after the other streams had been let go";
  }
  expect_same(*memory, mesh, known.mesh);
  EXPECT_EQ(cudaStreamDestroy(other), cudaSuccess);
}

TEST_P(CudaCalls, DoNotWaitForOtherStreams) {
  const Known clusters(cluster_points(30000)), lattice(grid_points(150, 100));
  cudaStream_t other = nullptr;
  ASSERT_EQ(cudaStreamCreate(&other), cudaSuccess);
  std::vector<std::pair<const Known*, DevicePoints>> sets;
  for (const Known* set : {&known, &clusters, &lattice}) sets.emplace_back(set, upload(set->xy));
  for (const bool own_queue : {false, true}) {
    Triangulator triangulator(own_queue ? without_queue() : options());
    for (const auto& [set, points] : sets) (void)triangulator.triangulate(points);
    Gate gate;
    gate.block(cudaStreamLegacy);
    gate.block(other);
    for (const auto& [set, points] : sets) {
      triangulator.options().order = Order::canonical;
      const DeviceTriangulation mesh = triangulator.triangulate(points);
      EXPECT_FALSE(gate.late()) << "triangulate";
      EXPECT_EQ(mesh.download().hash(), set->mesh.hash());
      EXPECT_FALSE(gate.late()) << "download";
      EXPECT_TRUE(triangulator.verify(points, mesh).ok);
      EXPECT_FALSE(gate.late()) << "verify";
      EXPECT_EQ(triangulator.triangulate(std::span<const double>(set->xy)).hash(), set->mesh.hash());
      EXPECT_FALSE(gate.late()) << "triangulate from the host";
      triangulator.options().order = Order::fast;
      EXPECT_EQ(triangulator.triangulate(points).number_of_triangles(), set->mesh.number_of_triangles());
      EXPECT_FALSE(gate.late()) << "fast order";
    }
    gate.open();
  }
  EXPECT_EQ(cudaStreamDestroy(other), cudaSuccess);
}

/// Points that arrive in the stream behind work of 0.2 s are seen, and the mesh by what comes after it in the stream.
TEST_P(CudaCalls, KeepTheOrderOfTheStream) {
  const auto stream = static_cast<cudaStream_t>(memory->queue());
  const std::size_t bytes = known.xy.size() * sizeof(double);
  const void* const nowhere = memory->upload(std::span<const double>(Points(known.xy.size(), 0.0)));
  void *source = nullptr, *target = const_cast<void*>(nowhere), *results = nullptr;
  ASSERT_EQ(cudaMallocHost(&source, bytes), cudaSuccess);
  std::memcpy(source, known.xy.data(), bytes);
  const std::size_t result_bytes = known.mesh.triangles().size_bytes();
  ASSERT_EQ(cudaMallocHost(&results, result_bytes), cudaSuccess);
  Triangulator triangulator(options());
  for (int round = 0; round < 3; ++round) {
    ASSERT_EQ(cudaMemsetAsync(target, 0, bytes, stream), cudaSuccess);
    std::memset(results, 0, result_bytes);
    ASSERT_EQ(cudaStreamSynchronize(stream), cudaSuccess);
    const auto pause = [](void*) { std::this_thread::sleep_for(std::chrono::milliseconds(200)); };
    ASSERT_EQ(cudaLaunchHostFunc(stream, pause, nullptr), cudaSuccess);
    ASSERT_EQ(cudaMemcpyAsync(target, source, bytes, cudaMemcpyHostToDevice, stream), cudaSuccess);
    {
      const DeviceTriangulation mesh = triangulator.triangulate({.x = target, .size = known.size()});
      ASSERT_EQ(mesh.number_of_triangles(), known.mesh.number_of_triangles());
      ASSERT_EQ(cudaMemcpyAsync(results, mesh.triangles(), result_bytes, cudaMemcpyDeviceToHost, stream), cudaSuccess);
    }  // the result goes while the copy may still wait
    ASSERT_EQ(cudaStreamSynchronize(stream), cudaSuccess);
    EXPECT_EQ(std::memcmp(results, known.mesh.triangles().data(), result_bytes), 0);
  }
  EXPECT_EQ(cudaFreeHost(source), cudaSuccess);
  EXPECT_EQ(cudaFreeHost(results), cudaSuccess);
}

TEST_P(CudaCalls, LeaveNoErrors) {
  const DevicePoints points = upload(known.xy);
  Points bad = known.xy;
  bad[4321] = std::numeric_limits<double>::quiet_NaN();
  Triangulator triangulator(options());
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
  (void)thrown<InputError>([&] { (void)triangulator.triangulate(upload(bad)); });
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
  triangulator.options().max_memory = 1000000;
  (void)thrown<OutOfMemory>([&] { (void)triangulator.triangulate(points); });
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
  triangulator.options().max_memory = 0;
  const auto allocator = counting();
  Options with = options();
  with.allocator = allocator;
  {
    Triangulator refused(with);
    allocator->fail_at(5);
    (void)thrown<OutOfMemory>([&] { (void)refused.triangulate(points); });
    EXPECT_EQ(cudaGetLastError(), cudaSuccess);
  }
  Options missing;
  missing.backend = Backend::cuda;
  missing.device = "no such device";
  (void)thrown<BackendUnavailable>([&] { const Triangulator t(missing); });
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
  expect_same(*memory, triangulator.triangulate(points), known.mesh);
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
}

/// An error that the caller has not asked for yet neither fails a call nor gets lost.
TEST_P(CudaCalls, KeepTheCallersError) {
  const DevicePoints points = upload(known.xy);
  for (const bool own_queue : {false, true}) {
    const Options with = own_queue ? without_queue() : options();
    EXPECT_EQ(cudaSetDevice(100000), cudaErrorInvalidDevice);
    try {
      Triangulator triangulator(with);
      EXPECT_EQ(cudaPeekAtLastError(), cudaErrorInvalidDevice) << "after Triangulator";
      triangulator.reserve(known.size());
      EXPECT_EQ(cudaPeekAtLastError(), cudaErrorInvalidDevice) << "after reserve";
      for (const Order order : {Order::canonical, Order::fast}) {
        triangulator.options().order = order;
        const DeviceTriangulation mesh = triangulator.triangulate(points);
        EXPECT_EQ(cudaPeekAtLastError(), cudaErrorInvalidDevice) << "after triangulate";
        EXPECT_EQ(mesh.download().hash(), known.mesh.hash());
        EXPECT_TRUE(triangulator.verify(points, mesh).ok);
        EXPECT_EQ(cudaPeekAtLastError(), cudaErrorInvalidDevice) << "after download and verify";
      }
      triangulator.release_memory();
      EXPECT_EQ(cudaPeekAtLastError(), cudaErrorInvalidDevice) << "after release_memory";
    } catch (const std::exception& error) {
      ADD_FAILURE() << "a call took the caller's error for its own: " << error.what();
    }
    EXPECT_EQ(cudaGetLastError(), cudaErrorInvalidDevice) << "after ~Triangulator";
  }
}

TEST_P(CudaCalls, WithSeveralDevices) {
  int count = 0;
  ASSERT_EQ(cudaGetDeviceCount(&count), cudaSuccess);
  if (count < 2) GTEST_SKIP() << "one GPU";
  const int first = device_index(Backend::cuda), second = first == 0 ? 1 : 0;
  const auto there = cuda_memory(second);
  const DevicePoints points{.x = there->upload(std::span<const double>(known.xy)), .size = known.size()};
  ASSERT_EQ(cudaSetDevice(first), cudaSuccess);
  Options with = on(static_cast<cudaStream_t>(there->queue()));
  with.device.clear();
  EXPECT_EQ(Triangulator(with).device().index, second);  // the stream says it
  expect_state_kept(with, known, points);
  with.queue.reset();
  with.device = std::to_string(second);
  expect_state_kept(with, known, points);
  std::thread([&] {  // whose current device is 0, without a context
    expect_state_kept(with, known, points);
    EXPECT_EQ(current_context(), nullptr);
  })
      .join();
  with.device.clear();  // the current device
  EXPECT_EQ(Triangulator(with).device().index, first);
  ASSERT_EQ(cudaSetDevice(second), cudaSuccess);
  EXPECT_EQ(Triangulator(with).device().index, second);
  expect_state_kept(with, known, points);
  with.queue = memory->queue();
  with.device = std::to_string(second);
  (void)thrown<BackendUnavailable>([&] { const Triangulator t(with); });
  ASSERT_EQ(cudaSetDevice(first), cudaSuccess);
}

/// After reserve() the device gives nothing more. The least of several tries, for other programs may be at work.
TEST_P(CudaCalls, TakeNoMoreThanReserved) {
  const Known many(uniform_points(500000));
  const DevicePoints points = upload(many.xy), fewer = upload(known.xy);
  const auto free_bytes = [] {
    std::size_t available = 0, total = 0;
    EXPECT_EQ(cudaMemGetInfo(&available, &total), cudaSuccess);
    return available;
  };
  std::size_t least = ~std::size_t{0};  // other programs on the card take memory as well
  for (int attempt = 0; attempt < 30 && least != 0; ++attempt) {
    Triangulator triangulator(options());
    triangulator.reserve(many.size());
    const std::size_t before = free_bytes();
    for (int call = 0; call < 2; ++call) {
      EXPECT_EQ(triangulator.triangulate(points).number_of_triangles(), many.mesh.number_of_triangles());
      EXPECT_EQ(triangulator.triangulate(fewer).number_of_triangles(), known.mesh.number_of_triangles());
    }
    const std::size_t after = free_bytes();
    least = std::min(least, before > after ? before - after : 0);
  }
  EXPECT_EQ(least, 0U) << "bytes were taken beyond the reservation";
}

/// The test allocates the remaining memory of the device, so that too little is left for points that are there.
TEST_P(CudaCalls, TakesAllMemory) {
  constexpr std::size_t n = 8'000'000, left = std::size_t{600} << 20;
  const Known few(uniform_points(1000));
  const DevicePoints points = upload(uniform_points(n)), fewer = upload(few.xy);
  Options with = options();
  with.strategy = Strategy::locks;  // the least that is needed
  Triangulator triangulator(with);
  expect_same(*memory, triangulator.triangulate(fewer), few.mesh);
  triangulator.release_memory();
  std::size_t available = 0, total = 0;
  ASSERT_EQ(cudaMemGetInfo(&available, &total), cudaSuccess);
  if (available < left || triangulator.memory_needed(n) <= left) GTEST_SKIP() << available << " bytes are free";
  std::vector<void*> ballast;
  for (std::size_t piece = available - left; piece > left / 8;) {
    if (void* memory_piece = nullptr; cudaMalloc(&memory_piece, piece) == cudaSuccess) {
      ballast.push_back(memory_piece);
      ASSERT_EQ(cudaMemGetInfo(&available, &total), cudaSuccess);
      piece = available > left ? available - left : 0;
    } else {
      cudaGetLastError();
      piece /= 2;
    }
  }
  ASSERT_EQ(cudaMemGetInfo(&available, &total), cudaSuccess);
  const std::size_t needed = triangulator.memory_needed(n);
  if (needed > available) {
    for (int attempt = 0; attempt < 2; ++attempt) {
      bool began = false;
      triangulator.options().progress = [&](const Progress&) { began = true; };
      if (const auto error = thrown<OutOfMemory>([&] { (void)triangulator.triangulate(points); }); error != nullptr) {
        EXPECT_EQ(error->needed(), needed);
        EXPECT_LT(error->available(), needed);
        EXPECT_GT(error->available(), 0U);
      }
      EXPECT_FALSE(began) << "work was done before the error";
      EXPECT_EQ(cudaGetLastError(), cudaSuccess);
      triangulator.options().progress = nullptr;
      (void)thrown<OutOfMemory>([&] { triangulator.reserve(n); });
      expect_same(*memory, triangulator.triangulate(fewer), few.mesh);
    }
  }
  for (void* piece : ballast) EXPECT_EQ(cudaFree(piece), cudaSuccess);
  if (needed <= available) GTEST_SKIP() << "so much memory cannot be taken: " << available << " bytes are still free";
  triangulator.options().order = Order::fast;
  EXPECT_GT(triangulator.triangulate(points).number_of_triangles(), n);
}

CADT_ON(cuda, CudaCalls, main_cuda_case);

}  // namespace
}  // namespace cadt::test
