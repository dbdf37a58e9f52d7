// SPDX-License-Identifier: Apache-2.0
// What a run is made of, in one process and in each rank of several.
#pragma once

#include "tiles/run.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace cadt::tiles {

/// As Options::threads.
[[nodiscard]] unsigned threads_of(const RunOptions& options);

/// Whether nodes are needed on the host.
[[nodiscard]] bool takes_arrays(const RunOptions& options);

/// The options of one of the devices.
[[nodiscard]] Options device_options(Options chosen, const RunOptions& options, cadt::stop_token stop);

/// One pass for the plan over points begin, ..., end - 1. Adds the hash of their blocks to `content` unless that is
/// null. `progress`: points so far. \throws as PointSource::read, Cancelled
[[nodiscard]] TreePass plan_pass(const PointSource& source, std::uint64_t begin, std::uint64_t end,
                                 const RunOptions& options, const TreeBuilder& builder, Hash128* content,
                                 const std::function<void(std::uint64_t)>& progress);

inline constexpr std::uint64_t written_bytes = 24 + 48;  ///< of a point

/// Bytes that leaves take on the host while they and their neighbours in time are read, computed and written.
[[nodiscard]] std::uint64_t leaf_memory(const PointSource& source, const RunOptions& options, unsigned writers);

/// Bytes that the points of all leaves may take, of `available` ones of which the leaves at work take `leaves`.
[[nodiscard]] std::uint64_t shuffle_memory(const RunOptions& options, std::uint64_t available, std::uint64_t leaves);

/// \throws LimitError for more than a triangulation takes
void require_tile_points(const RunOptions& options);

/// Bytes that the run will write to its output.
[[nodiscard]] std::uint64_t output_bytes(const PointSource& source, const RunOptions& options);

/// Of a node that was there.
[[nodiscard]] NodeReport report_of(const NodeRecord& record);

}  // namespace cadt::tiles
