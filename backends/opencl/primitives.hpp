// SPDX-License-Identifier: Apache-2.0
// Sort and scan of kernels_cl/primitives.cl, for GPUs.
#pragma once

#include <initializer_list>

#include "backends/opencl/device.hpp"

namespace cadt::opencl {

class ClPrimitives final : public Primitives {
 public:
  /// nullptr if the device or its program cannot run them. Must not outlive the device.
  [[nodiscard]] static std::unique_ptr<Primitives> make(ClDevice& device) noexcept;
  explicit ClPrimitives(ClDevice& device);

  [[nodiscard]] std::size_t sort_scratch(std::size_t count, unsigned bits) override;
  [[nodiscard]] bool sorts_places(std::size_t) const noexcept override { return true; }
  [[nodiscard]] bool sort(Buffer& scratch, Buffer& keys, Buffer& values, Buffer& other_keys, Buffer& other_values,
                          std::size_t count, unsigned bits, bool places) override;
  [[nodiscard]] std::size_t scan_scratch(std::size_t count) override;
  void scan(Buffer& scratch, Buffer& data, std::size_t count) override;

 private:
  void run(ClDevice::ReadyKernel& kernel, std::size_t groups, std::initializer_list<Arg> args) {
    device_.enqueue(kernel, groups, {args.begin(), args.size()});
  }
  /// Scans `count` words from `at` on; its temporaries lie in the scratch memory from `scratch_at` on.
  void scan_words(Buffer& scratch, std::uint32_t scratch_at, Buffer& data, std::uint32_t at, std::size_t count);

  ClDevice& device_;
  ClDevice::ReadyKernel tile_sums_, tile_scan_, digit_counts_, digit_scatter_;
};

}  // namespace cadt::opencl
