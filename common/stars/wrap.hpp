// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/insertion/insertion.hpp"

namespace cadt {

/// Lanes of the team that wraps a vertex.
constexpr std::uint32_t wrap_lanes = 32;

/// Where wrapped stars are put (common/stars/wrapped_star.dev.h). `sizes` are 0; `found` has CADT_WRAP_WORDS words.
struct WrappedStars {
  const Allocation &star_vertices, &begins, &sizes, &found;
  std::size_t row, link_words;
};

/// Of sets, those in `list`; the rest of the arrays as in common/batch/batch.dev.h.
struct StarsOfBatch {
  const Allocation& list;
  std::size_t list_size;
  const Allocation &starts, &states;
  std::size_t count;
};

/// Wraps the stars of these vertices; waits for nothing. `found` is 0.
void wrap_batch(Context& ctx, const Allocation& points, std::size_t n, const StarsOfBatch& sets,
                const WrappedStars& stars);

/// The mesh of at most most_wrapped() points by gift wrapping (common/stars/wrap_exact.dev.h), without locks, and
/// certified: in arrays, or in records if some vertices have too many neighbours to be wrapped. Nothing if the points
/// are on a line or it would take too long: then insertion is to do it.
[[nodiscard]] std::optional<Mesh> wrap_mesh(Context& ctx, const SortedPoints& order);

/// The same of n points that are part of a mesh of `all`: in records, and its edges have still to be certified.
[[nodiscard]] std::optional<Mesh> wrap_part(Context& ctx, const Allocation& points, std::size_t n, std::size_t all);

}  // namespace cadt
