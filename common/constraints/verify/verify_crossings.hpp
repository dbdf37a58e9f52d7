// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/constraints/verify/verify_checks.hpp"

namespace cadt {

/// Adds to `check` what is wrong with vertices that crossings have made (Crossing::exact): each is the crossing of its
/// parents, rounded to nearest, and lies on the chains of both, in its exact place. The first failure is the number of
/// the vertex. \pre the mesh has passed check_segments, and has not moved
void check_crossings(const MeshPlaces& places, std::span<const Segment> segments, const ConstrainedTriangulation& mesh,
                     Check& check);

}  // namespace cadt
