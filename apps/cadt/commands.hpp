// SPDX-License-Identifier: Apache-2.0
// The subcommands. Each one declares its options and, when the command line names it, sets what is to be done.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace cadt::cli {

/// The work of the chosen subcommand; returns the exit code. Errors are thrown.
using Action = std::function<int()>;

void add_triangulate(CLI::App& app, Action& chosen);
void add_polygons(CLI::App& app, Action& chosen);
void add_labels(CLI::App& app, Action& chosen);
void add_verify(CLI::App& app, Action& chosen);
void add_locate(CLI::App& app, Action& chosen);
void add_interpolate(CLI::App& app, Action& chosen);
void add_raster(CLI::App& app, Action& chosen);
void add_voronoi(CLI::App& app, Action& chosen);
void add_generate(CLI::App& app, Action& chosen);
void add_devices(CLI::App& app, Action& chosen);
void add_triangle(CLI::App& app, Action& chosen);
void add_tiles(CLI::App& app, Action& chosen);
void add_merge(CLI::App& app, Action& chosen);
void add_info(CLI::App& app, Action& chosen);
void add_render(CLI::App& app, Action& chosen);
void add_view(CLI::App& app, Action& chosen);

}  // namespace cadt::cli
