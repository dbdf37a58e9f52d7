// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "failure.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "tile_errors.hpp"
#include "tiles_command.hpp"

#include <cadt/errors.hpp>

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

std::vector<Options> chosen_devices(const TilesCommand& c) {
  const Options base = device_options(c);
  std::vector<Options> all;
  for (const std::string& name : named_devices(c)) {
    all.push_back(base);
    all.back().device = name;
  }
  if (all.empty()) all.push_back(base);
  return all;
}

int run(const TilesCommand& c) {
  check_tiles_options(c);
  ProgressLine line(c.quiet);
  std::string phase;
  tiles::RunOptions options = run_options(c);
  options.devices = chosen_devices(c);
  options.progress = [&line, &phase](const tiles::RunProgress& p) {
    phase = p.nodes == 0 ? std::string(p.phase) : fmt::format("{} {}/{}", p.phase, p.nodes_done, p.nodes);
    line.update({.phase = phase, .fraction = p.fraction});
  };
  tiles::RunResult result;
  std::unique_ptr<tiles::PointSource> source;
  with_tile_errors([&] {
    line.step("reading");
    source = open_source(c);
    line.start(source->size());
    const InPhase in_phase(Phase::cooperative);
    try {
      result = tiles::run(*source, options);
    } catch (const Cancelled&) {
      line.clear();
      say_how_to_resume(c);
      throw;
    }
  });
  line.clear();
  write_tiles_reports(c, *source, options, result);
  print_tiles_summary(c, result);
  return exit_done;
}

}  // namespace

void add_tiles(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("tiles", "triangulate more points than a device or a memory takes, tile by tile");
  const auto options = std::make_shared<TilesCommand>();
  add_tiles_options(*command, *options);
  command->footer(
      "The mesh is that of all points in one call, to the last tie: a tile is triangulated alone, what no other tile "
      "can\n"
      "change is final, and the few open vertices are joined up a tree of tiles. Each edge is certified once.\n\n"
      "Examples:\n"
      "  cadt tiles country/*.npy -o country.cadt\n"
      "      one mesh of many files; cadt info, verify and merge read the directory\n"
      "  cadt tiles country/*.npy -o country.cadt --resume\n"
      "      goes on after an interruption, to the same bytes\n"
      "  cadt tiles points.f64 -o mesh.cadt --devices 0,1 --scratch /fast/disk\n"
      "      two devices share the tiles; points that memory does not take go to a disk\n"
      "  cadt tiles --generate uniform -n 10M --tile-points 1M\n"
      "      makes, certifies, hashes and drops the mesh: is this machine up to it?\n\n" +
      std::string(exit_codes_of_tiles));
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
