// SPDX-License-Identifier: Apache-2.0
#include "common/host/counters.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include "common/host/device_constants.hpp"

namespace cadt {

using namespace device_constants;

Counters::Counters(Device& device, Memory& memory)
    : device_(device),
      buffer_(memory.allocate_zeros(sizeof(std::uint32_t) * CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE)) {}

void Counters::collect(Statistics& statistics) const {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(CADT_COUNTER_ROWS) * CADT_COUNTER_STRIDE);
  device_.read(*buffer_, 0, words.data(), words.size() * sizeof words[0]);
  std::array<std::uint64_t, CADT_COUNTERS> sums{};
  for (std::size_t row = 0; row < CADT_COUNTER_ROWS; ++row)
    for (std::size_t c = 0; c < CADT_COUNTERS; ++c) sums[c] += words[row * CADT_COUNTER_STRIDE + c];
  statistics.walk_steps += sums[CADT_COUNT_WALK_STEPS];
  statistics.claims += sums[CADT_COUNT_CLAIMS];
  statistics.lost_claims += sums[CADT_COUNT_LOST_CLAIMS];
  statistics.insert_retries += sums[CADT_COUNT_INSERT_RETRIES];
  statistics.stale_edges += sums[CADT_COUNT_STALE_EDGES];
  statistics.deferred_points += sums[CADT_COUNT_DEFERRED_POINTS];
  statistics.deferred_edges += sums[CADT_COUNT_DEFERRED_EDGES];
  statistics.splits += sums[CADT_COUNT_SPLITS];
  statistics.edge_splits += sums[CADT_COUNT_EDGE_SPLITS];
  statistics.flips += sums[CADT_COUNT_FLIPS];
  statistics.incircle_tests += sums[CADT_COUNT_INCIRCLE_TESTS];
  statistics.exact_orientations += sums[CADT_COUNT_EXACT_ORIENTATIONS];
  statistics.exact_incircles += sums[CADT_COUNT_EXACT_INCIRCLES];
  statistics.ties += sums[CADT_COUNT_TIES];
}

}  // namespace cadt
