// SPDX-License-Identifier: Apache-2.0
// LAS, LAZ, GIS files and GeoTIFF belong to cadt-terrain, a program of the Python package, which has readers and
// writers for them. It takes the same words as cadt and has the same exit codes, so that there is one program for the
// user.
#pragma once

#include <CLI/CLI.hpp>

namespace cadt::cli {

/// Lists contour and tin in the help.
void add_terrain_commands(CLI::App& app);

/// Whether the command line is one for cadt-terrain: contour, tin, or a raster from or to one of its files.
[[nodiscard]] bool is_for_terrain(int count, char** words);

/// Becomes cadt-terrain with the same words. Throws Failure (device) if it is not installed.
[[noreturn]] void become_terrain(int count, char** words);

}  // namespace cadt::cli
