// SPDX-License-Identifier: Apache-2.0
// The device memory of a call: what the public figure says, what is refused before any work, and which way the stages
// go about it.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <vector>

#include "common/driver/memory.hpp"

namespace cadt {

/// What decides how much device memory a call takes.
struct CallShape {
  std::size_t points;
  bool result_elsewhere;     ///< it is written straight to memory of the host's
  bool input_stays;          ///< the points can be read once more where they are
  std::size_t scalar_bytes;  ///< of a coordinate
};

/// How the stages use memory, and how much.
struct MemoryPlan {
  bool stars = false;      ///< sized for the star stage, unless more vertices than usual are residual
  bool compact = false;    ///< steps that take less memory and more time, where there are two ways
  bool regathers = false;  ///< the star stage reads its points again for certification, rather than to keep them
  std::size_t bytes = 0;   ///< of the phase that needs most, but for over-full cells
  std::size_t largest_buffer = 0;
};

/// The plan of a call, fast or compact. Without stars there is one: writing the result (124 bytes a point), or sorting
/// the triangles (97) where the result goes straight to memory of the host's.
[[nodiscard]] MemoryPlan plan_memory(const CallShape& call, bool stars, bool compact) noexcept;

/// Input of floats is half as large, and who has it counts bytes: 80 a point with it and the result, 100 with doubles.
[[nodiscard]] constexpr bool is_compact(const CallShape& call) noexcept { return call.scalar_bytes == sizeof(float); }

/// Sizes that calls have had before, so that they need not be asked for again.
struct KnownSizes {
  std::size_t insertion = 0, fast_stars = 0, compact_stars = 0, batch = 0, reserved = 0;  ///< points
};

/// The plan for what there is: fast, unless the call is compact anyway or there is too little memory for that.
/// \throws OutOfMemory before any work
[[nodiscard]] MemoryPlan choose_memory_plan(Memory& memory, const Options& options, const DeviceInfo& device,
                                            const CallShape& call, bool stars, const KnownSizes& known);

/// Points that are batched at most, so that there is memory for them besides `results` bytes. \throws OutOfMemory
/// before any work
[[nodiscard]] std::size_t plan_batch(Memory& memory, const Options& options, const DeviceInfo& device,
                                     std::span<const std::size_t> offsets, std::size_t most_of_set, std::size_t results,
                                     const KnownSizes& known);
/// Points and sets that are batched at most: they fill any card, and what they need besides the result is bounded.
constexpr std::size_t most_points_batched = std::size_t{1} << 24, most_sets_batched = std::size_t{1} << 20;

/// Whether one buffer of the device can have so many bytes.
[[nodiscard]] bool fits_buffers(const Options& options, const DeviceInfo& device, std::size_t bytes) noexcept;

/// Device bytes of a call of n points with buffers that wait for a later phase or call: the public figure.
[[nodiscard]] std::size_t most_bytes(const Memory& memory, std::size_t n, bool stars);
/// The buffers of a call that are alive together: takes them and gives them back, so they are kept.
void reserve_buffers(Memory& memory, std::size_t n, bool stars);

}  // namespace cadt
