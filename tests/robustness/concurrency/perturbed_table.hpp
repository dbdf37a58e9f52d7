// SPDX-License-Identifier: Apache-2.0
// What the perturbed kernels of the host (perturbed_table.cpp) tell the tests.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace cadt::test {

inline constexpr std::size_t most_sites = 32;
/// Names of common/overlay/schedule_noise.dev.h that the tests need.
enum class Site : std::size_t { claimed, released, abandoned };
[[nodiscard]] std::size_t number_of_sites();
[[nodiscard]] std::size_t index_of(Site site);

/// How often each site was passed, all work-items together.
extern std::atomic<std::uint64_t> site_counts[most_sites];

/// The records as they are when the triangles are counted, behind the last closing pass.
struct RecordCounts {
  std::uint64_t live = 0;  ///< lock word not 0
  std::uint64_t held = 0;  ///< lock word odd
};
extern RecordCounts last_records;

}  // namespace cadt::test
