// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/driver/context.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The certified mesh on the device: locked triangles, or two arrays without locks and flip counters (certify.dev.h).
struct Mesh {
  Allocation locked;                ///< two for each distinct point; some of the first points' are unused
  std::size_t slots = 0;            ///< locked triangles allocated, or triangles of the arrays
  bool flat = false;                ///< all points on one line, or fewer than three: no triangles
  Allocation vertices, half_edges;  ///< the arrays, three words a triangle
  std::size_t triangles = 0;        ///< so many of these, the first ones, are not of the ghost

  [[nodiscard]] bool in_arrays() const noexcept { return static_cast<bool>(vertices) || static_cast<bool>(half_edges); }
};

/// Inserts all points level by level, legalises, and certifies by legality sweeps. Releases nothing of `order`, but on
/// GPUs brings points and input ids into the order of insertion.
[[nodiscard]] Mesh insert_incrementally(Context& ctx, SortedPoints& order);

/// Legality sweeps over a mesh made otherwise, of two locked triangles a point; `edges`: how many it has, those to the
/// ghost included.
[[nodiscard]] Mesh sweep_legality(Context& ctx, SortedPoints& order, Allocation locked, std::uint64_t edges);

/// Triangles that one launch of a legality sweep, or of cadt_certify, examines.
[[nodiscard]] std::size_t slots_per_launch(const Device& device);

}  // namespace cadt
