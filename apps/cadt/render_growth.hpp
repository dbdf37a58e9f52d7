// SPDX-License-Identifier: Apache-2.0
// cadt render of a mesh while it grows: snapshots side by side, a film, or its pictures.
#pragma once

#include "progress.hpp"

#include <cadt/io/points_file.hpp>
#include <cadt/options.hpp>

#include "viewer/draw/style.hpp"
#include "viewer/still/still.hpp"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace cadt::cli {

struct GrowthOptions {
  int panels = 0;  ///< --growth
  double fps = 30, seconds = 8;
  bool timed = false;  ///< --fps or --seconds is given
};

struct GrowthView {
  int width = 1600, height = 0;  ///< of the whole picture; height 0: as the points are
  int most_height = 4000;        ///< where the points say it
  viewer::Style style;
  std::optional<viewer::View> seen;  ///< of the plane; not set: all
  bool quiet = false;
};

/// Adds --growth, --fps and --seconds.
void add_growth_options(CLI::App& command, GrowthOptions& options);

/// Whether these options and this output (a film, or a folder for its pictures) ask for growth.
[[nodiscard]] bool shows_growth(const GrowthOptions& options, const std::string& output);

/// What can be known to be wrong before the work. The output may be none of the inputs. Throws Failure (usage) or
/// io::FileError.
void check_growth(const GrowthOptions& options, const std::string& output, const std::vector<std::string>& inputs);

/// Triangulates by insertion with locks, and draws. Needs an OpenGL context. Returns the exit code.
int render_growth(const io::PointSet& points, const Options& options, const std::string& output,
                  const GrowthOptions& growth, const GrowthView& view, ProgressLine& line);

}  // namespace cadt::cli
