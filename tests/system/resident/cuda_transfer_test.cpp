// SPDX-License-Identifier: Apache-2.0
// Copies between the device and pageable memory: the same bytes at every size, and nothing beside them.
#include "backends/cuda/transfer.hpp"
#include "common/driver/device.hpp"
#include "common/driver/registry.hpp"
#include "tests/system/resident/cuda_calls.hpp"

namespace cadt::test {
namespace {

using cuda::Transfer;
using Bytes = std::vector<std::byte>;

constexpr std::size_t mebibyte = std::size_t{1} << 20, slot = Transfer::slot_bytes, guard = 64;
/// More than all lanes need.
constexpr std::size_t enough = (Transfer::most_threads + 1) * Transfer::bytes_a_lane;

Bytes pattern(std::size_t count, unsigned seed) {
  Bytes bytes(count);
  std::uint64_t state = 0x9e3779b97f4a7c15U * (seed + 1);
  for (std::byte& byte : bytes) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    byte = static_cast<std::byte>(state >> 56);
  }
  return bytes;
}

class CudaTransfer : public CudaCalls {
 protected:
  void SetUp() override {
    CudaCalls::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    stream_ = std::make_shared<cuda::Stream>(device_index(Backend::cuda), "device", std::nullopt, nullptr);
    ASSERT_EQ(cudaMalloc(&device_, bytes_.size()), cudaSuccess);
  }
  void TearDown() override {
    EXPECT_EQ(cudaFree(device_), cudaSuccess);
    CudaCalls::TearDown();
  }
  /// Copies until all lanes are there.
  void earn(Transfer& transfer) {
    for (std::size_t copied = 0; copied < enough; copied += bytes_.size())
      (void)transfer.prepare(bytes_.data(), bytes_.size());
    EXPECT_TRUE(transfer.prepare(bytes_.data(), bytes_.size()));
  }

  const Bytes bytes_ = pattern(80 * mebibyte, 0);
  std::shared_ptr<cuda::Stream> stream_;
  void* device_ = nullptr;
};

TEST_P(CudaTransfer, KeepsTheBytes) {
  const auto at = [this](std::size_t offset) { return static_cast<std::byte*>(device_) + offset; };
  for (const unsigned threads : {2U, 3U, 16U}) {
    Transfer transfer(stream_, threads);
    earn(transfer);
    for (const std::size_t size :
         {Transfer::fewest_bytes, Transfer::fewest_bytes + 1, 3 * slot - 1, 3 * slot + slot / 2 + 3, threads * slot - 1,
          threads * slot, threads * slot + 1, 2 * threads * slot - 1, 2 * threads * slot, 2 * threads * slot + 1,
          35 * slot + 12345, 70 * mebibyte + 7})
      for (const std::size_t offset : {std::size_t{0}, std::size_t{1}, std::size_t{4095}}) {
        if (size < Transfer::fewest_bytes) continue;
        SCOPED_TRACE(std::to_string(size) + " bytes at " + std::to_string(offset) + ", threads " +
                     std::to_string(threads));
        const Bytes from = pattern(size + offset, static_cast<unsigned>(size));
        ASSERT_TRUE(transfer.prepare(from.data() + offset, size));
        ASSERT_EQ(cudaMemset(device_, 0x5a, size + offset + guard), cudaSuccess);
        ASSERT_EQ(cudaDeviceSynchronize(), cudaSuccess);
        transfer.to_device(at(offset), from.data() + offset, size);
        Bytes found(size + offset + guard);
        ASSERT_EQ(cudaMemcpy(found.data(), device_, found.size(), cudaMemcpyDeviceToHost), cudaSuccess);
        Bytes expected(size + offset + guard, std::byte{0x5a});
        std::copy(from.begin() + static_cast<std::ptrdiff_t>(offset), from.end(),
                  expected.begin() + static_cast<std::ptrdiff_t>(offset));
        ASSERT_TRUE(found == expected) << "on the device";
        std::fill(found.begin(), found.end(), std::byte{0x5a});
        transfer.to_host(found.data() + offset, at(offset), size);
        ASSERT_TRUE(found == expected) << "on the host";
      }
  }
}

/// Through the device, where small sizes go other ways.
TEST_P(CudaTransfer, DeviceCopiesEverySize) {
  const std::unique_ptr<Device> device = open_device(without_queue());
  const auto buffer = device->allocate(bytes_.size());
  for (std::size_t copied = 0; copied < enough; copied += bytes_.size())
    device->write(*buffer, 0, bytes_.data(), bytes_.size());
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{65535}, std::size_t{65536},
                                 std::size_t{65537}, Transfer::fewest_bytes - 1, Transfer::fewest_bytes,
                                 Transfer::fewest_bytes + 1, 16 * slot, 32 * slot + 1, 64 * slot})
    for (const std::size_t offset : {0, 3}) {
      const Bytes from = pattern(size, static_cast<unsigned>(size + offset));
      device->write(*buffer, offset, from.data(), size);
      Bytes found(size + 2 * guard, std::byte{0x5a});
      device->read(*buffer, offset, found.data() + guard, size);
      EXPECT_TRUE(std::equal(from.begin(), from.end(), found.begin() + guard)) << size << " bytes at " << offset;
      EXPECT_EQ(std::count(found.begin(), found.begin() + guard, std::byte{0x5a}), guard);
      EXPECT_EQ(std::count(found.end() - guard, found.end(), std::byte{0x5a}), guard);
    }
}

