// SPDX-License-Identifier: Apache-2.0
#include "tiles_command.hpp"

#include "failure.hpp"
#include "generated_set.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "system.hpp"
#include "text.hpp"
#include "tiles/files.hpp"
#include "tiles/mesh_directory.hpp"
#include "tiles/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace cadt::cli {
namespace {

void add_inputs(CLI::App& command, TilesCommand& c) {
  command.add_option("IN", c.inputs,
                     "files with points, one set in the order given; .npy, .f64 and .f32 are read by range");
  add_read_options(command, c.read);
  add_generated_set(command, c.generate, c.n, c.set.seed);
}

void add_outputs(CLI::App& command, TilesCommand& c) {
  command
      .add_option("-o,--output", c.output,
                  "directory for the mesh, made new; without it the mesh is made, certified, hashed and dropped")
      ->type_name("DIR")
      ->check(CLI::Validator(
          [](const std::string& name) { return name.empty() ? "the directory has an empty name" : std::string(); },
          ""));
  command.add_flag("--resume", c.resume,
                   "continue in the directory: nodes that are there, and intact, are not made again");
  command.add_option("--picture", c.picture, "picture of the tiles, with the time of each: SVG")->type_name("FILE");
  command.add_option("--stats", c.stats, "times and counts of each node as JSON; '-' is standard output")
      ->type_name("FILE");
  command.add_flag("-q,--quiet", c.quiet, "nothing on standard error but errors");
}

void add_work(CLI::App& command, TilesCommand& c) {
  command
      .add_option(
          "--tile-points", c.tile_points,
          "most points of a tile (default: 134217728 = 2^27); the mesh does not depend on it, the directory does")
      ->type_name("N");
  add_device_options(command, c.device);
  command.add_option("--devices", c.devices, "several devices of the back end, which share the tiles: 0,1")
      ->type_name("LIST");
  add_memory_option(command, c.device);
  command.add_option("--scratch", c.scratch, "folder for points that do not fit into memory: 24 bytes a point")
      ->type_name("DIR");
  command
      .add_option(
          "--host-memory", c.host_memory,
          "memory that the points of all tiles may take before they go to --scratch (default: half of what is free)")
      ->type_name("SIZE");
}

}  // namespace

void add_tiles_options(CLI::App& command, TilesCommand& c) {
  add_inputs(command, c);
  add_outputs(command, c);
  add_work(command, c);
}

void check_tiles_options(const TilesCommand& c) {
  if (c.inputs.empty() == c.generate.empty()) {
    throw Failure(exit_usage, c.inputs.empty() ? "name files with points, or a set with --generate"
                                               : "give files with points, or --generate: not both");
  }
  if (std::count(c.inputs.begin(), c.inputs.end(), "-") > 1)
    throw Failure(exit_usage, "only one of the files can be standard input");
  if (c.resume && c.output.empty()) throw Failure(exit_usage, "--resume needs the directory: add -o mesh.cadt");
  if (!c.devices.empty() && !c.device.device.empty())
    throw Failure(exit_usage, "--devices names all devices: leave --device out");
  for (const std::string& file : {c.picture, c.stats}) {
    if (file.empty() || file == "-") continue;
    require_no_input(file, c.inputs);
    if (!c.output.empty()) require_outside(file, c.output, "the mesh");
    require_writable(file);
  }
  if (same_output(c.picture, c.stats))
    throw Failure(exit_usage,
                  fmt::format("--picture and --stats both go to {}; give one of them another name", c.stats));
  if (!c.picture.empty() && c.picture != "-" && !lower(c.picture).ends_with(".svg"))
    throw Failure(exit_usage, fmt::format("--picture {}: it is an SVG; end the file's name in .svg", c.picture));
}

std::unique_ptr<tiles::PointSource> open_source(const TilesCommand& c) {
  if (c.generate.empty()) {
    InputOptions input = c.read;
    if (std::find(c.inputs.begin(), c.inputs.end(), "-") != c.inputs.end()) input.path = "-";
    for (const std::string& file : c.inputs) require_format(file, input.format, io::point_read_formats(), "-f");
    return tiles::open_files(c.inputs, read_options(input));
  }
  io::GenerateOptions options = c.set;
  options.n = parse_count(c.n);
  require_point_set(c.generate);
  return tiles::generated(c.generate, options);
}

