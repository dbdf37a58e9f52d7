// SPDX-License-Identifier: Apache-2.0
// cadt triangle: the command line of Jonathan Shewchuk's Triangle, for point sets.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "text.hpp"

#include <cadt/cadt.hpp>
#include <cadt/io/triangle_files.hpp>

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

struct TriangleCommand {
  std::vector<std::string> files;
  DeviceOptions device;
};

struct Request {
  TriangleSwitches switches;
  std::string file;
};

/// Switches may stand before and after the file, as one word or as several.
Request parse_words(const std::vector<std::string>& switches, const std::vector<std::string>& files) {
  std::string letters;
  for (const std::string& word : switches) {
    if (word.starts_with("--"))
      throw Failure(exit_usage, fmt::format("there is no option '{}'; see: cadt triangle --help", word));
    letters += word;
  }
  Request request;
  request.switches = parse_triangle_switches(letters);
  if (request.switches.help) throw CLI::CallForHelp();
  if (files.empty()) throw Failure(exit_usage, "a file is missing; name one, for example: cadt triangle -nev dots");
  if (files.size() > 1)
    throw Failure(exit_usage, fmt::format("{} files are named: {}; name one", files.size(), join(files)));
  request.file = files.front();
  return request;
}

std::string summary(const Triangulation& mesh, const TriangleOutput& result, const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& file : files) text += fmt::format("cadt: wrote {}\n", file);
  return text + fmt::format("points      {}\nduplicates  {}\ntriangles   {}\nedges       {}\nhull        {}\n",
                            mesh.number_of_points(), mesh.duplicates().size(), mesh.number_of_triangles(),
                            result.number_of_edges, mesh.hull().size());
}

void warn(const TriangleSwitches& switches, const Triangulation& mesh, const std::string& name) {
  for (const char letter : switches.without_effect) {
    say(fmt::format("cadt: -{} has no effect: it {}\n", letter, why_without_effect(letter)));
  }
  if (mesh.dimension() < 2) {
    say(fmt::format("cadt: warning: {}: no triangles: the points are fewer than three, or all on one line\n", name));
  }
}

int run(const TriangleCommand& command, const Request& request) {
  const TriangleSwitches& switches = request.switches;
  const io::TriangleNames names = io::triangle_names(request.file, switches.no_iteration);
  const std::vector<std::string> files = io::triangle_output_files(names.output, switches);
  for (const std::string& file : files) require_writable(file);

  ProgressLine line(switches.quiet);
  Options options = library_options(command.device);
  if (!switches.verbose) options.statistics = StatisticsDetail::none;
  options.stop = interrupt_token();
  options.progress = [&line](const Progress& progress) { line.update(progress); };

  line.step(fmt::format("reading {}", names.input));
  const io::NodeFile nodes = io::read_node_file(names.input);
  line.start(nodes.xy.size() / 2);
  const Triangulation mesh = [&] {
    const InPhase phase(Phase::cooperative);
    return triangulate(nodes.xy, options);
  }();
  check_interrupt();
  line.step("writing");
  const TriangleOutput result =
      triangle_output({nodes.xy, nodes.attributes, nodes.attributes_per_point, nodes.markers}, mesh, switches);
  {
    const InPhase phase(Phase::writing);
    io::write_triangle_files(names.output, result, switches, nodes.base);
  }
  line.clear();
  try {
    check_interrupt();
  } catch (const Cancelled&) {
    say(fmt::format("cadt: complete before the interruption: {}\n", join(files)));
    throw;
  }
  if (switches.quiet) return exit_done;
  warn(switches, mesh, names.input);
  print(summary(mesh, result, files));
  if (switches.verbose) {
    RunReport report;
    report.mesh = &mesh;
    print("\n" + statistics_text(report));
  }
  return exit_done;
}

}  // namespace

void add_triangle(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("triangle", "as Jonathan Shewchuk's Triangle, for points: its switches, its files");
  const auto options = std::make_shared<TriangleCommand>();
  command->allow_extras();
  command->add_option("FILE", options->files,
                      "file with points, in Triangle's .node format; its suffix may be left out");
  add_device_options(*command, options->device);
  command->footer(
      "Reads FILE.node and writes FILE.1.node and FILE.1.ele, from FILE.1.node FILE.2.node and so on.\n\n"
      "Switches, as in Triangle, alone or together:\n"
      "  -n  neighbours of triangles (.neigh)         -B  no boundary markers\n"
      "  -e  edges (.edge)                            -N  no .node\n"
      "  -v  Voronoi diagram (.v.node, .v.edge)       -E  no .ele\n"
      "  -c  the edges of the hull (.poly)            -P  no .poly\n"
      "  -g  the mesh for Geomview (.off)             -I  no iteration number, no .node, no .poly\n"
      "  -j  points that are no vertices left out     -Q  nothing on standard output and error but errors\n"
      "  -z  count from 0; the file's first index     -V  statistics too\n"
      "      overrides it                             -h  this help\n"
      "  -i -F -l -s  accepted; they change nothing here\n"
      "All others are refused with the reason, exit code 8. docs/triangle.md has the differences.\n\n"
      "Example:\n"
      "  cadt triangle -nev dots\n");
  command->callback([options, command, &chosen] {
    const Request request = parse_words(command->remaining(), options->files);
    chosen = [options, request] { return run(*options, request); };
  });
}

}  // namespace cadt::cli
