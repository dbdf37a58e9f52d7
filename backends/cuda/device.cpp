// SPDX-License-Identifier: Apache-2.0
#include "backends/cuda/device.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "kernels_cuda/kernels.hpp"

namespace cadt::cuda {
namespace {

constexpr unsigned default_block = 128;  // several blocks an SM even for kernels with many registers
constexpr std::size_t most_parameters = 32;

class CudaBuffer final : public Buffer {
 public:
  CudaBuffer(std::shared_ptr<Stream> stream, void* data, std::size_t bytes) noexcept
      : Buffer(bytes), stream_(std::move(stream)), data_(data) {}
  ~CudaBuffer() override {
    const DeviceScope scope(stream_->device());
    cudaFreeAsync(data_, stream_->get());  // in order behind the launches that use it; a destructor cannot report
  }
  [[nodiscard]] std::byte* data() const noexcept { return static_cast<std::byte*>(data_); }

 private:
  std::shared_ptr<Stream> stream_;
  void* data_;
};

std::byte* data_of(const Buffer& buffer) { return static_cast<const CudaBuffer&>(buffer).data(); }

}  // namespace

void check(cudaError_t code, const char* call, const std::string& device) {
  if (code == cudaSuccess) return;
  cudaGetLastError();  // the error has been taken note of: the next call starts clean
  throw DeviceError(call, static_cast<int>(code), device,
                    std::string(cudaGetErrorName(code)) + ", " + cudaGetErrorString(code));
}

DeviceScope::DeviceScope(int device) noexcept {
  int before = -1;
  if (cudaGetDevice(&before) == cudaSuccess && before != device && cudaSetDevice(device) == cudaSuccess)
    before_ = before;
}
DeviceScope::~DeviceScope() {
  if (before_ >= 0) cudaSetDevice(before_);
}

Stream::Stream(int device, const std::string& name) : device_(device) {
  const DeviceScope scope(device);
  // Does not wait for the default stream, and the default stream does not wait for it.
  check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "cudaStreamCreateWithFlags", name);
  cudaMemPoolProps properties{};
  properties.allocType = cudaMemAllocationTypePinned;
  properties.location.type = cudaMemLocationTypeDevice;
  properties.location.id = device;
  if (const cudaError_t code = cudaMemPoolCreate(&pool_, &properties); code != cudaSuccess) {
    cudaStreamDestroy(stream_);
    check(code, "cudaMemPoolCreate", name);
  }
  // Freed memory stays with the pool until the device is closed: phases reuse each other's.
  std::uint64_t keep = std::numeric_limits<std::uint64_t>::max();
  cudaMemPoolSetAttribute(pool_, cudaMemPoolAttrReleaseThreshold, &keep);
}

Stream::~Stream() {
  const DeviceScope scope(device_);
  cudaStreamSynchronize(stream_);
  cudaMemPoolDestroy(pool_);
  cudaStreamDestroy(stream_);
}

CudaDevice::CudaDevice(DeviceInfo info, unsigned block_size)
    : info_(std::move(info)),
      block_size_(block_size != 0 ? std::clamp(block_size, 1U, 256U) : default_block),
      stream_(std::make_shared<Stream>(info_.index, info_.name)) {}

CudaDevice::~CudaDevice() {
  const DeviceScope scope(info_.index);
  cudaStreamSynchronize(stream_->get());
}

LaunchShape CudaDevice::shape() const noexcept {
  return {.contiguous = false, .parallelism = std::max(1U, info_.compute_units) * 2048U, .grain = 1};
}

std::unique_ptr<Buffer> CudaDevice::allocate(std::size_t bytes) {
  const DeviceScope scope(info_.index);
  void* data = nullptr;
  const cudaError_t code =
      cudaMallocFromPoolAsync(&data, std::max<std::size_t>(bytes, 8), stream_->pool(), stream_->get());
  if (code == cudaErrorMemoryAllocation) {
    cudaGetLastError();
    std::size_t available = 0, total = 0;
    cudaMemGetInfo(&available, &total);
    throw OutOfMemory("'" + info_.name + "' cannot hold a buffer of " + std::to_string(bytes) + " bytes; it has " +
                          std::to_string(available) + " bytes free: use fewer points",
                      bytes, available);
  }
  check_call(code, "cudaMallocFromPoolAsync");
  return std::make_unique<CudaBuffer>(stream_, data, bytes);
}

std::unique_ptr<Buffer> CudaDevice::alias(const void* /*data*/, std::size_t /*bytes*/) {
  return nullptr;  // host memory would be fetched over the bus again and again
}

void CudaDevice::write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
  const DeviceScope scope(info_.index);
  check_call(cudaMemcpyAsync(data_of(to) + offset, from, bytes, cudaMemcpyHostToDevice, stream_->get()),
             "cudaMemcpyAsync");
  finish();
}

void CudaDevice::read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) {
  if (bytes == 0) return;
  const DeviceScope scope(info_.index);
  check_call(cudaMemcpyAsync(to, data_of(from) + offset, bytes, cudaMemcpyDeviceToHost, stream_->get()),
             "cudaMemcpyAsync");
  finish();
}

void CudaDevice::fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) {
  if (bytes == 0) return;
  const DeviceScope scope(info_.index);
  const auto byte = static_cast<int>(word & 0xFFU);
  if (word != 0x01010101U * (word & 0xFFU)) throw InternalError("a fill with a word of unequal bytes");
  check_call(cudaMemsetAsync(data_of(to) + offset, byte, bytes, stream_->get()), "cudaMemsetAsync");
}

void CudaDevice::launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, bool wide) {
  if (items == 0) return;
  if (args.size() > most_parameters) throw InternalError("a kernel with too many parameters");
  const DeviceScope scope(info_.index);
  std::array<void*, most_parameters> pointers{};
  std::array<void*, most_parameters> addresses{};
  for (std::size_t i = 0; i < args.size(); ++i) {
    if (args[i].is_buffer()) {
      pointers[i] = args[i].buffer() == nullptr ? nullptr : data_of(*args[i].buffer());
      addresses[i] = &pointers[i];
    } else {
      addresses[i] = const_cast<void*>(args[i].value());
    }
  }
  const void* function = (wide ? wide_kernels() : narrow_kernels())[static_cast<std::size_t>(kernel)];
  const unsigned block = std::min<unsigned>(block_size_, items);
  const unsigned blocks = (items - 1) / block + 1;
  check_call(cudaLaunchKernel(function, dim3(blocks), dim3(block), addresses.data(), 0, stream_->get()),
             kernel_names[static_cast<std::size_t>(kernel)]);
}

void CudaDevice::finish() {
  const DeviceScope scope(info_.index);
  check_call(cudaStreamSynchronize(stream_->get()), "cudaStreamSynchronize");
}

}  // namespace cadt::cuda