std::vector<std::string> named_devices(const TilesCommand& c) {
  std::vector<std::string> all;
  if (c.devices.empty()) return all;
  for (std::size_t at = 0; at <= c.devices.size();) {
    const std::size_t end = std::min(c.devices.find(',', at), c.devices.size());
    all.push_back(c.devices.substr(at, end - at));
    if (all.back().empty())
      throw Failure(exit_usage, fmt::format("--devices {}: a name is missing; write for example 0,1", c.devices));
    at = end + 1;
  }
  return all;
}

Options device_options(const TilesCommand& c) {
  Options base = library_options(c.device);
  base.statistics = c.stats.empty() && c.output.empty() ? StatisticsDetail::none : StatisticsDetail::counters;
  return base;
}

tiles::RunOptions run_options(const TilesCommand& c) {
  tiles::RunOptions options;
  if (!c.tile_points.empty()) options.tile_points = parse_count(c.tile_points);
  if (options.tile_points < tiles::least_tile_points)
    throw Failure(exit_usage, fmt::format("--tile-points {}: a tile has at least {} points", c.tile_points,
                                          tiles::least_tile_points));
  if (!c.host_memory.empty()) options.host_memory = parse_bytes(c.host_memory);
  options.devices.clear();
  options.output = c.output;
  options.resume = c.resume;
  options.scratch = c.scratch;
  options.stop = interrupt_token();
  return options;
}

std::string tiles_summary(const tiles::RunResult& r) {
  const auto resumed = std::count_if(r.nodes.begin(), r.nodes.end(), [](const auto& node) { return node.resumed; });
  std::string text = key_line("points", std::to_string(r.whole.points));
  text += key_line("duplicates", std::to_string(r.whole.points - r.whole.distinct));
  text += key_line("triangles", std::to_string(r.whole.triangles));
  text += key_line("hull", std::to_string(r.whole.hull_edges));
  text += key_line(
      "tiles", fmt::format("{} of at most {} points, {} joins, {} open vertices at most", r.plan.tree.leaves().size(),
                           r.plan.tile_points, r.nodes.size() - r.plan.tree.leaves().size(), r.most_open));
  if (resumed != 0) text += key_line("resumed", fmt::format("{} of {} nodes were there", resumed, r.nodes.size()));
  text += key_line("time", fmt::format("{:.3f} s (sample {:.3f}, shuffle {:.3f}, tiles {:.3f}, links {:.3f})",
                                       r.sample_seconds + r.shuffle_seconds + r.nodes_seconds + r.links_seconds,
                                       r.sample_seconds, r.shuffle_seconds, r.nodes_seconds, r.links_seconds));
  text += key_line("devices", join(r.devices));
  text += key_line("hash", r.hash.to_string());
  return text;
}

void write_tiles_reports(const TilesCommand& c, const tiles::PointSource& source, const tiles::RunOptions& options,
                         const tiles::RunResult& result) {
  const std::string report = tiles::report_json(result, options, source.names());
  // A directory that was complete is left as it is, also where nothing can be written.
  const std::string path = c.output + "/run.json";
  std::error_code code;
  const bool resumed = std::ranges::all_of(result.nodes, [](const auto& node) { return node.resumed; });
  if (!c.output.empty() && !(resumed && (std::filesystem::exists(path, code) || !may_write(c.output)))) {
    const InPhase phase(Phase::writing);
    tiles::replace_text(path, report);
  }
  if (!c.stats.empty()) write_text(c.stats, report);
  if (c.picture.empty()) return;
  std::vector<double> seconds;
  for (const tiles::NodeReport& node : result.nodes) seconds.push_back(node.times.compute);
  write_text(c.picture, tiles::tree_svg(result.plan.tree, seconds));
}

void say_how_to_resume(const TilesCommand& c) {
  if (tiles::is_mesh_directory(c.output)) say(fmt::format("cadt: {} can be continued with --resume\n", c.output));
}

void print_tiles_summary(const TilesCommand& c, const tiles::RunResult& result) {
  if (result.whole.dimension < 2 && !c.quiet) {
    say("cadt: warning: no triangles: all points lie on one line, or there are fewer than three; the mesh is empty. "
        "Check --columns and --project if you expected some.\n");
  }
  const std::string text = tiles_summary(result);
  if (c.output.empty() && c.stats != "-") {
    print(text);
  } else if (!c.quiet) {
    say(text);
  }
}

}  // namespace cadt::cli
