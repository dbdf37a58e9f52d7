// SPDX-License-Identifier: Apache-2.0
// Snapshots of the growing mesh for Tuning::watch.
#pragma once

#include "common/driver/context.hpp"
#include "common/driver/counters.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// Triangles whose lost locks are counted (Snapshot::lost_locks): all, or 0 where nobody watches or no kernel counts.
[[nodiscard]] std::size_t counted_lost_locks(const Options& options, const SortedPoints& order) noexcept;

/// Reads all triangles and counters, adds them to `snapshot`, and calls Tuning::watch. \pre no launch is running that
/// changes the mesh
void show_snapshot(Context& ctx, const Allocation& locked, const SortedPoints& order, const Counters& counters,
                   Snapshot snapshot);

}  // namespace cadt
