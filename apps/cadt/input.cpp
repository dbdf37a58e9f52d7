// SPDX-License-Identifier: Apache-2.0
#include "input.hpp"

#include "failure.hpp"
#include "text.hpp"

#include <cadt/io/generate.hpp>
#include <cadt/io/segments_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cadt::cli {

void add_input_options(CLI::App& command, InputOptions& options, const std::string& name, const std::string& text,
                       bool segments) {
  command.add_option(name, options.path, text + "; '-' is standard input (with -f)")->required();
  add_read_options(command, options, segments);
}

void add_read_options(CLI::App& command, InputOptions& options, bool segments) {
  std::vector<std::string> formats = io::point_read_formats();
  if (segments) {  // those that are no formats of points
    for (const std::string& format : io::segment_read_formats()) {
      if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
    }
  }
  command
      .add_option("-f,--from", options.format,
                  "format of the points: " + join(formats, " ") + "; default: from the suffix")
      ->type_name("FORMAT")
      ->check(CLI::IsMember(formats, CLI::ignore_case).description(""));
  command
      .add_option("--columns", options.columns,
                  "columns of a table, counted from 1 or by their header names: 3,4 or lon,lat,depth")
      ->type_name("X,Y[,Z]");
  command
      .add_option("--project", options.projection,
                  "plane of 3D points: xy, yz or zx (default: xy); the third coordinate goes to 3D outputs")
      ->type_name("PLANE")
      ->check(CLI::IsMember({"xy", "yz", "zx"}).description(""));
}

void add_floats_option(CLI::App& command, InputOptions& options) {
  command.add_flag("--floats", options.floats,
                   "round the coordinates to floats, which is what devices without double precision take");
}

void round_to_floats(io::PointSet& points, const InputOptions& options, bool quiet) {
  if (!options.floats) return;
  std::size_t moved = 0;
  for (std::size_t i = 0; i < points.xy.size(); i += 2) {
    bool same = true;
    for (double* v : {&points.xy[i], &points.xy[i + 1]}) {
      const double rounded = static_cast<double>(static_cast<float>(*v));
      if (!std::isfinite(rounded))
        throw Failure(exit_file, fmt::format("{}: point {} (counted from 0) is beyond the largest float, 3.4e38: scale "
                                             "the points or leave out --floats",
                                             display_name(options.path, true), i / 2));
      same = same && rounded == *v;
      *v = rounded;
    }
    moved += same ? 0 : 1;
  }
  if (moved != 0 && !quiet) say(fmt::format("cadt: --floats moved {} of {} points\n", moved, points.size()));
}

void require_point_set(const std::string& name) {
  const auto& all = io::distributions();
  if (std::none_of(all.begin(), all.end(), [&](const auto& entry) { return entry.name == name; }))
    throw Failure(exit_usage, fmt::format("there is no point set '{}' (see: cadt generate --list)", name));
}

io::ReadOptions read_options(const InputOptions& options) {
  if (options.path == "-" && options.format.empty()) {
    throw Failure(exit_usage, "standard input has no suffix; name its format, for example: -f xy");
  }
  io::ReadOptions read;
  read.format = lower(options.format);
  read.columns = options.columns;
  read.projection = options.projection == "yz"   ? io::Projection::yz
                    : options.projection == "zx" ? io::Projection::zx
                                                 : io::Projection::xy;
  return read;
}

io::PointSet read_input(const InputOptions& options) { return io::read_points(options.path, read_options(options)); }

std::string display_name(const std::string& path, bool input) {
  if (path != "-") return path;
  return input ? "standard input" : "standard output";
}

}  // namespace cadt::cli
