// SPDX-License-Identifier: Apache-2.0
// How many bytes a kernel has to move at least: a model, for the bandwidth that it achieves.
#pragma once

#include <cadt/statistics.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace cadt::bench {

/// What the table counts bytes by.
enum class Unit {
  point,         ///< of the input
  distinct,      ///< points, without those that equal another one
  inserted,      ///< points that got their place by insertion
  proven,        ///< vertices of the star stage that got their star without locks
  unproven,      ///< the other vertices of a run in which the star stage was used
  starred,       ///< all vertices of such a run
  record,        ///< of the mesh: two a distinct point
  swept_record,  ///< the same for each sweep of the closing pass
  triangle,      ///< of the result
  pass,          ///< points for each pass of a sort of keys by eight bits
  later_pass     ///< the same without the first one
};

/// One line of the table; a kernel has one for each unit.
struct KernelBytes {
  std::string_view kernel;
  Unit unit;
  unsigned read, written;  ///< bytes a unit
  std::string_view what;
};

/// Each datum that a kernel must have is read once and written once, as if the caches held it from then on; what
/// depends on the input (walks, flips, retries) is left out. So the bytes are those that no implementation of the same
/// kernel with the same layout can avoid, and a bandwidth made of them is never too high, but for data that the caches
/// still hold from the kernel before.
[[nodiscard]] std::span<const KernelBytes> kernel_bytes() noexcept;

/// Bytes of all launches of a kernel in a run (of Strategy::locks or stars, with counters, points in a box about as
/// wide as high), nothing if the table has no line for it.
[[nodiscard]] std::optional<std::uint64_t> least_bytes(std::string_view kernel, const Statistics& run,
                                                       std::uint64_t triangles);

}  // namespace cadt::bench
