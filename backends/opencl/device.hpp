// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "backends/opencl/clock.hpp"
#include "backends/opencl/context.hpp"
#include "common/driver/device.hpp"

namespace cadt::opencl {

/// A device with a queue and kernels of its own: cl_kernel holds its arguments, so it cannot serve two threads at once.
class ClDevice final : public Device {
 public:
  ClDevice(std::shared_ptr<SharedContext> shared, const OpenRequest& request);
  ~ClDevice() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return shared_->device().info; }
  [[nodiscard]] LaunchShape shape() const noexcept override;
  [[nodiscard]] unsigned threads() const noexcept override { return info().compute_units; }
  [[nodiscard]] std::unique_ptr<Buffer> allocate(std::size_t bytes) override;
  [[nodiscard]] std::unique_ptr<Buffer> alias(const void* data, std::size_t bytes) override;
  [[nodiscard]] std::unique_ptr<Buffer> wrap(void* memory, std::size_t bytes) override;
  [[nodiscard]] void* handle(const Buffer& buffer) const noexcept override;
  [[nodiscard]] std::unique_ptr<BufferCache> make_cache() override;
  [[nodiscard]] std::size_t free_bytes() override;
  [[nodiscard]] Copied copied() const noexcept override { return copied_; }
  void write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) override;
  void read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) override;
  void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) override;
  using Device::launch;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant variant,
              std::uint32_t group) override;
  void finish() override;
  [[nodiscard]] KernelClock* kernel_clock() noexcept override { return clock_ ? &*clock_ : nullptr; }
  [[nodiscard]] std::optional<double> occupancy(unsigned work_group_size) override;
  [[nodiscard]] Primitives* primitives() noexcept override;

  struct ReadyKernel {
    const char* name = nullptr;
    cl::Kernel kernel;
    cl_uint parameters = 0;
    std::size_t group = 1;  ///< work-items a group
  };
  /// A kernel for groups of `group` work-items, or of as many as the device allows.
  [[nodiscard]] ReadyKernel make_ready(const char* name, Stage stage, KernelVariant variant, std::size_t group);
  /// Enqueues groups of the kernel's size.
  void enqueue(ReadyKernel& kernel, std::size_t groups, std::span<const Arg> args) {
    enqueue(kernel, groups, kernel.group, args);
  }

 private:
  void enqueue(ReadyKernel& kernel, std::size_t groups, std::size_t group, std::span<const Arg> args);
  ReadyKernel& ready(KernelId kernel, KernelVariant variant);

  /// Calls `work` and translates exceptions of the bindings.
  template <class Work>
  void run(const Work& work);

  std::shared_ptr<SharedContext> shared_;
  cl::CommandQueue queue_;
  unsigned work_group_size_;
  std::size_t part_alignment_ = 0;
  std::shared_ptr<DeviceAllocator> allocator_;
  std::array<std::array<std::optional<ReadyKernel>, kernel_count>, kernel_variants> kernels_;
  std::optional<std::unique_ptr<Primitives>> primitives_;  ///< created on first use
  std::optional<ClClock> clock_;
  Copied copied_;
};

}  // namespace cadt::opencl
