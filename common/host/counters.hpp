// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/statistics.hpp>

#include "common/host/device.hpp"
#include "common/host/memory.hpp"

namespace cadt {

/// The device's counters of work and conflicts (common/device/tally.h).
class Counters {
 public:
  Counters(Device& device, Memory& memory);
  operator Arg() const noexcept { return buffer_; }  // NOLINT
  /// Adds the counts of all rows to the statistics.
  void collect(Statistics& statistics) const;

 private:
  Device& device_;
  Allocation buffer_;
};

}  // namespace cadt
