// SPDX-License-Identifier: Apache-2.0
// Least number of bytes that a kernel has to move: a model for the bandwidth that it achieves.
#pragma once

#include <cadt/statistics.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace cadt::bench {

/// Units of the table.
enum class Unit {
  point,       ///< of the input
  distinct,    ///< distinct points
  inserted,    ///< points inserted
  proven,      ///< vertices with a proven local star
  unproven,    ///< residual vertices of a run with local stars
  starred,     ///< all vertices of such a run
  slot,        ///< triangle slots of the locked mesh: two a distinct point
  swept_slot,  ///< triangle slots, for each legality sweep
  triangle,    ///< of the result
  pass,        ///< points for each pass of a sort of keys by eight bits
  later_pass   ///< the same without the first one
};

/// One line of the table; a kernel has one for each unit.
struct KernelBytes {
  std::string_view kernel;
  Unit unit;
  unsigned read, written;  ///< bytes a unit
  std::string_view what;
};

/// Each datum is read once and written once, as if the caches held it from then on; what depends on the input (walks,
/// flips, retries) is left out. So these are the bytes that no implementation of the kernel with the same layout can
/// avoid, and a bandwidth computed from them is never too high, except where the caches still hold data of the kernel
/// before.
[[nodiscard]] std::span<const KernelBytes> kernel_bytes() noexcept;

/// Bytes of all launches of a kernel in a run (of Strategy::locks or stars, with counters, points in a bounding box
/// about as wide as high); nothing if the table has no line for it.
[[nodiscard]] std::optional<std::uint64_t> least_bytes(std::string_view kernel, const Statistics& run,
                                                       std::uint64_t triangles);

}  // namespace cadt::bench
