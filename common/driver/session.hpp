// SPDX-License-Identifier: Apache-2.0
// What every call of a triangulator does before and after its work: limits, memory, statistics.
#pragma once

#include <cstddef>

#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"

namespace cadt {

/// \throws LimitError
void require_size(std::size_t points);

/// Device bytes of the phase that needs most, but for crowded cells: writing the result (124 a point), or sorting the
/// triangles (96) where the result goes straight to memory of the host's. docs/performance.md has the plan.
[[nodiscard]] std::size_t least_bytes(std::size_t n, bool result_elsewhere);
/// The same with the star stage, unless more points than usual are left to the insertion. `input_stays`: the points can
/// be read once more where they are, so they need not be kept in order all the time. `saves_memory`: as in Run.
[[nodiscard]] std::size_t star_bytes(std::size_t n, bool input_stays, bool saves_memory);
/// The same, with buffers that wait for a later phase or call.
[[nodiscard]] std::size_t most_bytes(const Memory& memory, std::size_t n, bool stars);

/// Whether the star stage is to run, if it suits the points. It needs many cheap lanes: CPUs are faster without it, and
/// Strategy::automatic knows that.
[[nodiscard]] bool prefers_stars(const Options& options, const Device& device);

/// A new account of memory, for n points.
void begin_budget(Triangulator::State& state, std::size_t n);
/// The same, and what the statistics say before any work. \throws OptionError
void begin_call(Triangulator::State& state, std::size_t n, Statistics& statistics);
/// Bytes of the records of n points: without the star stage no other buffer is larger.
[[nodiscard]] std::size_t record_bytes(std::size_t n);
/// Whether one buffer of the device can have so many bytes.
[[nodiscard]] bool fits_buffers(const Triangulator::State& state, std::size_t bytes);
/// \throws OutOfMemory where one buffer of the device cannot have so many bytes
void require_buffer(const Triangulator::State& state, std::size_t bytes);
/// What decides how much memory a call takes.
struct CallShape {
  bool result_elsewhere;     ///< it is written straight to memory of the host's
  bool input_stays;          ///< see star_bytes
  std::size_t scalar_bytes;  ///< of a coordinate

  /// Input of floats is half as large, and who has it counts bytes: 80 a point with it and the result, 100 with
  /// doubles.
  [[nodiscard]] bool saves_memory() const noexcept { return scalar_bytes == sizeof(float); }
};
/// Whether the call is to save memory: if it is always to, or there is too little for the quicker way. \throws
/// OutOfMemory before any work
[[nodiscard]] bool require_memory(Triangulator::State& state, std::size_t n, const CallShape& call);
/// What the statistics say in the end. Waits for the device, unless nobody asks for that: nothing was measured, and the
/// result is used in the order of the caller's queue (`ordered`).
void end_call(Triangulator::State& state, Context& ctx, bool ordered);
/// Calls with so many points have had their memory.
void remember_size(Triangulator::State& state, const Statistics& statistics, bool saved_memory);

/// The buffers of a call that are alive together: takes them and gives them back, so they are kept.
void reserve_buffers(Memory& memory, std::size_t n, bool stars);

[[nodiscard]] inline bool is_host(const Device& device) { return device.info().backend == Backend::host; }

}  // namespace cadt
