// SPDX-License-Identifier: Apache-2.0
// What a CUDA program relies on beside the mesh: its current device and context, its streams, its errors.
#include "tests/system/resident/cuda_calls.hpp"

namespace cadt::test {
namespace {

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
      const DeviceTriangulation mesh = triangulator.triangulate(DevicePoints{.x = target, .size = known.size()});
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

CADT_ON(cuda, CudaCalls, main_cuda_case);

}  // namespace
}  // namespace cadt::test
