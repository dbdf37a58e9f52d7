// SPDX-License-Identifier: Apache-2.0
#include "input.hpp"

#include "failure.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cadt::cli {

void add_input_options(CLI::App& command, InputOptions& options, const std::string& name, const std::string& text) {
  command.add_option(name, options.path, text + "; '-' is standard input (with -f)")->required();
  command
      .add_option("-f,--from", options.format,
                  "format of the points: " + join(io::point_read_formats(), " ") + "; default: from the suffix")
      ->type_name("FORMAT")
      ->check(CLI::IsMember(io::point_read_formats(), CLI::ignore_case).description(""));
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

io::PointSet read_input(const InputOptions& options) {
  if (options.path == "-" && options.format.empty()) {
    throw Failure(exit_usage, "standard input has no suffix; name its format, for example: -f xy");
  }
  io::ReadOptions read;
  read.format = lower(options.format);
  read.columns = options.columns;
  read.projection = options.projection == "yz"   ? io::Projection::yz
                    : options.projection == "zx" ? io::Projection::zx
                                                 : io::Projection::xy;
  return io::read_points(options.path, read);
}

std::string display_name(const std::string& path, bool input) {
  if (path != "-") return path;
  return input ? "standard input" : "standard output";
}

}  // namespace cadt::cli
