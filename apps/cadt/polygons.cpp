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

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace cadt::cli {
namespace {

struct PolygonsCommand {
  std::string input, format;
  SegmentOptions segments;
  RegionOutputOptions output;
  DeviceOptions device;
  bool quiet = false;
};

/// The points and the rings of polygon p.
struct Polygon {
  std::span<const double> xy;
  std::vector<Segment> segments;
};

Polygon polygon_of(const io::PolygonsFile& file, std::size_t p) {
  const auto first = static_cast<std::size_t>(file.polygon_offsets[p]);
  const auto last = static_cast<std::size_t>(file.polygon_offsets[p + 1]);
  const std::int64_t begin = file.ring_offsets[first], end = file.ring_offsets[last];
  std::vector<std::int64_t> offsets(file.ring_offsets.begin() + static_cast<std::ptrdiff_t>(first),
                                    file.ring_offsets.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  for (std::int64_t& offset : offsets) offset -= begin;
  return {std::span(file.xy).subspan(2 * static_cast<std::size_t>(begin), 2 * static_cast<std::size_t>(end - begin)),
          ring_segments(offsets)};
}

/// What is wrong with polygons, one by one.
class Refusals {
 public:
  explicit Refusals(const std::string& name) : name_(name) {}
  void add(std::size_t polygon, std::int32_t feature, const std::string& why) {
    constexpr std::size_t most_shown = 10;
    if (++count_ <= most_shown) text_ += fmt::format("\n  polygon {} of feature {}: {}", polygon, feature, why);
    if (count_ == most_shown + 1) text_ += "\n  ...";
  }
  void raise() const {
    if (count_ == 0) return;
    throw Failure(exit_file, fmt::format("{}: {} {} no inside; nothing was written:{}", name_, count_,
                                         count_ == 1 ? "polygon has" : "polygons have", text_));
  }

 private:
  std::string name_, text_;
  std::size_t count_ = 0;
};

int run(const PolygonsCommand& command) {
  if (command.input == "-" && command.format.empty())
    throw Failure(exit_usage, "standard input has no suffix; name its format: -f geojson");
  const auto outputs =
      plan_outputs(command.output.outputs, command.output.formats, io::region_write_formats(), command.input);
  ConstraintOptions constraints = constraint_options(command.segments);
  constraints.domain = Domain::even_odd;
  ProgressLine line(command.quiet);
  const std::string name = display_name(command.input, true);
  line.step(fmt::format("reading {}", name));
  const io::PolygonsFile file = io::read_polygons(command.input, command.format);

  Options options = library_options(command.device);
  options.statistics = StatisticsDetail::none;
  options.stop = interrupt_token();
  RegionResult result;
  result.region_name = "feature";
  Refusals refusals(name);
  for (std::size_t p = 0; p < file.size(); ++p) {
    if (p % 1024 == 0) line.step(fmt::format("polygon {} of {}", p, file.size()));
    check_interrupt();
    const Polygon polygon = polygon_of(file, p);
    Graph graph;
    graph.points.xy.assign(polygon.xy.begin(), polygon.xy.end());
    try {
      const ConstrainedTriangulation mesh =
          triangulate_constrained(graph.points.view(), polygon.segments, constraints, options);
      const auto first = static_cast<std::int32_t>(result.points.size());
      append_inside(result, mesh, first);
      result.region.resize(result.triangles.size() / 3);
      std::fill(result.region.end() - static_cast<std::ptrdiff_t>(mesh.number_inside()), result.region.end(),
                file.features[p]);
      const io::PointSet points = points_of(graph, mesh);
      result.points.xy.insert(result.points.xy.end(), points.xy.begin(), points.xy.end());
      note_rounding(mesh, fmt::format("{}, polygon {}", name, p), command.quiet);
    } catch (const Error&) {
      refusals.add(p, file.features[p], explain_graph_error(graph.points.view(), polygon.segments));
    }
  }
  line.clear();
  refusals.raise();
  write_regions(outputs, command.output, result, line);

  std::string summary = fmt::format("features    {}\npolygons    {}\nrings       {}\npoints      {}\ntriangles   {}\n",
                                    file.number_of_features, file.size(), file.ring_offsets.size() - 1,
                                    result.points.size(), result.triangles.size() / 3);
  if (file.other_geometries != 0) summary += fmt::format("left out    {} points and lines\n", file.other_geometries);
  if (outputs.empty()) {
    print(summary);
  } else if (!command.quiet) {
    say(summary);
  }
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
  command->add_flag("-q,--quiet", options->quiet, "nothing on standard error but errors");
  command->footer(
      "Inside is what is behind an odd number of rings, so holes are left out. Polygons do not know of each other: "
      "where\n"
      "they share a border, its points are there twice. Each triangle has the number of its feature, from 0: as "
      "attribute\n"
      "'feature' in .ply, .vtu and .geojson, as column in .ele. If a polygon has no inside, such as one that crosses "
      "itself,\n"
      "each of them is named, and nothing is written; with --crossing exact they have one.\n\n"
      "Examples:\n"
      "  cadt polygons countries.geojson -o countries.png -o triangles.geojson\n"
      "  cadt polygons parcels.json --crossing exact -o parcels.ply\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
