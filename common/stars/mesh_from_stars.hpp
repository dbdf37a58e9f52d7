// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/insertion/insertion.hpp"

namespace cadt {

/// So few points are wrapped instead (common/stars/wrap_exact.dev.h), unless the options ask for the star stage, if
/// many are on circles, or on a lattice: there the exact tests of wrapping take longer. Or on a ring, where circles are
/// large and each turn looks at many points. Of other sets all that can be wrapped are.
constexpr std::size_t most_wrapped_on_circles = 20000, most_wrapped_on_lattice = 20480, most_wrapped_on_ring = 28672;

/// The mesh by the star stage (common/stars/local_star.dev.h): stars of vertices without locks, insertion of the
/// vertices whose star could not be proven, the join of both, closing passes. Releases the keys of `order`.
[[nodiscard]] Mesh build_mesh(Context& ctx, SortedPoints& order);

}  // namespace cadt
