// SPDX-License-Identifier: Apache-2.0
// The time that each kernel of a call takes (Tuning::kernel_times).
#pragma once

#include <cadt/statistics.hpp>

#include <cstddef>
#include <vector>

#include "common/driver/device.hpp"

namespace cadt {

/// Times each launch by the device's clock. Does nothing if the device was opened without one.
class KernelTimes {
 public:
  /// Timed besides the kernels of the list: whole calls of the device's own primitives.
  static constexpr std::size_t sort = kernel_count, scan = kernel_count + 1;

  explicit KernelTimes(Device& device) noexcept : clock_(device.kernel_clock()) {
    if (clock_ != nullptr) clock_->clear();  // an earlier call may have been cancelled
  }

  /// Runs and times `work`, a launch of one kernel or primitive.
  template <class Work>
  void time(std::size_t what, const Work& work) {
    if (clock_ == nullptr) {
      work();
      return;
    }
    clock_->begin();
    work();
    clock_->end();
    launched_.push_back(what);
  }

  /// Sums by kernel, longest first; none without a clock. Waits for the device. \throws DeviceError
  [[nodiscard]] std::vector<KernelTime> sums();

 private:
  KernelClock* clock_;
  std::vector<std::size_t> launched_;
};

}  // namespace cadt
