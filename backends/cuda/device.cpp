// SPDX-License-Identifier: Apache-2.0
#include "backends/cuda/device.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <thread>

#include "kernels_cuda/kernels.hpp"
#include "kernels_cuda/primitives.hpp"

namespace cadt::cuda {
namespace {

constexpr unsigned default_block = 128;  // leaves several resident blocks an SM even for kernels with many registers
constexpr unsigned largest_block = 1024;
constexpr std::size_t most_parameters = 32;
constexpr std::size_t staging_bytes = std::size_t{1} << 16;

class CudaBuffer final : public Buffer {
 public:
  /// `stream`: null for memory that the caller owns.
  CudaBuffer(std::shared_ptr<Stream> stream, void* data, std::size_t bytes) noexcept
      : Buffer(bytes), stream_(std::move(stream)), data_(data) {}
  ~CudaBuffer() override {
    if (stream_ == nullptr) return;
    const ContextScope scope(stream_->context());
    stream_->deallocate(data_, bytes());
  }
  [[nodiscard]] std::byte* data() const noexcept { return static_cast<std::byte*>(data_); }

 private:
  std::shared_ptr<Stream> stream_;
  void* data_;
};

/// In the order of KernelVariant.
std::array<const void* const*, kernel_variants> tables() { return {narrow_kernels(), wide_kernels(), timed_kernels()}; }

std::byte* data_of(const Buffer& buffer) { return static_cast<const CudaBuffer&>(buffer).data(); }
std::uint32_t* words_of(const Buffer& buffer) { return reinterpret_cast<std::uint32_t*>(data_of(buffer)); }

void check_range(const char* what, const Buffer& buffer, std::size_t offset, std::size_t bytes) {
  if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
    throw InternalError(std::string(what) + " of " + std::to_string(bytes) + " bytes at " + std::to_string(offset) +
                        " exceeds a buffer of " + std::to_string(buffer.bytes()));
}

/// CUB mistakes an error that the caller has not fetched yet for its own. Errors are kept per thread, so in that case
/// another thread does the work; except in the per-thread default stream, where the error is cleared.
template <class Work>
cudaError_t without_earlier_error(const Stream& stream, const Work& work) {
  if (cudaPeekAtLastError() == cudaSuccess) return work();
  if (stream.get() == cudaStreamPerThread) {
    cudaGetLastError();
    return work();
  }
  cudaError_t code = cudaSuccess;
  std::thread([&] {
    const ContextScope scope(stream.context());
    code = work();
  }).join();
  return code;
}

}  // namespace

CudaDevice::CudaDevice(DeviceInfo info, const Options& options)
    : info_(std::move(info)),
      block_size_(options.tuning.work_group_size != 0 ? std::clamp(options.tuning.work_group_size, 1U, largest_block)
                                                      : default_block),
      block_size_asked_(options.tuning.work_group_size != 0),
      stream_(std::make_shared<Stream>(info_.index, info_.name, options.queue, options.allocator)),
      transfer_(stream_, options.threads) {
  const ContextScope scope(stream_->context());
  check_call(cudaHostAlloc(&staging_, staging_bytes, cudaHostAllocDefault), "cudaHostAlloc");
  if (options.tuning.kernel_times) clock_.emplace(stream_);
}

CudaDevice::~CudaDevice() {
  const ContextScope scope(stream_->context());
  ignore(cudaStreamSynchronize(stream_->get()));
  ignore(cudaFreeHost(staging_));
  for (cudaEvent_t event : events_) ignore(cudaEventDestroy(event));
}

LaunchShape CudaDevice::shape() const noexcept {
  const unsigned units = std::max(1U, info_.compute_units);
  return {.contiguous = false, .parallelism = units * 2048U, .grain = 1, .resident = units * 512U};
}

std::unique_ptr<Buffer> CudaDevice::allocate(std::size_t bytes) {
  const ContextScope scope(stream_->context());
  const std::size_t size = std::max<std::size_t>(bytes, 8);
  return std::make_unique<CudaBuffer>(stream_, stream_->allocate(size), size);
}

std::unique_ptr<Buffer> CudaDevice::alias(const void* /*data*/, std::size_t /*bytes*/) {
  return nullptr;  // a GPU would fetch host memory over the bus again and again
}

std::unique_ptr<Buffer> CudaDevice::wrap(void* pointer, std::size_t bytes) {
  return std::make_unique<CudaBuffer>(nullptr, pointer, bytes);
}

void* CudaDevice::handle(const Buffer& buffer) const noexcept { return data_of(buffer); }

void CudaDevice::reserve(std::size_t bytes) {
  if (stream_->has_allocator()) return;  // the caller's allocator manages its memory itself
  const ContextScope scope(stream_->context());
  // A little more, since the pool rounds sizes up and cannot use every gap.
  const std::size_t taken = bytes + bytes / 8 + (std::size_t{64} << 20);
  stream_->deallocate(stream_->allocate(taken), taken);
  stream_->wait();
}

void CudaDevice::trim() {
  const ContextScope scope(stream_->context());
  transfer_.release();
  stream_->trim();
}

std::size_t CudaDevice::free_bytes() {
  if (stream_->has_allocator()) return std::numeric_limits<std::size_t>::max();
  const ContextScope scope(stream_->context());
  return stream_->free_bytes();
}

void CudaDevice::write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) {
  check_range("a write", to, offset, bytes);
  if (bytes == 0) return;
  copied_.to_device += bytes;
  const ContextScope scope(stream_->context());
  if (transfer_.prepare(from, bytes)) return transfer_.to_device(data_of(to) + offset, from, bytes);
  check_call(cudaMemcpyAsync(data_of(to) + offset, from, bytes, cudaMemcpyHostToDevice, stream_->get()),
             "cudaMemcpyAsync");
  stream_->wait();
}

