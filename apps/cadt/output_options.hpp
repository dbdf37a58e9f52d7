// SPDX-License-Identifier: Apache-2.0
// Meshes and pictures as outputs: the options and the work that cadt triangulate, polygons and labels share.
#pragma once

#include "outputs.hpp"
#include "progress.hpp"

#include <cadt/io/mesh_file.hpp>

#include <CLI/CLI.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cadt::cli {

struct OutputOptions {
  std::vector<std::string> outputs, formats;
  std::optional<int> base;   ///< if not given, that of the .node file beside an output, else 0
  std::optional<int> width;  ///< 1600 if not given, or less where the height would be above 4000
  bool ascii = false;
};

/// Adds -o, -t, --base, --ascii, --width. `formats`: what -t takes; `indexed`: suffixes of files with a first index.
void add_output_options(CLI::App& command, OutputOptions& options, const std::string& formats,
                        const std::string& indexed);

/// Writes all outputs by `write`; an interruption between two of them names those that are complete.
void write_outputs(const std::vector<Output>& outputs, const OutputOptions& options, ProgressLine& line,
                   const std::function<void(const std::string& path, const io::WriteOptions&)>& write);

/// To standard output if it has nothing else to take, else to standard error unless `quiet`.
void print_summary(const std::string& summary, bool alone, bool quiet);

}  // namespace cadt::cli
