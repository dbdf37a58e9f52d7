// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/statistics.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/driver/context.hpp"

namespace cadt {

/// The device's counters of work and conflicts (common/portable/counters.dev.h). Passed to kernels as their buffer,
/// null for StatisticsDetail::none.
class Counters {
 public:
  /// `lost_locks`: triangles for which lost locks are counted, in the timed variant alone
  /// (common/overlay/lost_locks.dev.h).
  explicit Counters(Context& ctx, std::size_t lost_locks = 0);
  operator Arg() const noexcept { return buffer_; }  // NOLINT
  /// Forgets what was counted.
  void clear();
  /// Reads the counters and adds all rows to the statistics.
  void collect(Statistics& statistics) const;
  /// One a triangle; empty if they are not counted.
  [[nodiscard]] std::vector<std::uint32_t> lost_locks() const;

 private:
  Context& ctx_;
  Allocation buffer_;
  std::size_t lost_locks_;
};

/// Adds these rows of counters to the statistics.
void add_counters(Statistics& statistics, std::span<const std::uint32_t> rows);

/// Adds what a call from within another one has counted. Times are part of those of the other call.
void add_counters(Statistics& to, const Statistics& from);

/// The device's histogram of flips per edge (common/overlay/flip_histogram.dev.h). Passed to kernels as its buffer,
/// null for StatisticsDetail::none.
class FlipHistogram {
 public:
  /// `wanted`: if false, nothing is counted.
  FlipHistogram(Context& ctx, bool wanted);
  operator Arg() const noexcept { return buffer_; }  // NOLINT
  /// Adds the histogram to the statistics.
  void collect(Statistics& statistics) const;

 private:
  Context& ctx_;
  Allocation buffer_;
};

}  // namespace cadt
