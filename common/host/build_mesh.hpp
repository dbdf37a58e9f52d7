// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/host/run.hpp"
#include "common/host/spatial_order.hpp"

namespace cadt {

/// The mesh on the device, certified: in records, or in two arrays without locks and flips (array_mesh.h).
struct DeviceMesh {
  Allocation records;          ///< two a distinct point; some of the first points' stay unused
  std::size_t slots = 0;       ///< records allocated, or triangles of the arrays
  bool flat = false;           ///< all points on one line or fewer than three: no records
  Allocation vertices, links;  ///< the arrays, three words a triangle
  std::size_t triangles = 0;   ///< of these the first so many are not of the ghost

  [[nodiscard]] bool in_arrays() const noexcept { return static_cast<bool>(vertices) || static_cast<bool>(links); }
};

/// Inserts all points level by level, legalises, and certifies by closing passes. Releases nothing of `order`, but on
/// GPUs brings points and labels into another order.
[[nodiscard]] DeviceMesh build_mesh(Run& run, SpatialOrder& order);

/// Closing passes over a mesh of two records a point that was made otherwise; it has so many edges, those to the ghost
/// included.
[[nodiscard]] DeviceMesh certify_mesh(Run& run, SpatialOrder& order, Allocation records, std::uint64_t edges);

/// Triangles or records that a closing pass looks at in one launch.
[[nodiscard]] std::size_t slots_per_launch(const Device& device);

}  // namespace cadt
