// SPDX-License-Identifier: Apache-2.0
// A CUDA device: buffers, copies, launches, and CUB's primitives.
#pragma once

#include <memory>

#include "backends/cuda/clock.hpp"
#include "backends/cuda/context.hpp"
#include "backends/cuda/transfer.hpp"
#include "common/driver/buffer_cache.hpp"
#include "common/driver/device.hpp"

namespace cadt::cuda {

class CudaDevice final : public Device, private Primitives {
 public:
  /// \throws DeviceError
  CudaDevice(DeviceInfo info, const Options& options);
  ~CudaDevice() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LaunchShape shape() const noexcept override;
  [[nodiscard]] unsigned threads() const noexcept override { return info_.compute_units; }
  [[nodiscard]] std::unique_ptr<Buffer> allocate(std::size_t bytes) override;
  [[nodiscard]] std::unique_ptr<Buffer> alias(const void* data, std::size_t bytes) override;
  [[nodiscard]] std::unique_ptr<Buffer> wrap(void* pointer, std::size_t bytes) override;
  [[nodiscard]] void* handle(const Buffer& buffer) const noexcept override;
  /// The pool caches memory, or the caller's allocator.
  [[nodiscard]] std::unique_ptr<BufferCache> make_cache() override { return nullptr; }
  void reserve(std::size_t bytes) override;
  void trim() override;
  [[nodiscard]] std::size_t free_bytes() override;
  [[nodiscard]] Primitives* primitives() noexcept override { return this; }
  [[nodiscard]] Copied copied() const noexcept override { return copied_; }
  void write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) override;
  void read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) override;
  void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) override;
  using Device::launch;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant variant,
              std::uint32_t group) override;
  void finish() override;
  [[nodiscard]] KernelClock* kernel_clock() noexcept override { return clock_ ? &*clock_ : nullptr; }
  void start_times() override;
  void mark_time() override;
  [[nodiscard]] std::vector<double> times() override;
  [[nodiscard]] std::optional<double> occupancy(unsigned work_group_size) override;

  [[nodiscard]] CUcontext context() const noexcept { return stream_->context(); }
  /// Does the work of first use, so that no later launch has to: that may synchronise the context.
  void load_kernels();

 private:
  [[nodiscard]] std::size_t sort_scratch(std::size_t count, unsigned bits) override;
  [[nodiscard]] bool sorts_places(std::size_t count) const noexcept override;
  [[nodiscard]] bool sort(Buffer& scratch, Buffer& keys, Buffer& values, Buffer& other_keys, Buffer& other_values,
                          std::size_t count, unsigned bits, bool places) override;
  [[nodiscard]] std::size_t scan_scratch(std::size_t count) override;
  void scan(Buffer& scratch, Buffer& data, std::size_t count) override;
  /// Largest block size that a kernel can be launched with. \pre the context is current
  [[nodiscard]] unsigned largest_block_of(std::size_t variant, std::size_t kernel);
  void check_call(cudaError_t code, const char* call) const { check(code, call, info_.name); }

  DeviceInfo info_;
  unsigned block_size_;
  bool block_size_asked_;
  std::shared_ptr<Stream> stream_;
  std::array<std::array<unsigned, kernel_count>, kernel_variants> largest_blocks_{};  ///< 0: not queried yet
  std::vector<cudaEvent_t> events_;  ///< of this call and earlier ones; the first `marks_` are in use
  std::size_t marks_ = 0;
  void* staging_ = nullptr;  ///< page-locked host memory for small reads
  Transfer transfer_;        ///< large copies
  std::optional<CudaClock> clock_;
  Copied copied_;
};

}  // namespace cadt::cuda
