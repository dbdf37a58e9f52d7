// SPDX-License-Identifier: Apache-2.0
// The mesh on the device, from the stage that made it to the result.
#pragma once

#include <cstddef>
#include <utility>

#include "common/driver/memory.hpp"

namespace cadt {

/// A certified mesh, ghost triangles included: locked triangles as insertion leaves them, or two arrays, three words a
/// triangle, with the ghost triangles at the end (common/certify/certify.dev.h).
struct Mesh {
  Allocation input_ids;             ///< of the vertices, which are positions in sorted order
  Allocation locked;                ///< locked triangles, two a vertex; some of the first vertices' stay unused
  std::size_t slots = 0;            ///< locked triangles allocated, or triangles of the arrays
  Allocation vertices, half_edges;  ///< the arrays
  std::size_t triangles = 0;        ///< of the arrays the first so many have no ghost vertex
  bool flat = false;                ///< no triangles: all vertices are collinear, or there are fewer than three

  [[nodiscard]] static Mesh without_triangles(Allocation input_ids) {
    Mesh mesh;
    mesh.input_ids = std::move(input_ids);
    mesh.flat = true;
    return mesh;
  }
  [[nodiscard]] bool in_arrays() const noexcept { return static_cast<bool>(vertices) || static_cast<bool>(half_edges); }
};

}  // namespace cadt
