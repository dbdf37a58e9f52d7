// SPDX-License-Identifier: Apache-2.0
// The closing pass of a mesh in arrays (common/device/array_mesh.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/host/build_mesh.hpp"
#include "common/host/run.hpp"
#include "common/host/spatial_order.hpp"

namespace cadt {

/// Words that the pass counts in: what it found, and counters of work if the statistics want them.
[[nodiscard]] std::size_t certify_words(const Run& run);

/// Edges of the arrays of `mesh`, those of its triangles from `begin` on; waits for nothing. Counts in `words` from
/// `row` on, a multiple of CADT_COUNTER_STRIDE; they are 0 before the first part. With `real_in_words` the number of
/// real triangles is one of the words, 0 if there is no mesh; else it is the mesh's.
void launch_certify(Run& run, const Allocation& points, const DeviceMesh& mesh, std::size_t begin, std::size_t size,
                    bool real_in_words, const Allocation& words, std::size_t row);

/// What the words say of a mesh of n points. \throws InternalError if an edge is not as it should be
void read_certificate(Run& run, std::span<const std::uint32_t> words, std::size_t n);

/// One pass over a mesh in arrays. \throws InternalError if an edge is not as it should be: nothing is repaired
void certify_arrays(Run& run, const SpatialOrder& order, const DeviceMesh& mesh);

}  // namespace cadt
