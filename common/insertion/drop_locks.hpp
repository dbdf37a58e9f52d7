// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// Locked triangles that nobody changes any more.
struct LockedTriangles {
  Allocation triangles;
  Allocation edge_flags;  ///< a word each; null if no edge is constrained
  std::size_t slots = 0;
};

/// The arrays of locked triangles, marked as certified; without points. Of a whole mesh they are those of the result.
/// `first_unused`: the two slots from there on are the only ones not in use. \pre the last legality sweep found nothing
/// to repair \throws OutOfMemory
[[nodiscard]] Mesh drop_locks(Context& ctx, LockedTriangles locked, std::uint32_t first_unused, Allocation input_ids,
                              MeshUse use);

/// The same for the sets of a batch, whose triangles have slots of their own from `first_slots` on; the last one of
/// these is where all slots end. `set_starts` gets the first triangle of each set and the number of all.
[[nodiscard]] Mesh drop_locks_of_sets(Context& ctx, LockedTriangles locked, std::span<const std::uint32_t> first_slots,
                                      const Allocation& input_ids, Allocation& set_starts);

}  // namespace cadt
