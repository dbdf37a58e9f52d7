// SPDX-License-Identifier: Apache-2.0
#include "graph.hpp"

#include "failure.hpp"
#include "interrupt.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <string_view>
#include <utility>

namespace cadt::cli {
namespace {

constexpr std::pair<const char*, Domain> domains[] = {{"hull", Domain::hull},         {"outer", Domain::outer},
                                                      {"even_odd", Domain::even_odd}, {"nonzero", Domain::nonzero},
                                                      {"layers", Domain::layers},     {"seeds", Domain::seeds}};

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::string format_of(const std::string& path, const std::string& asked) {
  if (!asked.empty()) return lower(asked);
  const std::string suffix = lower(std::filesystem::path(path).extension().string());
  return suffix.empty() ? suffix : suffix.substr(1);
}

/// Whether the input has segments of its own: its format is one of segments, and none of points.
bool is_graph(const InputOptions& input) {
  const std::string format = format_of(input.path, input.format);
  return contains(io::segment_read_formats(), format) && !contains(io::point_read_formats(), format);
}

/// The width of "grid=0.25".
double grid_of(const std::string& text) {
  const double width = parse_number(std::string_view(text).substr(std::string_view("grid=").size())).value_or(0);
  if (!(width > 0)) {
    throw Failure(exit_usage,
                  fmt::format("--crossing {}: the width of a grid is above 0, for example grid=0.001", text));
  }
  return width;
}

std::string place(PointsView points, std::int32_t v) {
  const auto at = static_cast<std::size_t>(v);
  return fmt::format("({}, {})", points.x(at), points.y(at));
}

void append(Graph& graph, Graph&& more, bool same_file, const std::string& name, bool quiet) {
  graph.holes = std::move(more.holes);
  graph.regions = std::move(more.regions);
  graph.segments = std::move(more.segments);
  graph.crs = std::move(more.crs);
  if (same_file) {
    graph.points = std::move(more.points);
    return;
  }
  if (graph.points.xy == more.points.xy) {
    auto& own = graph.points.height;
    if (own.empty()) {
      own = std::move(more.points.height);
    } else if (!more.points.height.empty() && own != more.points.height && !quiet) {
      say(fmt::format("cadt: warning: {} has other heights at the same points: those of the input are taken\n", name));
    }
    return;
  }
  constexpr std::size_t most = 0x7fffffff;
  const std::size_t before = graph.points.size();
  if (before + more.points.size() > most) throw LimitError("too many points", before + more.points.size(), most);
  for (Segment& segment : graph.segments) {
    for (std::int32_t& v : segment) v += static_cast<std::int32_t>(before);
  }
  graph.own_points = before;
  auto& height = graph.points.height;
  if (height.empty() != more.points.height.empty()) {
    if (!quiet) note_no_heights(height.empty() ? "the input" : name, !height.empty() && more.some_heights);
    height.clear();
  } else {
    height.insert(height.end(), more.points.height.begin(), more.points.height.end());
  }
  graph.points.xy.insert(graph.points.xy.end(), more.points.xy.begin(), more.points.xy.end());
}

}  // namespace

void add_crossing_option(CLI::App& command, SegmentOptions& o) {
  command
      .add_option("--crossing", o.crossing,
                  "segments that cross: error (default: they are named), exact (a vertex where they cross; only its "
                  "coordinates are rounded) or grid=G (all points move to a grid of that width)")
      ->type_name("RULE");
}

void add_segments_option(CLI::App& command, SegmentOptions& o) {
  command
      .add_option("--segments", o.file,
                  "segments that have to be edges, such as breaklines, with their points: " +
                      join(io::segment_read_formats(), " "))
      ->type_name("FILE");
}

void add_segment_options(CLI::App& command, SegmentOptions& o) {
  add_segments_option(command, o);
  std::vector<std::string> names;
  for (const auto& [name, domain] : domains) names.emplace_back(name);
  command
      .add_option("--domain", o.domain,
                  "with segments, which triangles are written: hull (default: all), outer (what segments enclose), "
                  "even_odd, nonzero (as in pictures), layers (odd depth; loose ends do no harm) or seeds (all but "
                  "holes, as Triangle)")
      ->type_name("RULE")
      ->check(CLI::IsMember(names).description(""));
  add_crossing_option(command, o);
}

bool has_segments(const InputOptions& input, const SegmentOptions& options) {
  const bool own = is_graph(input);
  if (own && !options.file.empty()) {
    throw Failure(exit_usage, fmt::format("{} has segments of its own: leave --segments out, or give the points alone",
                                          display_name(input.path, true)));
  }
  if (own && (!input.columns.empty() || input.projection != "xy"))
    throw Failure(exit_usage, "--columns and --project are for files of points: leave them out");
  if (!options.file.empty() && input.projection != "xy")
    throw Failure(exit_usage, "--project: of the points of --segments x and y are taken: leave it out");
  const bool any = own || !options.file.empty();
  if (!any && (!options.domain.empty() || !options.crossing.empty())) {
    throw Failure(exit_usage, fmt::format("{} is about segments, and there are none: name a file with --segments",
                                          options.domain.empty() ? "--crossing" : "--domain"));
  }
  static_cast<void>(constraint_options(options));
  return any;
}

ConstraintOptions constraint_options(const SegmentOptions& options, const Graph& graph) {
  ConstraintOptions result;
  for (const auto& [name, domain] : domains) {
    if (options.domain == name) result.domain = domain;
  }
  if (result.domain == Domain::seeds) {
    result.holes = graph.holes;
    result.regions = graph.regions;
  }
  if (options.crossing == "exact") {
    result.crossing = Crossing::exact;
  } else if (options.crossing.starts_with("grid=")) {
    result.crossing = Crossing::grid;
    result.grid = grid_of(options.crossing);
  } else if (!options.crossing.empty() && options.crossing != "error") {
    throw Failure(exit_usage, fmt::format("--crossing {}: there are error, exact and grid=G, for example grid=0.001",
                                          options.crossing));
  }
  return result;
}

std::string name_of(const InputOptions& input, const SegmentOptions& options) {
  const std::string points = display_name(input.path, true);
  if (options.file.empty() || options.file == input.path) return points;
  return points + " with " + display_name(options.file, true);
}

void note_no_heights(const std::string& name, bool some) {
  say(fmt::format("cadt: heights are left out: {} has none{}\n", name, some ? " at some points" : ""));
}

void note_holes(const Graph& graph, const SegmentOptions& options) {
  if (graph.holes.empty() || options.domain == "seeds") return;
  say(fmt::format("cadt: the file has holes, {}: --domain seeds uses them\n", graph.holes.size()));
}

void note_far_seeds(PointsView points, const ConstrainedTriangulation& mesh,
                    std::span<const std::array<double, 2>> holes, std::span<const Region> regions,
                    const std::string& name) {
  if (const auto moved = mesh.moved_points(); !moved.empty()) points = PointsView(moved);
  constexpr double most = std::numeric_limits<double>::max();
  std::array<double, 2> low = {most, most}, high = {-most, -most};
  for (std::size_t i = 0; i < points.size(); ++i) {
    low = {std::min(low[0], points.x(i)), std::min(low[1], points.y(i))};
    high = {std::max(high[0], points.x(i)), std::max(high[1], points.y(i))};
  }
  const auto note = [&](const char* what, std::size_t count, const auto& place) {
    std::size_t far = 0, first = 0;
    for (std::size_t i = count; i-- > 0;) {
      const auto [x, y] = place(i);
      if (x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1]) continue;
      ++far;
      first = i;
    }
    if (far == 0) return;
    const auto [x, y] = place(first);
    say(fmt::format(
        "cadt: warning: {}: {} of its {} {} outside of the points' extent, and without effect; the first is at "
        "{} {}\n",
        name, far, what, far == 1 ? "is" : "are", x, y));
  };
  note("holes", holes.size(), [&](std::size_t i) { return holes[i]; });
  note("regions", regions.size(), [&](std::size_t i) { return std::array{regions[i].x, regions[i].y}; });
}

