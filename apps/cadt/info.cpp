// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "failure.hpp"
#include "graph.hpp"
#include "input.hpp"
#include "mesh_directory.hpp"
#include "text.hpp"

#include <cadt/version.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cadt::cli {
namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

struct Info {
  std::string format;
  std::size_t points = 0, distinct = 0;
  Range x, y, height;
  std::optional<std::pair<int, int>> exponents;  // none if every coordinate is zero
  bool heights = false;
};

std::size_t count_distinct(const io::PointSet& points) {
  std::vector<std::pair<double, double>> sorted(points.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = {points.xy[2 * i], points.xy[2 * i + 1]};
  std::sort(sorted.begin(), sorted.end());  // compares -0.0 equal to 0.0, as the library does
  return static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

Info inspect(const io::PointSet& points) {
  Info info;
  info.format = points.format;
  info.points = points.size();
  info.distinct = count_distinct(points);
  info.heights = !points.height.empty();
  for (std::size_t i = 0; i < points.xy.size(); ++i) {
    const double value = points.xy[i];
    (i % 2 == 0 ? info.x : info.y).add(value);
    if (value == 0) continue;
    const int exponent = std::ilogb(value);
    if (!info.exponents) info.exponents = {exponent, exponent};
    info.exponents->first = std::min(info.exponents->first, exponent);
    info.exponents->second = std::max(info.exponents->second, exponent);
  }
  for (const double value : points.height) info.height.add(value);
  return info;
}

std::string info_text(const Info& info) {
  std::string text = key_line("format", info.format);
  text += key_line("points", std::to_string(info.points));
  text += key_line("distinct", std::to_string(info.distinct));
  text += key_line("duplicates", std::to_string(info.points - info.distinct));
  if (info.points > 0) {
    text += key_line("x", fmt::format("{} to {}", info.x.low, info.x.high));
    text += key_line("y", fmt::format("{} to {}", info.y.low, info.y.high));
  }
  text +=
      key_line("exponents", info.exponents ? fmt::format("2^{} to 2^{}", info.exponents->first, info.exponents->second)
                                           : std::string("none, all coordinates are zero"));
  text += key_line("heights",
                   info.heights ? fmt::format("{} to {}", info.height.low, info.height.high) : std::string("none"));
  return text;
}

/// What a file has beside its points.
struct GraphInfo {
  std::size_t segments = 0, zero_length = 0, holes = 0, regions = 0;
};

GraphInfo inspect_graph(const Graph& graph) {
  GraphInfo info{graph.segments.size(), 0, graph.holes.size(), graph.regions.size()};
  const auto& xy = graph.points.xy;
  for (const Segment& s : graph.segments) {
    const auto a = 2 * static_cast<std::size_t>(s[0]), b = 2 * static_cast<std::size_t>(s[1]);
    info.zero_length += xy[a] == xy[b] && xy[a + 1] == xy[b + 1] ? 1 : 0;
  }
  return info;
}

std::string graph_text(const GraphInfo& info) {
  std::string segments = std::to_string(info.segments);
  if (info.zero_length != 0) segments += fmt::format(", {} of them of zero length", info.zero_length);
  return key_line("segments", segments) + key_line("holes", std::to_string(info.holes)) +
         key_line("regions", std::to_string(info.regions));
}

std::string info_json(const Info& info, const GraphInfo* graph, const std::string& path) {
  using Json = nlohmann::ordered_json;
  const auto range = [](const Range& r, bool there) { return there ? Json{r.low, r.high} : Json(nullptr); };
  Json json{{"schema", 1},
            {"cadt", CADT_VERSION},
            {"file", path},
            {"format", info.format},
            {"points", info.points},
            {"distinct", info.distinct},
            {"duplicates", info.points - info.distinct},
            {"x", range(info.x, info.points > 0)},
            {"y", range(info.y, info.points > 0)},
            {"exponents", info.exponents ? Json{info.exponents->first, info.exponents->second} : Json(nullptr)},
            {"heights", range(info.height, info.heights)}};
  if (graph != nullptr) {
    json["segments"] = graph->segments;
    json["zero_length"] = graph->zero_length;
    json["holes"] = graph->holes;
    json["regions"] = graph->regions;
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

struct InfoCommand {
  InputOptions input;
  bool json = false;
};

int print_info(const InfoCommand& command) {
  const bool segments = has_segments(command.input, {});
  const Graph graph = segments ? read_graph(command.input, {.file = {}, .domain = "seeds", .crossing = {}}, true)
                               : Graph{io::read_points(command.input.path, read_options(command.input)), {}, {}, {}};
  const Info info = inspect(graph.points);
  const GraphInfo more = inspect_graph(graph);
  if (command.json) {
    print(info_json(info, segments ? &more : nullptr, command.input.path));
  } else {
    print(info_text(info) + (segments ? graph_text(more) : std::string()));
  }
  return exit_done;
}

}  // namespace

void add_info(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("info", "say what a file of points or segments, or a mesh in tiles, holds");
  const auto options = std::make_shared<InfoCommand>();
  add_input_options(*command, options->input, "FILE", "file with points or segments, or directory of cadt tiles", true);
  command->add_flag("--json", options->json, "as JSON");
  command->footer(
      "Prints format, points, distinct points, duplicates, box, the exponents of the smallest and the largest "
      "coordinate\n"
      "(powers of two; a wide range costs time), and whether there are heights; of a file with segments the numbers "
      "of\n"
      "segments, holes and regions, too.\n\n"
      "Example:\n"
      "  cadt info survey.csv --columns lon,lat,depth\n");
  command->callback([options, &chosen] {
    chosen = [options] {
      if (is_mesh_directory(options->input.path)) return print_directory(options->input.path, options->json);
      return print_info(*options);
    };
  });
}

}  // namespace cadt::cli