TEST_P(CudaTransfer, TakesWhatTheDriverCopiesSlowly) {
  Transfer transfer(stream_, 16), alone(stream_, 1);
  earn(transfer);
  EXPECT_FALSE(transfer.prepare(bytes_.data(), Transfer::fewest_bytes - 1));
  for (std::size_t copied = 0; copied < enough; copied += bytes_.size())
    EXPECT_FALSE(alone.prepare(bytes_.data(), bytes_.size()));
  const std::size_t size = 8 * mebibyte;
  void *locked = nullptr, *managed = nullptr;
  ASSERT_EQ(cudaMallocHost(&locked, size), cudaSuccess);
  EXPECT_FALSE(transfer.prepare(locked, size));
  EXPECT_EQ(cudaFreeHost(locked), cudaSuccess);
  ASSERT_EQ(cudaMallocManaged(&managed, size), cudaSuccess);
  EXPECT_FALSE(transfer.prepare(managed, size));
  EXPECT_EQ(cudaFree(managed), cudaSuccess);
}

/// Locking memory costs more than a few copies gain.
TEST_P(CudaTransfer, LocksMemoryForManyCopiesOnly) {
  Transfer transfer(stream_, 16);
  const std::size_t size = 8 * mebibyte;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t copied = size; copied < Transfer::fewest_lanes * Transfer::bytes_a_lane; copied += size)
      EXPECT_FALSE(transfer.prepare(bytes_.data(), size)) << copied;
    EXPECT_TRUE(transfer.prepare(bytes_.data(), size));
    transfer.release();
  }
}

TEST_P(CudaTransfer, ReportsErrors) {
  Transfer transfer(stream_, 16);
  earn(transfer);
  Bytes found(bytes_.size());
  const auto beyond = static_cast<std::byte*>(device_) + bytes_.size() - 20 * mebibyte;
  const auto error = thrown<DeviceError>([&] { transfer.to_host(found.data(), beyond, found.size()); });
  if (error != nullptr) {
    EXPECT_NE(std::string(error->what()).find("copy to the host"), std::string::npos) << error->what();
  }
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
  transfer.to_device(device_, bytes_.data(), bytes_.size());
  transfer.to_host(found.data(), device_, found.size());
  EXPECT_TRUE(found == bytes_);
}

TEST_P(CudaTransfer, DoesNotWaitForOtherStreams) {
  cudaStream_t other = nullptr;
  ASSERT_EQ(cudaStreamCreate(&other), cudaSuccess);
  Transfer transfer(stream_, 16);
  Bytes found(bytes_.size());
  {
    Gate gate;
    gate.block(cudaStreamLegacy);
    gate.block(other);
    earn(transfer);
    transfer.to_device(device_, bytes_.data(), bytes_.size());
    transfer.to_host(found.data(), device_, found.size());
    EXPECT_FALSE(gate.late()) << "the copies returned only after the other streams had been let go";
  }
  EXPECT_TRUE(found == bytes_);
  EXPECT_EQ(cudaStreamDestroy(other), cudaSuccess);
}

/// Calls from before there are any lanes until all are there.
TEST_P(CudaTransfer, WholeCalls) {
  const Known large(uniform_points(300000));
  Triangulator triangulator(without_queue());
  for (int call = 0; call < 15; ++call) {
    const Triangulation mesh = triangulator.triangulate(std::span<const double>(large.xy));
    ASSERT_TRUE(std::ranges::equal(mesh.triangles(), large.mesh.triangles())) << "call " << call;
    ASSERT_TRUE(std::ranges::equal(mesh.neighbors(), large.mesh.neighbors())) << "call " << call;
    if (call == 10) triangulator.release_memory();
  }
}

CADT_ON(cuda, CudaTransfer, main_cuda_case);

}  // namespace
}  // namespace cadt::test
