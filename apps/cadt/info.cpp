// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "failure.hpp"
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

std::string line(std::string_view key, std::string_view value) { return fmt::format("{:<12}{}\n", key, value); }

std::string info_text(const Info& info) {
  std::string text = line("format", info.format);
  text += line("points", std::to_string(info.points));
  text += line("distinct", std::to_string(info.distinct));
  text += line("duplicates", std::to_string(info.points - info.distinct));
  if (info.points > 0) {
    text += line("x", fmt::format("{} to {}", info.x.low, info.x.high));
    text += line("y", fmt::format("{} to {}", info.y.low, info.y.high));
  }
  text += line("exponents", info.exponents ? fmt::format("2^{} to 2^{}", info.exponents->first, info.exponents->second)
                                           : std::string("none, all coordinates are zero"));
  text +=
      line("heights", info.heights ? fmt::format("{} to {}", info.height.low, info.height.high) : std::string("none"));
  return text;
}

std::string info_json(const Info& info, const std::string& path) {
  using Json = nlohmann::ordered_json;
  const auto range = [](const Range& r, bool there) { return there ? Json{r.low, r.high} : Json(nullptr); };
  const Json json{{"schema", 1},
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
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

struct InfoCommand {
  InputOptions input;
  bool json = false;
};

}  // namespace

void add_info(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("info", "say what a point file holds");
  const auto options = std::make_shared<InfoCommand>();
  add_input_options(*command, options->input, "FILE", "file with points, or directory of cadt tiles");
  command->add_flag("--json", options->json, "as JSON");
  command->footer(
      "Prints format, points, distinct points, duplicates, box, the exponents of the smallest and the largest "
      "coordinate\n"
      "(powers of two; a wide range costs time), and whether there are heights.\n\n"
      "Example:\n"
      "  cadt info survey.csv --columns lon,lat,depth\n");
  command->callback([options, &chosen] {
    chosen = [options] {
      if (is_mesh_directory(options->input.path)) return print_directory(options->input.path, options->json);
      const Info info = inspect(read_input(options->input));
      print(options->json ? info_json(info, options->input.path) : info_text(info));
      return int{exit_done};
    };
  });
}

}  // namespace cadt::cli
