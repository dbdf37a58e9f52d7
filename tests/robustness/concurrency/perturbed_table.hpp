// SPDX-License-Identifier: Apache-2.0
// What the perturbed kernels of the host (perturbed_table.cpp) report to the tests.
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

/// How often each site was passed, by all work-items.
extern std::atomic<std::uint64_t> site_counts[most_sites];

/// The locked triangles at the time when the triangles are counted, after the last legality sweep.
struct LockedCounts {
  std::uint64_t live = 0;  ///< lock word not 0
  std::uint64_t held = 0;  ///< lock word odd
};
extern LockedCounts last_locked;

}  // namespace cadt::test
