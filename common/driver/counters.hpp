// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/statistics.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/driver/context.hpp"

namespace cadt {

/// The device's counters of work and conflicts (common/portable/counters.dev.h). Passed to a kernel: their memory, null
/// for StatisticsDetail::none.
class Counters {
 public:
  explicit Counters(Context& ctx);
  operator Arg() const noexcept { return buffer_; }  // NOLINT
  /// Adds the counts of all rows to the statistics.
  void collect(Statistics& statistics) const;

 private:
  Device& device_;
  Allocation buffer_;
};

/// Adds the counts of these rows to the statistics.
void add_counters(Statistics& statistics, std::span<const std::uint32_t> rows);

/// The device's counts of edges by their flips (common/overlay/flip_histogram.dev.h). Passed to a kernel: their memory,
/// null for StatisticsDetail::none.
class FlipHistogram {
 public:
  /// `wanted`: else nothing is counted.
  explicit FlipHistogram(Context& ctx, bool wanted = true);
  operator Arg() const noexcept { return buffer_; }  // NOLINT
  /// `sides`: of edges in all, if only some of those that were flipped were counted; an edge has two.
  void collect(Statistics& statistics, std::uint64_t sides = 0) const;

 private:
  Device& device_;
  Allocation buffer_;
};

}  // namespace cadt
