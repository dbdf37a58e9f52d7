// SPDX-License-Identifier: Apache-2.0
#include "common/driver/counters.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

namespace {

/// In the order of CADT_TIME_...
constexpr std::array<const char*, CADT_TIMERS> timers = {"locate", "lock",      "split", "test",
                                                         "flip",   "neighbors", "other", "wait"};

static_assert(int{CADT_COUNTERS} <= int{CADT_ROW_TIMES} &&
              CADT_ROW_TIMES + int{CADT_TIMERS} <= int{CADT_ROW_LOST_LOCKS} &&
              int{CADT_ROW_LOST_LOCKS} < int{CADT_COUNTER_STRIDE});
static_assert(std::tuple_size_v<decltype(Statistics::flips_per_edge)> == CADT_FLIP_BINS);

/// cadt_flush_exact adds three counts to three words, wherever they are.
constexpr bool are_three(int orientations, int incircles, int ties) {
  return incircles == orientations + 1 && ties == orientations + 2;
}
static_assert(are_three(CADT_COUNT_EXACT_ORIENTATIONS, CADT_COUNT_EXACT_INCIRCLES, CADT_COUNT_TIES));
static_assert(are_three(CADT_STARS_EXACT_ORIENTATIONS, CADT_STARS_EXACT_INCIRCLES, CADT_STARS_TIES));
static_assert(are_three(CADT_WRAP_EXACT_ORIENTATIONS, CADT_WRAP_EXACT_INCIRCLES, CADT_WRAP_TIES));

/// Rows that the work-items of this call have added to: on CPUs, where none does another's work, as many as there were
/// in one launch.
std::size_t rows_used(const Context& ctx) {
  constexpr std::size_t all = CADT_COUNTER_ROWS;
  return ctx.device.shape().contiguous ? std::min<std::size_t>(all, ctx.launcher.most_items()) : all;
}

}  // namespace

Counters::Counters(Context& ctx, std::size_t lost_locks) : ctx_(ctx), lost_locks_(lost_locks) {
  if (ctx.options.statistics == StatisticsDetail::none) return;
  buffer_ = ctx.memory.allocate_zeros(word * (CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE + lost_locks));
  const std::uint32_t counted = lost_locks != 0 ? 1 : 0;
  if (counted != 0) ctx.device.write(*buffer_, CADT_ROW_LOST_LOCKS * word, &counted, word);
}

void Counters::clear() {
  if (buffer_) ctx_.device.fill(*buffer_, 0, sizeof(std::uint32_t) * CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE, 0);
}

void Counters::collect(Statistics& statistics) const {
  if (!buffer_) return;
  add_counters(statistics, ctx_.device.read_values(*buffer_, rows_used(ctx_) * CADT_COUNTER_STRIDE));
}

void add_counters(Statistics& statistics, std::span<const std::uint32_t> words) {
  std::array<std::uint64_t, CADT_COUNTER_STRIDE> sums{};
  for (std::size_t i = 0; i < words.size(); ++i) sums[i % CADT_COUNTER_STRIDE] += words[i];
  const auto times = std::span(sums).subspan(CADT_ROW_TIMES, CADT_TIMERS);
  const auto all = static_cast<double>(std::accumulate(times.begin(), times.end(), std::uint64_t{0}));
  // With the star stage certification adds counters too: the times are those of the insertion, which comes first.
  for (std::size_t i = statistics.thread_time.size(); all > 0 && i < times.size(); ++i)
    statistics.thread_time.emplace_back(timers[i], static_cast<double>(times[i]) / all);
  statistics.walk_steps += sums[CADT_COUNT_WALK_STEPS];
  statistics.lock_attempts += sums[CADT_COUNT_LOCK_ATTEMPTS];
  statistics.lock_failures += sums[CADT_COUNT_LOCK_FAILURES];
  statistics.invalid_restarts += sums[CADT_COUNT_INVALIDATED];
  statistics.insert_retries += sums[CADT_COUNT_INSERT_RETRIES];
  statistics.stale_edges += sums[CADT_COUNT_STALE_EDGES];
  statistics.deferred_points += sums[CADT_COUNT_DEFERRED_POINTS];
  statistics.deferred_edges += sums[CADT_COUNT_DEFERRED_EDGES];
  statistics.splits += sums[CADT_COUNT_SPLITS];
  statistics.edge_splits += sums[CADT_COUNT_EDGE_SPLITS];
  statistics.flips += sums[CADT_COUNT_FLIPS];
  statistics.incircle_tests += sums[CADT_COUNT_INCIRCLE_TESTS];
  statistics.stabilized_edges += sums[CADT_COUNT_STABILIZED];
  statistics.orientation_tests += sums[CADT_COUNT_ORIENTATION_TESTS];
  statistics.exact_orientations += sums[CADT_COUNT_EXACT_ORIENTATIONS];
  statistics.exact_incircles += sums[CADT_COUNT_EXACT_INCIRCLES];
  statistics.ties += sums[CADT_COUNT_TIES];
}

void add_counters(Statistics& to, const Statistics& from) {
  for (const NamedCounter& counter : counters_of_work) to.*counter.value += from.*counter.value;
  to.bytes_to_device += from.bytes_to_device;
  to.bytes_from_device += from.bytes_from_device;
  for (std::size_t i = 0; i < to.flips_per_edge.size(); ++i) to.flips_per_edge[i] += from.flips_per_edge[i];
  to.bytes_device_peak = std::max(to.bytes_device_peak, from.bytes_device_peak);
  to.wide_arithmetic = to.wide_arithmetic || from.wide_arithmetic;
}

std::vector<std::uint32_t> Counters::lost_locks() const {
  if (!buffer_ || lost_locks_ == 0) return {};
  return ctx_.device.read_values(*buffer_, lost_locks_, std::size_t{CADT_COUNTER_ROWS} * CADT_COUNTER_STRIDE);
}

FlipHistogram::FlipHistogram(Context& ctx, bool wanted) : ctx_(ctx) {
  if (ctx.options.statistics == StatisticsDetail::none || !wanted) return;
  buffer_ = ctx.memory.allocate_zeros(sizeof(std::uint32_t) * CADT_COUNTER_ROWS * CADT_FLIP_BINS);
}

void FlipHistogram::collect(Statistics& statistics) const {
  if (!buffer_) return;
  const auto words = ctx_.device.read_values(*buffer_, rows_used(ctx_) * CADT_FLIP_BINS);
  std::array<std::uint64_t, CADT_FLIP_BINS> sums{};
  for (std::size_t i = 0; i < words.size(); ++i) sums[i % CADT_FLIP_BINS] += words[i];
  for (std::size_t i = 0; i < sums.size(); ++i) statistics.flips_per_edge[i] += sums[i] / 2;  // counted from both sides
}

}  // namespace cadt
