// SPDX-License-Identifier: Apache-2.0
// CUDA with several devices, and with all of the memory taken.
#include "tests/system/resident/cuda_calls.hpp"

namespace cadt::test {
namespace {

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
  with.tuning.strategy = Strategy::locks;  // the least that is needed
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

}  // namespace
}  // namespace cadt::test