void note_other_heights(const io::PointSet& points, std::size_t own_points, const Triangulation& mesh,
                        const std::string& name) {
  const auto& height = points.height;
  if (height.empty()) return;
  std::size_t others = 0, first = 0;
  for (const auto& [point, representative] : mesh.duplicates()) {
    const auto i = static_cast<std::size_t>(point), of = static_cast<std::size_t>(representative);
    if (of >= own_points || i < own_points || height[i] == height[of]) continue;
    if (others++ == 0) first = i;
  }
  if (others == 0) return;
  say(fmt::format(
      "cadt: warning: {}: {} of its points have other heights than those of the input at the same places, the "
      "first at {} {}: those of the input are taken\n",
      name, others, points.xy[2 * first], points.xy[2 * first + 1]));
}

Graph graph_of(io::SegmentsFile file) {
  Graph graph;
  graph.some_heights = file.some_heights;
  graph.points.xy = std::move(file.xy);
  if (file.attributes_per_point == 1) graph.points.height = std::move(file.attributes);
  graph.points.format = file.format;
  graph.segments = std::move(file.segments);
  graph.holes = std::move(file.holes);
  graph.regions = std::move(file.regions);
  graph.crs = std::move(file.crs);
  return graph;
}

Graph read_graph(const InputOptions& input, const SegmentOptions& options, bool quiet) {
  Graph graph;
  if (is_graph(input)) {
    graph = graph_of(io::read_segments(input.path, lower(input.format)));
    if (graph.some_heights && !quiet) note_no_heights(display_name(input.path, true), true);
  } else {
    if (options.file == "-") throw Failure(exit_usage, "--segments: standard input is for IN; name a file");
    require_format(options.file, "", io::segment_read_formats(), "");
    std::error_code code;
    const bool same_file = input.path != "-" && std::filesystem::equivalent(input.path, options.file, code);
    if (same_file && !(input.columns.empty() && input.format.empty()))
      throw Failure(exit_usage, fmt::format("{} is read as a file of segments: leave --columns and --from out",
                                            display_name(input.path, true)));
    if (!same_file) graph.points = read_input(input);
    append(graph, graph_of(io::read_segments(options.file)), same_file, options.file, quiet);
  }
  return graph;
}

