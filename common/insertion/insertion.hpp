// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/driver/context.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The mesh on the device, certified: in records, or in two arrays without locks and flips (certify.dev.h).
struct Mesh {
  Allocation locked;                ///< two a distinct point; some of the first points' stay unused
  std::size_t slots = 0;            ///< records allocated, or triangles of the arrays
  bool flat = false;                ///< all points on one line or fewer than three: no records
  Allocation vertices, half_edges;  ///< the arrays, three words a triangle
  std::size_t triangles = 0;        ///< of these the first so many are not of the ghost

  [[nodiscard]] bool in_arrays() const noexcept { return static_cast<bool>(vertices) || static_cast<bool>(half_edges); }
};

/// Inserts all points level by level, legalises, and certifies by closing passes. Releases nothing of `order`, but on
/// GPUs brings points and labels into another order.
[[nodiscard]] Mesh insert_incrementally(Context& ctx, SortedPoints& order);

/// Closing passes over a mesh of two records a point that was made otherwise; it has so many edges, those to the ghost
/// included.
[[nodiscard]] Mesh sweep_legality(Context& ctx, SortedPoints& order, Allocation locked, std::uint64_t edges);

/// Triangles or records that a closing pass looks at in one launch.
[[nodiscard]] std::size_t slots_per_launch(const Device& device);

}  // namespace cadt
