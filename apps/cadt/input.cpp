// SPDX-License-Identifier: Apache-2.0
#include "input.hpp"

#include "failure.hpp"
#include "text.hpp"

#include <cadt/io/errors.hpp>
#include <cadt/io/generate.hpp>
#include <cadt/io/segments_file.hpp>
#include <cadt/triangulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <system_error>

namespace cadt::cli {
namespace {

std::vector<std::string> formats_of(const InputOptions& options) {
  std::vector<std::string> formats = io::point_read_formats();
  if (!options.segments) return formats;
  for (const std::string& format : io::segment_read_formats()) {  // those that are no formats of points
    if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
  }
  return formats;
}

}  // namespace

void add_input_options(CLI::App& command, InputOptions& options, const std::string& name, const std::string& text,
                       bool segments) {
  command.add_option(name, options.path, text + "; '-' is standard input (with -f)")->required();
  add_read_options(command, options, segments);
}

void add_read_options(CLI::App& command, InputOptions& options, bool segments) {
  options.segments = segments;
  const std::vector<std::string> formats = formats_of(options);
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

void require_format(const std::string& path, const std::string& asked, const std::vector<std::string>& known,
                    const std::string& option) {
  namespace fs = std::filesystem;
  if (path.empty() || path == "-") return;
  std::error_code code;
  if (fs::is_directory(path, code))
    throw io::FileError(path, 0,
                        "is a folder, and a file is needed; the folders of cadt tiles are for cadt merge, cadt verify "
                        "and cadt info");
  if (!asked.empty()) return;
  const std::string suffix = lower(fs::path(path).extension().string());
  if (suffix == ".cadt" && !fs::exists(path, code)) throw io::FileError(path, 0, "there is no such folder");
  if (!suffix.empty() && std::find(known.begin(), known.end(), suffix.substr(1)) != known.end()) return;
  const bool of_gdal =
      suffix == ".shp" || suffix == ".gpkg" || suffix == ".fgb" || suffix == ".gml" || suffix == ".kml";
  const bool geojson = std::find(known.begin(), known.end(), "geojson") != known.end();
  throw Failure(
      exit_usage,
      fmt::format("{}: {}; {} one of: {}{}", path, suffix.empty() ? "no suffix" : "unknown suffix '" + suffix + "'",
                  option.empty() ? "it has to be" : "name the format with " + option + ",", join(known, " "),
                  of_gdal && geojson ? "; ogr2ogr OUT.geojson '" + path + "' makes one of them" : ""));
}

void require_columns(const std::string& columns, const std::string& option) {
  if (columns.empty()) return;
  const auto refuse = [&](const std::string& why) {
    throw Failure(exit_usage,
                  fmt::format("{} {}: {}; write for example {} 1,2 or {} x,y,z", option, columns, why, option, option));
  };
  std::size_t count = 0;
  for (std::size_t at = 0; at <= columns.size(); ++count) {
    const std::size_t end = std::min(columns.find(',', at), columns.size());
    const std::string name = columns.substr(at, end - at);
    if (name.find_first_not_of(" \t") == std::string::npos) refuse("a column is missing");
    if (name.find_first_not_of(" \t0") == std::string::npos) refuse("columns are counted from 1");
    at = end + 1;
  }
  if (count != 2 && count != 3) refuse("two or three columns are needed");
}

io::ReadOptions read_options(const InputOptions& options) {
  if (options.path == "-" && options.format.empty()) {
    throw Failure(exit_usage, "standard input has no suffix; name its format, for example: -f xy");
  }
  require_format(options.path, options.format, formats_of(options), "-f");
  require_columns(options.columns, "--columns");
  io::ReadOptions read;
  read.format = lower(options.format);
  read.columns = options.columns;
  read.projection = options.projection == "yz"   ? io::Projection::yz
                    : options.projection == "zx" ? io::Projection::zx
                                                 : io::Projection::xy;
  return read;
}

io::PointSet read_input(const InputOptions& options) {
  const io::ReadOptions read = read_options(options);
  // A raw file says by its size how many points it has: too many are refused before there is memory for the file.
  const std::string format =
      read.format.empty() ? lower(std::filesystem::path(options.path).extension().string()) : "." + read.format;
  std::error_code code;
  if (const std::size_t bytes = format == ".f64" ? 16 : format == ".f32" ? 8 : 0; bytes != 0)
    if (const std::uintmax_t points = std::filesystem::file_size(options.path, code) / bytes;
        !code && points > max_points())
      throw LimitError(options.path + " holds more points than fit", static_cast<std::size_t>(points), max_points());
  return io::read_points(options.path, read);
}

std::string display_name(const std::string& path, bool input) {
  if (path != "-") return path;
  return input ? "standard input" : "standard output";
}

}  // namespace cadt::cli
