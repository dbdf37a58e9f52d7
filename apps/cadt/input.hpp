// SPDX-License-Identifier: Apache-2.0
// The options that say how points are read, shared by all subcommands that read points.
#pragma once

#include <cadt/io/points_file.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace cadt::cli {

struct InputOptions {
  std::string path;
  std::string format;
  std::string columns;
  std::string projection = "xy";
  bool floats = false;
  bool segments = false;  ///< the command takes formats of segments, too
};

/// Adds the positional `name` and -f, --columns, --project. `segments`: -f may name a format of segments.
void add_input_options(CLI::App& command, InputOptions& options, const std::string& name, const std::string& text,
                       bool segments = false);

/// Adds -f, --columns, --project.
void add_read_options(CLI::App& command, InputOptions& options, bool segments = false);

/// Adds --floats.
void add_floats_option(CLI::App& command, InputOptions& options);

/// With --floats: rounds the coordinates, and says how many points that has moved unless `quiet`.
void round_to_floats(io::PointSet& points, const InputOptions& options, bool quiet);

/// Throws Failure (usage) for a suffix that is none of `known`, where no format is `asked` for by `option`
/// (empty: there is none that could); io::FileError for a folder.
void require_format(const std::string& path, const std::string& asked, const std::vector<std::string>& known,
                    const std::string& option);

/// Throws Failure (usage) for columns that no table has: two or three numbers from 1, or names.
void require_columns(const std::string& columns, const std::string& option);

/// What the reader is told. Throws Failure (usage) for standard input without a format.
[[nodiscard]] io::ReadOptions read_options(const InputOptions& options);

/// Checks the options, then reads. Wrong options throw Failure (usage), a wrong file io::FileError.
[[nodiscard]] io::PointSet read_input(const InputOptions& options);

/// Throws Failure (usage) for a name that is none of `cadt generate --list`.
void require_point_set(const std::string& name);

/// "in.xy", or "standard input" for "-".
[[nodiscard]] std::string display_name(const std::string& path, bool input);

}  // namespace cadt::cli
