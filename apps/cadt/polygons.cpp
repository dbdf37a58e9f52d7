// SPDX-License-Identifier: Apache-2.0
// cadt polygons: the inside of each polygon of a file, triangulated apart from all others.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "graph.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "region_output.hpp"
#include "text.hpp"

#include <cadt/io/segments_file.hpp>
#include <cadt/polygons.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace cadt::cli {
namespace {

struct PolygonsCommand {
  std::string input, format;
  SegmentOptions segments;
  OutputOptions output;
  DeviceOptions device;
  bool strict = false, quiet = false;
};

/// "polygon 1 of feature 3": its number among those of its feature.
std::string name_of(const io::PolygonsFile& file, std::size_t polygon) {
  std::size_t first = polygon;
  while (first > 0 && file.features[first - 1] == file.features[polygon]) --first;
  return fmt::format("polygon {} of feature {}", polygon - first, file.features[polygon]);
}

std::string describe(const io::PolygonsFile& file, const PolygonProblem& problem) {
  const auto place = [&](std::int32_t v) {
    const auto at = 2 * static_cast<std::size_t>(v);
    return fmt::format("({}, {})", file.xy[at], file.xy[at + 1]);
  };
  std::string text = fmt::format("{}: {}", name_of(file, problem.polygon), to_string(problem.status));
  if (problem.first < 0) {
    const auto point = [&](std::size_t p) {
      return file.ring_offsets[static_cast<std::size_t>(file.polygon_offsets[p])];
    };
    return text +
           (point(problem.polygon) == point(problem.polygon + 1) ? ", it has none" : ", its first ring has none");
  }
  const bool pair = problem.first != problem.second;
  text += pair ? ", the edges from " : " at ";
  text += place(problem.first);
  if (pair) text += " and " + place(problem.second);
  return text;
}

bool crosses(PolygonStatus status) {
  return status == PolygonStatus::self_crossing || status == PolygonStatus::ring_crossing;
}

/// Points and rings of polygon p, alone.
Graph graph_of(const io::PolygonsFile& file, std::size_t p) {
  const auto first = static_cast<std::ptrdiff_t>(file.polygon_offsets[p]);
  const auto last = static_cast<std::ptrdiff_t>(file.polygon_offsets[p + 1]);
  std::vector<std::int64_t> offsets(file.ring_offsets.begin() + first, file.ring_offsets.begin() + last + 1);
  const std::int64_t begin = offsets.front();
  for (std::int64_t& offset : offsets) offset -= begin;
  Graph graph;
  graph.points.xy.assign(file.xy.begin() + 2 * begin, file.xy.begin() + 2 * (begin + offsets.back()));
  if (!file.height.empty()) {
    graph.points.height.assign(file.height.begin() + begin, file.height.begin() + begin + offsets.back());
  }
  graph.segments = ring_segments(offsets);
  return graph;
}

/// Appends what is inside of a polygon whose rings may cross. Its points come once more, behind all others. If there is
/// nothing: why, as far as that does not follow from its status.
std::optional<std::string> append_mended(RegionResult& result, const io::PolygonsFile& file,
                                         const PolygonProblem& problem, const std::string& name,
                                         const ConstraintOptions& constraints, const Options& options, bool quiet) {
  const std::size_t p = problem.polygon;
  const Graph graph = graph_of(file, p);
  std::optional<ConstrainedTriangulation> mesh;
  try {
    const InPhase phase(Phase::cooperative);
    mesh = triangulate_constrained(graph.points.view(), graph.segments, constraints, options);
  } catch (const OptionError& e) {
    if (e.option() != "grid") throw;
    const std::string_view what = e.what();  // "ConstraintOptions::grid: ..."
    return fmt::format("; --crossing {}", what.substr(what.find(e.option())));
  } catch (const Error&) {
    throw Failure(exit_file, fmt::format("{}: {}", name, explain_graph_error(graph.points.view(), graph.segments)));
  }
  if (mesh->number_inside() == 0) {
    return constraints.crossing == Crossing::grid ? "; nothing is inside on the grid" : "";
  }
  note_rounding(*mesh, fmt::format("{}, {}", name, name_of(file, p)), quiet);
  append_inside(result, *mesh, static_cast<std::int32_t>(result.points.size()));
  result.region.resize(result.triangles.size() / 3);
  std::fill(result.region.end() - static_cast<std::ptrdiff_t>(mesh->number_inside()), result.region.end(),
            file.features[p]);
  const io::PointSet points = points_of(graph, *mesh);
  result.points.xy.insert(result.points.xy.end(), points.xy.begin(), points.xy.end());
  result.points.height.insert(result.points.height.end(), points.height.begin(), points.height.end());
  return std::nullopt;
}

/// Of the polygons with a defect.
struct Problems {
  std::size_t mended = 0, left_out = 0;
};

/// Those that cross, with a rule for that, and the others with a defect, which are named.
Problems handle_problems(const PolygonsCommand& command, RegionResult& result, const io::PolygonsFile& file,
                         const PolygonsResult& polygons, const Options& options) {
  const std::string name = display_name(command.input, true);
  ConstraintOptions constraints = constraint_options(command.segments);
  constraints.domain = Domain::even_odd;
  std::string text;
  Problems problems;
  bool some_cross = false;
  for (const PolygonProblem& problem : polygons.problems()) {
    check_interrupt();
    std::string why;
    if (constraints.crossing != Crossing::error && crosses(problem.status)) {
      const auto left_out = append_mended(result, file, problem, name, constraints, options, command.quiet);
      if (!left_out) {
        ++problems.mended;
        continue;
      }
      why = *left_out;
    }
    some_cross = some_cross || crosses(problem.status);
    constexpr std::size_t most_shown = 10;
    if (++problems.left_out <= most_shown) text += "\n  " + describe(file, problem) + why;
    if (problems.left_out == most_shown + 1) text += "\n  ...";
  }
  const std::size_t count = problems.left_out;
  if (count == 0) return problems;
  text =
      fmt::format("{}: {} of {} polygons {} no inside:{}", name, count, file.size(), count == 1 ? "has" : "have", text);
  if (command.strict) throw Failure(exit_file, text + "\n  Nothing was written. Without --strict they are left out.");
  if (!command.quiet) {
    const bool helps = constraints.crossing == Crossing::error && some_cross;
    say(fmt::format("cadt: warning: {}\n  They are left out; {}--strict makes this an error.\n", text,
                    helps ? "--crossing exact takes rings that cross; " : ""));
  }
  return problems;
}

/// The triangles of all polygons, each with its feature, and the rings of those that have some.
RegionResult result_of(const io::PolygonsFile& file, const PolygonsResult& polygons) {
  RegionResult result;
  result.region_name = "feature";
  result.points.xy = file.xy;
  result.points.height = file.height;
  result.crs = file.crs;
  result.triangles.assign(polygons.triangles().begin(), polygons.triangles().end());
  const auto offsets = polygons.triangle_offsets();
  for (std::size_t p = 0; p < file.size(); ++p) {
    result.region.resize(static_cast<std::size_t>(offsets[p + 1]), file.features[p]);
    if (polygons.status()[p] != PolygonStatus::ok) continue;
    const auto rings =
        std::span(file.ring_offsets)
            .subspan(static_cast<std::size_t>(file.polygon_offsets[p]),
                     static_cast<std::size_t>(file.polygon_offsets[p + 1] - file.polygon_offsets[p]) + 1);
    const std::vector<Segment> edges = ring_segments(rings);
    result.segments.insert(result.segments.end(), edges.begin(), edges.end());
  }
  return result;
}

int run(const PolygonsCommand& command) {
  if (command.input == "-" && command.format.empty())
    throw Failure(exit_usage, "standard input has no suffix; name its format: -f geojson");
  require_format(command.input, command.format, {"geojson", "json"}, "-f");
  const auto outputs =
      plan_outputs(command.output.outputs, command.output.formats, io::region_write_formats(), {command.input});
  static_cast<void>(constraint_options(command.segments));  // which may be wrong
  ProgressLine line(command.quiet);
  const std::string name = display_name(command.input, true);
  line.step(fmt::format("reading {}", name));
  const io::PolygonsFile file = io::read_polygons(command.input, command.format);

  if (file.some_heights && !command.quiet) note_no_heights(name, true);

  Options options = library_options(command.device);
  options.statistics = StatisticsDetail::none;
  options.stop = interrupt_token();
  line.step(fmt::format("triangulating {} polygons", file.size()));
  const PolygonsResult polygons = [&] {
    const InPhase phase(Phase::cooperative);
    return triangulate_polygons(PointsView(std::span<const double>(file.xy)), file.ring_offsets, file.polygon_offsets,
                                options);
  }();
  line.clear();
  RegionResult result = result_of(file, polygons);
  const Problems problems = handle_problems(command, result, file, polygons, options);
  write_regions(outputs, command.output, result, line);

  std::string summary = fmt::format("features    {}\npolygons    {}\nrings       {}\npoints      {}\ntriangles   {}\n",
                                    file.number_of_features, file.size(), file.ring_offsets.size() - 1,
                                    result.points.size(), result.triangles.size() / 3);
  if (problems.mended != 0)
    summary += fmt::format("mended      {} polygon{} in the output twice\n", problems.mended,
                           problems.mended == 1 ? ", its points are" : "s, their points are");
  if (problems.left_out != 0)
    summary += fmt::format("no inside   {} polygon{}\n", problems.left_out, problems.left_out == 1 ? "" : "s");
  if (file.other_geometries != 0) summary += fmt::format("left out    {} points and lines\n", file.other_geometries);
  print_summary(summary, outputs.empty(), command.quiet);
  return exit_done;
}

}  // namespace

