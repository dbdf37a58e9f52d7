// SPDX-License-Identifier: Apache-2.0
// What a run did, for people and programs. docs/cli.md documents the keys.
#pragma once

#include "tiles/run.hpp"

#include <span>
#include <string>

namespace cadt::tiles {

/// As JSON: the whole mesh, times of the phases, and each node with its times. `inputs`: names of files or sets.
[[nodiscard]] std::string report_json(const RunResult& result, const RunOptions& options,
                                      std::span<const std::string> inputs);

/// The boxes of the leaves as SVG, the darker the longer a leaf took a point; `seconds` by node, empty if unknown.
[[nodiscard]] std::string tree_svg(const TileTree& tree, std::span<const double> seconds);

}  // namespace cadt::tiles
