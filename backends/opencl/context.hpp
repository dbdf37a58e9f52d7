// SPDX-License-Identifier: Apache-2.0
// What the open devices of a process share: a context and its programs.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "backends/opencl/cl.hpp"
#include "backends/opencl/open.hpp"
#include "backends/opencl/platform.hpp"
#include "backends/opencl/program.hpp"
#include "common/driver/kernel_id.hpp"

namespace cadt::opencl {

/// A context with the programs built in it. Shared by several devices. Thread-safe.
class SharedContext {
 public:
  /// \throws BackendUnavailable, DeviceError
  explicit SharedContext(const OpenRequest& request);

  [[nodiscard]] const FoundDevice& device() const noexcept { return device_; }
  [[nodiscard]] const cl::Context& context() const noexcept { return context_; }

  /// Built at the first call. \throws KernelBuildError, DeviceError
  [[nodiscard]] cl::Program program(Stage stage, KernelVariant variant, bool* from_cache = nullptr);

  /// Runs `test` unless it has passed before in this context; it counts as passed when it returns.
  template <class Test>
  void once(const Test& test) {
    const std::lock_guard lock(test_mutex_);
    if (tested_) return;
    test();
    tested_ = true;
  }

  /// Bytes in buffers of this context: drivers that defer allocation accept far more than there is.
  std::atomic<std::uint64_t> held{0};
  /// The runtime has lost the context; it must not be handed out any more.
  std::atomic<bool> lost{false};

 private:
  FoundDevice device_;
  cl::Context context_;
  AtomicsPath atomics_;
  std::string source_, extra_options_;
  std::mutex build_mutex_, test_mutex_;
  std::array<std::array<std::optional<cl::Program>, stage_count>, kernel_variants> programs_;
  bool tested_ = false;
};

/// The process's context for this device and these build options, created at the first call.
[[nodiscard]] std::shared_ptr<SharedContext> shared_context(const OpenRequest& request);

}  // namespace cadt::opencl
