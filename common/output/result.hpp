// SPDX-License-Identifier: Apache-2.0
// From the mesh to the arrays of the result.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// Three words a triangle each: vertices counterclockwise, as input ids, and neighbours.
struct ResultArrays {
  Allocation triangles, neighbors;
  std::size_t count = 0;
  bool on_host = false;  ///< they are those of `host`, filled when the device has finished
};

/// Numbers the triangles of `points` input points in the order that the options ask for and writes them. `host`: where
/// they are to be in the end, null for a result on the device; its arrays are made if the device can write them.
[[nodiscard]] ResultArrays write_result(Context& ctx, Mesh mesh, std::size_t points, Triangulation::Data* host);

}  // namespace cadt
