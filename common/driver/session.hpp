// SPDX-License-Identifier: Apache-2.0
// What every call of a triangulator does before and after its work: limits, memory budget, statistics.
#pragma once

#include <cstddef>

#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/driver/memory_plan.hpp"

namespace cadt {

/// Checks the number of points of a call. \throws LimitError
void require_size(std::size_t points);

/// Begins the memory budget of a call of n points.
void begin_budget(Triangulator::State& state, std::size_t n);
/// The same; also checks the options and fills in the statistics that are known before any work. \throws OptionError
void begin_call(Triangulator::State& state, std::size_t n, Statistics& statistics);
/// The memory plan of the call. \throws OutOfMemory before any work
[[nodiscard]] MemoryPlan plan_call(Triangulator::State& state, const CallShape& call);
/// Remembers that a call with this plan and so many points had its memory.
void remember_size(Triangulator::State& state, const Statistics& statistics, const MemoryPlan& plan);
/// Completes the statistics. Waits for the device, unless nothing was measured and the result is used in the order of
/// the caller's queue (`ordered`).
void end_call(Triangulator::State& state, Context& ctx, bool ordered);

[[nodiscard]] inline bool is_host(const Device& device) { return device.info().backend == Backend::host; }

}  // namespace cadt
