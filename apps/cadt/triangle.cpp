// SPDX-License-Identifier: Apache-2.0
// cadt triangle: the command line of Jonathan Shewchuk's Triangle, for points and segments.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "graph.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "text.hpp"

#include <cadt/cadt.hpp>
#include <cadt/io/segments_file.hpp>
#include <cadt/io/triangle_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
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
  const bool poly = std::any_of(files.begin(), files.end(), [](const auto& file) { return file.ends_with(".poly"); });
  if (poly) letters += 'p';  // which Triangle takes it for
  Request request;
  request.switches = parse_triangle_switches(letters);
  if (request.switches.help) throw CLI::CallForHelp();
  if (files.empty()) throw Failure(exit_usage, "a file is missing; name one, for example: cadt triangle -nev dots");
  if (files.size() > 1)
    throw Failure(exit_usage, fmt::format("{} files are named: {}; name one", files.size(), join(files)));
  request.file = files.front();
  return request;
}

/// Points, segments and what is made of them.
struct Work {
  io::SegmentsFile input;
  Triangulation mesh;
  ConstrainedTriangulation constrained;  ///< with switch p, and `mesh` is its mesh
  TriangleOutput result;
  [[nodiscard]] TriangleInput points() const {
    return {input.xy, input.attributes, input.attributes_per_point, input.markers};
  }
  [[nodiscard]] TriangleSegments segments() const {
    return {input.segments, input.segment_markers, input.holes, input.regions};
  }
};

void read(Work& work, const std::string& file, bool segments) {
  if (segments) {
    work.input = io::read_segments(file, "poly");
    return;
  }
  io::NodeFile nodes = io::read_node_file(file);
  work.input.xy = std::move(nodes.xy);
  work.input.attributes = std::move(nodes.attributes);
  work.input.attributes_per_point = nodes.attributes_per_point;
  work.input.markers = std::move(nodes.markers);
  work.input.base = nodes.base;
}

void triangulate(Work& work, const std::string& file, const TriangleSwitches& switches, const Options& options) {
  const InPhase phase(Phase::cooperative);
  if (!switches.segments) {
    work.mesh = cadt::triangulate(work.input.xy, options);
    return;
  }
  try {
    work.constrained = triangulate_as_triangle(work.points(), work.segments(), switches, options);
  } catch (const CrossingError& e) {
    constexpr const char* how = " so close to others that rounding the crossings turns triangles over";
    throw Failure(exit_file,
                  fmt::format("{}: {}move them apart, or use cadt triangulate --domain seeds --crossing grid=G", file,
                              name_crossings(e, how, work.input.view(), work.input.segments)));
  }
  work.mesh = work.constrained.mesh();
}

std::string summary(const Work& work, bool segments, const std::vector<std::string>& files) {
  const Triangulation& mesh = work.mesh;
  std::string text;
  for (const std::string& file : files) text += fmt::format("cadt: wrote {}\n", file);
  text += fmt::format("points      {}\nduplicates  {}\ntriangles   {}\nedges       {}\n", mesh.number_of_points(),
                      mesh.duplicates().size(), work.result.triangles.size() / 3, work.result.number_of_edges);
  if (!segments) return text + fmt::format("hull        {}\n", mesh.hull().size());
  return text + fmt::format("segments    {}, which are {} edges\n", work.input.segments.size(),
                            work.result.segments.size() / 2);
}

void warn(const TriangleSwitches& switches, const Work& work, const std::string& name, bool nodes_written) {
  for (const char letter : switches.without_effect) {
    say(fmt::format("cadt: -{} has no effect: it {}\n", letter, why_without_effect(letter)));
  }
  if (switches.segments) {
    const TriangleSegments all = work.segments();
    note_far_seeds(work.input.view(), work.constrained, all.holes.first(switches.ignore_holes ? 0 : all.holes.size()),
                   all.regions.first(switches.region_attributes ? all.regions.size() : 0), name);
  }
  if (work.mesh.dimension() < 2) {
    say(fmt::format("cadt: warning: {}: no triangles: the points are fewer than three, or all on one line\n", name));
  } else if (work.result.triangles.empty()) {
    say(fmt::format("cadt: warning: {}: no triangles: the segments enclose nothing that no hole reaches{}\n", name,
                    switches.hull_segments ? "" : "; -c has the edges of the hull as segments, too"));
  }
  const std::size_t left_out = work.mesh.number_of_points() - work.result.xy.size() / 2;
  if (left_out != 0 && !nodes_written) {
    say(
        fmt::format("cadt: warning: {}: -j left out {} of the points, and no .node file with the new numbers is "
                    "written: leave -j out\n",
                    name, left_out));
  }
}

