// SPDX-License-Identifier: Apache-2.0
// The program `cadt`: selects the subcommand and turns every outcome into an exit code.
#include "commands.hpp"
#include "failure.hpp"
#include "help.hpp"
#include "interrupt.hpp"
#include "terrain.hpp"

#include <cadt/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

namespace {

using namespace cadt::cli;

const std::string examples =
    "Examples:\n"
    "  cadt generate uniform -n 100000 -o points.xy\n"
    "  cadt triangulate points.xy -o mesh.ply -o mesh.png\n"
    "      100,000 random points, their mesh, and a picture of it\n\n"
    "  cadt triangulate survey.csv --columns lon,lat,depth -o sea.vtu --verify\n"
    "      columns of a table by name; the third one is the height in the mesh, which is checked before it is "
    "written\n\n"
    "  cadt triangulate points.xy --backend host --threads 4 -o mesh.ele --stats=run.json\n"
    "  cadt verify points.xy mesh.ele\n"
    "      a chosen back end, statistics as JSON, and an exact check of the file (of any program)\n\n"
    "  cadt raster terrain.xyz --res 10 --method natural -o dem.asc\n"
    "      a terrain model from scattered heights, by natural neighbours\n\n"
    "  cadt raster scan.laz dem.tif --res 1 --class 2\n"
    "      a GeoTIFF from the ground points of a scan; this, contour and tin need: pip install \"cadt[terrain]\"\n\n"
    "Each command has its own help: cadt triangulate --help\n\n";

// Points to the right subcommand: a file name in its place is the usual mistake.
void explain_first_word(const CLI::App& app, int argc, char** argv) {
  if (argc < 2) throw Failure(exit_usage, "a command is missing; see: cadt --help");
  const std::string word = argv[1];
  if (!word.empty() && word[0] == '-') return;
  if (!app.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; }).empty()) return;
  std::string text = explain_command(app, word);
  std::error_code code;
  const bool near = text.ends_with('?');
  if (!near || std::filesystem::is_regular_file(word, code))
    text += fmt::format("{} To triangulate a file: cadt triangulate {}", near ? "" : ".", word);
  throw Failure(exit_usage, text);
}

int parse_and_run(int argc, char** argv) {
  CLI::App app(
      "cadt computes the Delaunay triangulation of points of the plane: exact, the same on every device, in parallel.",
      "cadt");
  app.allow_windows_style_options(false);  // /data/points.xy is a file there too
  Action action;
  app.set_version_flag("--version", "cadt " CADT_VERSION, "print the version and exit");
  app.set_help_flag("-h,--help", "print this help and exit");
  app.formatter(std::make_shared<HelpFormatter>());
  add_triangulate(app, action);
  add_polygons(app, action);
  add_labels(app, action);
  add_triangle(app, action);
#ifdef CADT_HAS_TILES
  add_tiles(app, action);
  add_merge(app, action);
#endif
  add_verify(app, action);
  add_locate(app, action);
  add_interpolate(app, action);
  add_raster(app, action);
  add_terrain_commands(app);
  add_voronoi(app, action);
#ifdef CADT_HAS_VIEWER
  add_render(app, action);
#endif
#ifdef CADT_HAS_WINDOW
  add_view(app, action);
#endif
  add_generate(app, action);
  add_devices(app, action);
  add_info(app, action);
  app.footer(examples + std::string(exit_codes_help));

  explain_first_word(app, argc, argv);
  if (is_for_terrain(argc, argv)) become_terrain(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // help and version
    app.exit(e);
    return exit_done;
  } catch (const CLI::ParseError& e) {
    const auto chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    const std::string name = chosen.empty() ? "cadt" : "cadt " + command.get_name();
    throw Failure(exit_usage, fmt::format("{}; see: {} --help", explain(e, command, name), name));
  }
  if (!action) throw Failure(exit_usage, "a command is missing; see: cadt --help");
  install_interrupt_handlers();
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  int code = exit_done;
  char help_option[] = "--help";
  char* help[] = {argc > 0 ? argv[0] : nullptr, help_option, nullptr, nullptr};
  if (argc > 1 && std::string_view(argv[1]) == "help") {  // cadt help COMMAND: cadt COMMAND --help
    if (argc > 2) help[1] = argv[2], help[2] = help_option;
    argc = std::min(argc, 3);
    argv = help;
  }
#if defined(SIGXFSZ)
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows over its limit is an error of the write, with the file's name
#endif
  try {
    code = parse_and_run(argc, argv);
    finish_stdout();
  } catch (...) {
    code = report_exception();
  }
  return code;
}