void CudaDevice::read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) {
  check_range("a read", from, offset, bytes);
  if (bytes == 0) return;
  copied_.from_device += bytes;
  const ContextScope scope(stream_->context());
  if (transfer_.prepare(to, bytes)) return transfer_.to_host(to, data_of(from) + offset, bytes);
  // Small results are read through page-locked memory, which halves their time.
  const bool small = bytes <= staging_bytes;
  check_call(
      cudaMemcpyAsync(small ? staging_ : to, data_of(from) + offset, bytes, cudaMemcpyDeviceToHost, stream_->get()),
      "cudaMemcpyAsync");
  stream_->wait();
  if (small) std::memcpy(to, staging_, bytes);
}

void CudaDevice::fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) {
  check_range("a fill", to, offset, bytes);
  if (offset % 4 != 0 || bytes % 4 != 0) throw InternalError("a fill is not a multiple of four bytes");
  if (bytes == 0) return;
  const ContextScope scope(stream_->context());
  stream_->fill(data_of(to) + offset, word, bytes / sizeof word);
}

void CudaDevice::launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant variant,
                        std::uint32_t group) {
  if (items == 0) return;
  if (args.size() > most_parameters) throw InternalError("a kernel with too many parameters");
  const ContextScope scope(stream_->context());
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
  const auto table = static_cast<std::size_t>(variant), number = static_cast<std::size_t>(kernel);
  const void* function = tables()[table][number];
  const unsigned wanted = group == 0 || block_size_asked_ ? block_size_ : group;
  const unsigned block = std::min({wanted, items, largest_block_of(table, number)});
  const unsigned blocks = (items - 1) / block + 1;
  check_call(cudaLaunchKernel(function, dim3(blocks), dim3(block), addresses.data(), 0, stream_->get()),
             kernel_names[static_cast<std::size_t>(kernel)]);
}

unsigned CudaDevice::largest_block_of(std::size_t variant, std::size_t kernel) {
  unsigned& known = largest_blocks_[variant][kernel];
  if (known == 0) {
    cudaFuncAttributes attributes{};  // querying them loads the kernel
    check_call(cudaFuncGetAttributes(&attributes, tables()[variant][kernel]), kernel_names[kernel]);
    known = static_cast<unsigned>(attributes.maxThreadsPerBlock);
  }
  return known;
}

void CudaDevice::finish() {
  const ContextScope scope(stream_->context());
  stream_->wait();
}

void CudaDevice::start_times() {
  marks_ = 0;
  mark_time();
}

void CudaDevice::mark_time() {
  const ContextScope scope(stream_->context());
  if (marks_ == events_.size()) {
    cudaEvent_t event = nullptr;
    check_call(cudaEventCreate(&event), "cudaEventCreate");
    events_.push_back(event);
  }
  check_call(cudaEventRecord(events_[marks_], stream_->get()), "cudaEventRecord");
  ++marks_;
}

std::vector<double> CudaDevice::times() {
  const ContextScope scope(stream_->context());
  std::vector<double> between;
  for (std::size_t i = 1; i < marks_; ++i) {
    float milliseconds = 0;
    check_call(cudaEventSynchronize(events_[i]), "cudaEventSynchronize");
    check_call(cudaEventElapsedTime(&milliseconds, events_[i - 1], events_[i]), "cudaEventElapsedTime");
    between.push_back(milliseconds);
  }
  return between;
}

