// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/statistics.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/driver/context.hpp"

namespace cadt {

/// The device's counters of work and conflicts (common/portable/counters.dev.h). Passed to kernels as their buffer,
/// null for StatisticsDetail::none.
class Counters {
 public:
  explicit Counters(Context& ctx);
  operator Arg() const noexcept { return buffer_; }  // NOLINT
  /// Reads the counters and adds all rows to the statistics.
  void collect(Statistics& statistics) const;

 private:
  Device& device_;
  Allocation buffer_;
};

/// Adds these rows of counters to the statistics.
void add_counters(Statistics& statistics, std::span<const std::uint32_t> rows);

/// The device's histogram of flips per edge (common/overlay/flip_histogram.dev.h). Passed to kernels as its buffer,
/// null for StatisticsDetail::none.
class FlipHistogram {
 public:
  /// `wanted`: if false, nothing is counted.
  explicit FlipHistogram(Context& ctx, bool wanted = true);
  operator Arg() const noexcept { return buffer_; }  // NOLINT
  /// Adds the histogram to the statistics. `sides`: the number of all sides of edges, two an edge, if the device did
  /// not count all of them: the others had no flips; 0: it did.
  void collect(Statistics& statistics, std::uint64_t sides = 0) const;

 private:
  Device& device_;
  Allocation buffer_;
};

}  // namespace cadt