/// Who leaves -p out, though there is a .poly file alone, is told.
void require_nodes(const std::string& path, bool segments) {
  namespace fs = std::filesystem;
  std::error_code code;
  const fs::path poly = fs::path(path).replace_extension(".poly");
  if (!segments && !fs::exists(path, code) && fs::exists(poly, code))
    throw io::FileError(path, 0, fmt::format("there is no such file; -p reads {}", poly.string()));
}

int run(const TriangleCommand& command, const Request& request) {
  const TriangleSwitches& switches = request.switches;
  const io::TriangleNames names = io::triangle_names(request.file, switches.no_iteration, switches.segments);
  ProgressLine line(switches.quiet);
  Options options = library_options(command.device);
  if (!switches.verbose) options.statistics = StatisticsDetail::none;
  options.stop = interrupt_token();
  options.progress = [&line](const Progress& progress) { line.update(progress); };

  Work work;
  line.step(fmt::format("reading {}", names.input));
  require_nodes(names.input, switches.segments);
  read(work, names.input, switches.segments);
  const bool points_in_poly = switches.segments && !work.input.nodes_beside;
  const std::vector<std::string> files = io::triangle_output_files(names.output, switches, points_in_poly);
  for (const std::string& file : files) require_writable(file);
  line.start(work.input.size());
  triangulate(work, names.input, switches, options);
  check_interrupt();
  line.step("writing");
  work.result = switches.segments ? triangle_output(work.points(), work.segments(), work.constrained, switches)
                                  : triangle_output(work.points(), work.mesh, switches);
  {
    const InPhase phase(Phase::writing);
    io::write_triangle_files(names.output, work.result, switches, work.input.base, points_in_poly);
  }
  line.clear();
  check_interrupt_after(files);
  if (switches.quiet) return exit_done;
  warn(switches, work, names.input, std::find(files.begin(), files.end(), names.output + ".node") != files.end());
  print(summary(work, switches.segments, files));
  if (switches.verbose) {
    RunReport report;
    report.mesh = &work.mesh;
    print("\n" + statistics_text(report));
  }
  return exit_done;
}

}  // namespace

void add_triangle(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("triangle", "as Jonathan Shewchuk's Triangle: its switches, its files");
  const auto options = std::make_shared<TriangleCommand>();
  command->allow_extras();
  command->add_option("FILE", options->files,
                      "file with points (.node), or with points and segments (.poly, -p), in Triangle's formats; the "
                      "suffix may be left out");
  add_device_options(*command, options->device);
  command->footer(
      "Reads FILE.node, with -p FILE.poly, and writes FILE.1.node and FILE.1.ele, from FILE.1.node FILE.2.node and so "
      "on.\n\n"
      "Switches, as in Triangle, alone or together:\n"
      "  -p  segments, holes and regions (.poly)      -A  regions of triangles, with -p (.ele)\n"
      "  -O  holes are ignored, with -p\n"
      "  -n  neighbours of triangles (.neigh)         -B  no boundary markers\n"
      "  -e  edges (.edge)                            -N  no .node\n"
      "  -v  Voronoi diagram (.v.node, .v.edge)       -E  no .ele\n"
      "  -c  the hull as segments (.poly)             -P  no .poly\n"
      "  -g  the mesh for Geomview (.off)             -I  no iteration number, no .poly, and no .node\n"
      "  -j  points that are no vertices left out         unless the points were in the .poly\n"
      "  -z  count from 0; the file's first index     -Q  nothing on standard output and error but errors\n"
      "      overrides it                             -V  statistics too\n"
      "  -i -F -l -s  accepted; they change nothing   -h  this help\n"
      "All others are refused with the reason, exit code 8. docs/triangle.md has the differences.\n\n"
      "Example:\n"
      "  cadt triangle -nev dots\n"
      "  cadt triangle -pA plate.poly\n");
  command->callback([options, command, &chosen] {
    const Request request = parse_words(command->remaining(), options->files);
    chosen = [options, request] { return run(*options, request); };
  });
}

}  // namespace cadt::cli
