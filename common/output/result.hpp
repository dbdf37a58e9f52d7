// SPDX-License-Identifier: Apache-2.0
// From the mesh to the arrays of the result.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// Three words a triangle each: vertices, as input ids, counterclockwise; and neighbours.
struct ResultArrays {
  Allocation triangles, neighbors;
  std::size_t count = 0;
  bool on_host = false;  ///< the arrays alias those of `host`, which are filled when the device has finished
};

/// Renumbers the triangles of `points` input points in the order that the options name and writes them. `host`: where
/// the result goes in the end, null for a result on the device; its arrays are made here if the device can write them.
[[nodiscard]] ResultArrays write_result(Context& ctx, Mesh mesh, std::size_t points, Triangulation::Data* host);

}  // namespace cadt