void CudaDevice::load_kernels() {
  const ContextScope scope(stream_->context());
  for (std::size_t variant = 0; variant < kernel_variants; ++variant)
    for (std::size_t i = 0; i < kernel_count; ++i) static_cast<void>(largest_block_of(variant, i));
  // The first launch of a kernel with a larger stack makes the driver enlarge the local memory of the context, which
  // synchronises the context as well. With parameters of zero these kernels find no work.
  std::uint64_t zero = 0;
  std::array<void*, most_parameters> parameters{};
  parameters.fill(&zero);
  for (const void* const* table : tables())
    for (const KernelId kernel : {KernelId::cadt_insert, KernelId::cadt_legalize_edges, KernelId::cadt_legality_sweep})
      check_call(cudaLaunchKernel(table[static_cast<std::size_t>(kernel)], dim3(1), dim3(1), parameters.data(), 0,
                                  stream_->get()),
                 kernel_names[static_cast<std::size_t>(kernel)]);
  // CUB's kernels have no names to query, so they are run: it has different kernels for few keys and for many.
  for (const std::size_t count : {std::size_t{1} << 8, std::size_t{1} << 17}) {
    const auto keys = allocate(4 * count), values = allocate(4 * count);
    const auto other_keys = allocate(4 * count), other_values = allocate(4 * count);
    for (const auto* buffer : {&keys, &values}) fill(**buffer, 0, 4 * count, 0);
    const auto sort_memory = allocate(sort_scratch(count, 32)), scan_memory = allocate(scan_scratch(count));
    static_cast<void>(sort(*sort_memory, *keys, *values, *other_keys, *other_values, count, 32, false));
    scan(*scan_memory, *keys, count);
  }
  finish();
}

std::optional<double> CudaDevice::occupancy(unsigned work_group_size) {
  const ContextScope scope(stream_->context());
  const auto insert = static_cast<std::size_t>(KernelId::cadt_insert);
  if (work_group_size == 0 || work_group_size > largest_block_of(0, insert)) return 0.0;
  int blocks = 0, most = 0, device = 0, warp = 0;
  check_call(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, narrow_kernels()[insert],
                                                           static_cast<int>(work_group_size), 0),
             "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
  check_call(cudaGetDevice(&device), "cudaGetDevice");
  check_call(cudaDeviceGetAttribute(&most, cudaDevAttrMaxThreadsPerMultiProcessor, device), "cudaDeviceGetAttribute");
  check_call(cudaDeviceGetAttribute(&warp, cudaDevAttrWarpSize, device), "cudaDeviceGetAttribute");
  const int warps = (static_cast<int>(work_group_size) - 1) / warp + 1;  // warps a block; the last may not be full
  return static_cast<double>(blocks * warps) / (static_cast<double>(most) / warp);
}

bool CudaDevice::sorts_places(std::size_t count) const noexcept { return count <= most_in_group; }

std::size_t CudaDevice::sort_scratch(std::size_t count, unsigned bits) {
  const ContextScope scope(stream_->context());
  std::size_t bytes = 0;
  check_call(without_earlier_error(*stream_,
                                   [&] {
                                     return sort_pairs(nullptr, bytes, nullptr, nullptr, nullptr, nullptr,
                                                       static_cast<std::uint32_t>(count), bits, false, stream_->get(),
                                                       nullptr);
                                   }),
             "cub::DeviceRadixSort");
  return bytes;
}

bool CudaDevice::sort(Buffer& scratch, Buffer& keys, Buffer& values, Buffer& other_keys, Buffer& other_values,
                      std::size_t count, unsigned bits, bool places) {
  const ContextScope scope(stream_->context());
  std::size_t bytes = scratch.bytes();
  bool in_other = false;
  check_call(without_earlier_error(*stream_,
                                   [&] {
                                     return sort_pairs(data_of(scratch), bytes, words_of(keys), words_of(values),
                                                       words_of(other_keys), words_of(other_values),
                                                       static_cast<std::uint32_t>(count), bits, places, stream_->get(),
                                                       &in_other);
                                   }),
             "cub::DeviceRadixSort");
  return in_other;
}

std::size_t CudaDevice::scan_scratch(std::size_t count) {
  const ContextScope scope(stream_->context());
  std::size_t bytes = 0;
  check_call(
      without_earlier_error(
          *stream_,
          [&] { return exclusive_sum(nullptr, bytes, nullptr, static_cast<std::uint32_t>(count), stream_->get()); }),
      "cub::DeviceScan");
  return bytes;
}

void CudaDevice::scan(Buffer& scratch, Buffer& data, std::size_t count) {
  const ContextScope scope(stream_->context());
  std::size_t bytes = scratch.bytes();
  check_call(without_earlier_error(*stream_,
                                   [&] {
                                     return exclusive_sum(data_of(scratch), bytes, words_of(data),
                                                          static_cast<std::uint32_t>(count), stream_->get());
                                   }),
             "cub::DeviceScan");
}

}  // namespace cadt::cuda
