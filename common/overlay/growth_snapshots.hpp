// SPDX-License-Identifier: Apache-2.0
// Snapshots of the growing mesh for Tuning::watch.
#pragma once

#include "common/driver/context.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// Reads all triangles and calls Tuning::watch. \pre no launch is running that changes the mesh
void show_snapshot(Context& ctx, const Allocation& locked, const SortedPoints& order);

}  // namespace cadt
