// SPDX-License-Identifier: Apache-2.0
// The device memory of a call: the public figure, the refusal before any work, and the plan that the stages follow.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

#include "common/driver/memory.hpp"

namespace cadt {

/// What decides how much device memory a call takes.
struct CallShape {
  std::size_t points;
  bool result_elsewhere;     ///< the result is written straight to host memory
  bool input_stays;          ///< the points stay readable where they are
  std::size_t scalar_bytes;  ///< of a coordinate
};

/// How the stages use memory, and how much.
struct MemoryPlan {
  bool stars = false;      ///< sized for the star stage, with no more residual vertices than usual
  bool compact = false;    ///< where there is a choice, the step that takes less memory and more time
  bool regathers = false;  ///< the star stage frees its points and reads them again for certification
  std::size_t bytes = 0;   ///< of the phase that needs most; over-full cells may need more
  std::size_t largest_buffer = 0;
};

/// The plan of a call, fast or compact. Without stars there is one plan: its peak is dropping the locks, 124 bytes a
/// point, or insertion, 97, where the arrays lie in host memory.
[[nodiscard]] MemoryPlan plan_memory(const CallShape& call, bool stars, bool compact) noexcept;

/// Whether the compact plan is the default: for input of floats, where memory counts. With input and result a call
/// takes 80 bytes a point, and 100 with doubles.
[[nodiscard]] constexpr bool is_compact(const CallShape& call) noexcept { return call.scalar_bytes == sizeof(float); }

/// The largest calls that had their memory, by kind: up to these sizes the device need not be asked again.
struct KnownSizes {
  std::size_t insertion = 0, fast_stars = 0, compact_stars = 0, batch = 0, reserved = 0;  ///< points
};

/// The plan for the memory there is: fast, unless the call is compact by default or the fast plan does not fit.
/// \throws OutOfMemory before any work
[[nodiscard]] MemoryPlan choose_memory_plan(Memory& memory, const Options& options, const DeviceInfo& device,
                                            const CallShape& call, bool stars, const KnownSizes& known);

/// Most points of a batch that fit in memory beside `results` bytes. \throws OutOfMemory before any work
[[nodiscard]] std::size_t plan_batch(Memory& memory, const Options& options, const DeviceInfo& device,
                                     std::span<const std::size_t> offsets, std::size_t most_of_set, std::size_t results,
                                     const KnownSizes& known);
/// Most points and sets of a batch: enough to fill any GPU, and a bound on the memory besides the result.
constexpr std::size_t most_points_batched = std::size_t{1} << 24, most_sets_batched = std::size_t{1} << 20;

/// Device bytes of a call of n points, with the buffers cached for a later phase or call: the public figure.
[[nodiscard]] std::size_t most_bytes(const Memory& memory, std::size_t n, bool stars);
/// Allocates the buffers of a call that are alive at the same time and releases them, so that they are cached.
void reserve_buffers(Memory& memory, std::size_t n, bool stars);

}  // namespace cadt
