// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>

#include "common/insertion/insertion.hpp"

namespace cadt {

/// Lanes of the team that wraps a vertex.
constexpr std::uint32_t wrap_lanes = 32;

/// Where wrapped stars are stored (common/stars/wrapped_star.dev.h). \pre `sizes` are 0; `counts` has CADT_WRAP_WORDS
/// words
struct WrappedStars {
  std::uint32_t row;
  const Allocation& star_vertices;
  std::size_t star_words;
  const Allocation &begins, &sizes, &counts;
  [[nodiscard]] auto arguments() const { return std::tie(row, star_vertices, star_words, begins, sizes, counts); }
};

/// The sets of a batch (common/batch/batch.dev.h), or none.
struct WrappedSets {
  const Allocation& starts;
  std::size_t count;
  const Allocation& states;
  [[nodiscard]] auto arguments() const { return std::tie(starts, count, states); }
};

/// Wraps the stars of the vertices in `list`; does not wait for the device. \pre `counts` are 0
void wrap_batch(Context& ctx, const Allocation& points, std::size_t n, const Allocation& list, std::size_t list_size,
                const WrappedSets& sets, const WrappedStars& stars);

/// The mesh of n points, at most CADT_WRAP_MOST, by gift wrapping (common/stars/wrap_exact.dev.h), without locks,
/// points and input ids; certified unless it is a part, of a mesh of `all` points, or has high-degree vertices, with
/// too many neighbours to be wrapped. Nothing if the points are collinear, the work limit is exceeded, or the hull has
/// 2^15 edges or more: then insertion takes over.
[[nodiscard]] std::optional<Mesh> wrap_mesh(Context& ctx, const Allocation& points, std::size_t n, std::size_t all,
                                            MeshUse use);

}  // namespace cadt
