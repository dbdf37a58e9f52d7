// SPDX-License-Identifier: Apache-2.0
// Certification of a mesh in arrays (common/certify/certify.dev.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// Words for what certification finds, and for counters of work if the statistics want them.
[[nodiscard]] std::size_t certify_words(const Context& ctx);

/// Launches the certification of edges of `mesh`, those of its triangles from `begin` on; waits for nothing. Counts in
/// `words` from `row` on, a multiple of CADT_COUNTER_STRIDE; they must be 0 before the first launch. If the
/// view has CADT_NONE triangles, the kernel reads their number from the words.
void launch_certify(Context& ctx, const DeviceMeshView& mesh, std::size_t begin, std::size_t size,
                    const Allocation& words, std::size_t row);

/// Checks the words for a mesh of n points. \throws InternalError if an edge is not as it should be
void read_certificate(Context& ctx, std::span<const std::uint32_t> words, std::size_t n);

/// Certifies the mesh of n points, which it has. \throws InternalError if an edge is not as it should be: nothing is
/// repaired
void certify(Context& ctx, const Mesh& mesh, std::size_t n);

}  // namespace cadt
