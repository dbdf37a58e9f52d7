// SPDX-License-Identifier: Apache-2.0
// What `cadt tiles` and `cadt-mpi tiles` have in common: options, input, summary, reports.
#pragma once

#include "device_options.hpp"
#include "input.hpp"
#include "tiles/run.hpp"
#include "tiles/source.hpp"

#include <cadt/io/generate.hpp>

#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {

struct TilesCommand {
  std::vector<std::string> inputs;
  InputOptions read;
  std::string output, scratch, tile_points, host_memory, devices, picture, stats;
  std::string generate, n = "1M";
  io::GenerateOptions set;
  DeviceOptions device;
  bool resume = false, quiet = false;
};

/// `options` must live as long as `command`.
void add_tiles_options(CLI::App& command, TilesCommand& options);

/// Throws Failure (usage) for options that exclude each other, io::FileError for a report that cannot be written.
void check_tiles_options(const TilesCommand& options);
[[nodiscard]] std::unique_ptr<tiles::PointSource> open_source(const TilesCommand& options);
/// Those of --devices; empty without it.
[[nodiscard]] std::vector<std::string> named_devices(const TilesCommand& options);
/// The options of the back end, without a device of --devices.
[[nodiscard]] Options device_options(const TilesCommand& options);
/// Without devices and progress.
[[nodiscard]] tiles::RunOptions run_options(const TilesCommand& options);

/// Counts, times, devices, hash: one "key value" a line.
[[nodiscard]] std::string tiles_summary(const tiles::RunResult& result);
/// run.json in the directory, --stats and --picture. Throws io::FileError.
void write_tiles_reports(const TilesCommand& options, const tiles::PointSource& source, const tiles::RunOptions& run,
                         const tiles::RunResult& result);
/// For runs that were interrupted.
void say_how_to_resume(const TilesCommand& options);
/// The summary, with a warning if there are no triangles, goes to standard output if nothing else is the result, else
/// to standard error.
void print_tiles_summary(const TilesCommand& options, const tiles::RunResult& result);

}  // namespace cadt::cli
