// SPDX-License-Identifier: Apache-2.0
// What must hold for any points at all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cadt::fuzz {

/// Points, interleaved, any bits. The mesh by insertion must pass the verifier, and stars, gift wrapping and, if asked
/// for, several threads in each other's way must give the same. Where a coordinate is no finite number, each must name
/// the first. Aborts otherwise.
void check_mesh(std::span<const double> xy, bool with_threads);

/// The same points in another order must give the same triangles. `order` are the positions of the points in it.
void check_order(std::span<const double> xy, std::span<const std::uint32_t> order);

}  // namespace cadt::fuzz