void add_polygons(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("polygons", "triangulate the inside of each polygon of a GeoJSON file");
  const auto options = std::make_shared<PolygonsCommand>();
  command->add_option("IN", options->input, "GeoJSON file; '-' is standard input (with -f)")->required();
  command->add_option("-f,--from", options->format, "format: geojson json; default: from the suffix")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"geojson", "json"}).description(""));
  add_region_output_options(*command, options->output);
  add_crossing_option(*command, options->segments);
  add_device_options(*command, options->device);
  command->add_flag("--strict", options->strict, "exit 3 if a polygon has no inside");
  command->add_flag("-q,--quiet", options->quiet, "nothing on standard error but errors");
  command->footer(
      "Inside is what is behind an odd number of rings, so holes are left out. Polygons do not know of each other: "
      "where\n"
      "they share a border, its points are there twice. Each triangle has the number of its feature, from 0: as "
      "attribute\n"
      "'feature' in .ply, .vtu and .geojson, as column in .ele. Polygons that have no inside, such as those that "
      "cross\n"
      "themselves, are named and left out; with --crossing exact rings may cross.\n\n"
      "Examples:\n"
      "  cadt polygons countries.geojson -o countries.png -o triangles.geojson\n"
      "  cadt polygons parcels.json --crossing exact -o parcels.ply\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