std::string name_crossings(const CrossingError& error, std::string_view how, PointsView points,
                           std::span<const Segment> segments) {
  const auto& pairs = error.pairs();
  std::string text = pairs.size() == 1 ? fmt::format("1 pair of segments crosses{}:", how)
                                       : fmt::format("{} pairs of segments cross{}:", pairs.size(), how);
  constexpr std::size_t most_shown = 5;
  for (std::size_t i = 0; i < std::min(pairs.size(), most_shown); ++i) {
    const auto describe = [&](std::int32_t s) {
      const Segment& ends = segments[static_cast<std::size_t>(s)];
      return fmt::format("{} {} - {}", s, place(points, ends[0]), place(points, ends[1]));
    };
    text += fmt::format("\n    {}  and  {}", describe(pairs[i][0]), describe(pairs[i][1]));
  }
  if (pairs.size() > most_shown) text += "\n    ...";
  return text + "\n  (segments count from 0) ";
}

std::string explain_graph_error(PointsView points, std::span<const Segment> segments) {
  try {
    throw;
  } catch (const CrossingError& e) {
    return name_crossings(e, "", points, segments) +
           "--crossing exact makes a vertex of each crossing, --crossing grid=G moves all "
           "points to a grid";
  } catch (const DomainError& e) {
    return fmt::format(
        "the segments do not close at point {} {}, counted from 0: {}; --domain layers and --domain outer take "
        "segments with loose ends",
        e.vertex(), place(points, e.vertex()), e.what());
  } catch (const OptionError& e) {
    if (e.option() != "grid") throw;
    const std::string_view what = e.what();  // "ConstraintOptions::grid: ..."
    throw Failure(exit_usage, fmt::format("--crossing {}", what.substr(what.find(e.option()))));
  } catch (const InputError& e) {
    return fmt::format("point {} (counted from 0): {}", e.index(), e.what());
  }
}

ConstrainedTriangulation triangulate_graph(PointsView points, std::span<const Segment> segments,
                                           const std::string& name, const ConstraintOptions& constraints,
                                           const Options& options) {
  try {
    const InPhase phase(Phase::cooperative);
    return triangulate_constrained(points, segments, constraints, options);
  } catch (const Error&) {
    throw Failure(exit_file, fmt::format("{}: {}", name, explain_graph_error(points, segments)));
  }
}

io::PointSet points_of(const Graph& graph, const ConstrainedTriangulation& mesh) {
  io::PointSet result;
  const auto moved = mesh.moved_points(), added = mesh.added_points();
  result.xy.assign(graph.points.xy.begin(), graph.points.xy.end());
  if (!moved.empty()) result.xy.assign(moved.begin(), moved.end());
  result.xy.insert(result.xy.end(), added.begin(), added.end());
  if (graph.points.height.empty()) return result;
  result.height = values_at_crossings(graph.points.view(), graph.points.height, 1, mesh);
  return result;
}

void note_rounding(const ConstrainedTriangulation& mesh, const std::string& name, bool quiet) {
  if (mesh.rounded_valid() || quiet) return;
  say(fmt::format(
      "cadt: warning: {}: crossings are too close to others for rounded coordinates, so that some triangles are turned "
      "over or flat in the output; --crossing grid=G keeps them apart\n",
      name));
}

}  // namespace cadt::cli
