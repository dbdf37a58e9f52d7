// SPDX-License-Identifier: Apache-2.0
// What every call of a triangulator does before and after its work: limits, memory, statistics.
#pragma once

#include <cstddef>

#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/driver/memory_plan.hpp"

namespace cadt {

/// \throws LimitError
void require_size(std::size_t points);

/// A new budget of memory, for n points.
void begin_budget(Triangulator::State& state, std::size_t n);
/// The same, and what the statistics say before any work. \throws OptionError
void begin_call(Triangulator::State& state, std::size_t n, Statistics& statistics);
/// The plan of the call. \throws OutOfMemory before any work
[[nodiscard]] MemoryPlan plan_call(Triangulator::State& state, const CallShape& call);
/// Calls of this plan with so many points have had their memory.
void remember_size(Triangulator::State& state, const Statistics& statistics, const MemoryPlan& plan);
/// What the statistics say in the end. Waits for the device, unless nobody asks for that: nothing was measured, and the
/// result is used in the order of the caller's queue (`ordered`).
void end_call(Triangulator::State& state, Context& ctx, bool ordered);

[[nodiscard]] inline bool is_host(const Device& device) { return device.info().backend == Backend::host; }

}  // namespace cadt
