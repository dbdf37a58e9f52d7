// SPDX-License-Identifier: Apache-2.0
#include "tiles/report.hpp"

#include <cadt/version.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace cadt::tiles {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const NodeReport& node, const TreeNode& where, std::uint32_t number) {
  Json json{{"node", number},        {"kind", where.is_leaf() ? "leaf" : "join"},
            {"points", node.points}, {"triangles", node.triangles},
            {"open", node.open},     {"resumed", node.resumed}};
  if (node.resumed) return json;
  json["device"] = node.device;
  const NodeTimes& t = node.times;
  json["seconds"] = {
      {"read", t.read}, {"compute", t.compute}, {"consume", t.consume}, {"download", t.download}, {"write", t.write}};
  json["phases"] = Json::object();
  for (const auto& [name, ms] : node.statistics.milliseconds) json["phases"][name] = ms;
  return json;
}

std::string number(double v) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", v);
  return text.data();
}

/// What there is to be drawn: finite sides, and some space beyond them.
TileBox drawn_box(const TileTree& tree) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  TileBox box{infinite, infinite, -infinite, -infinite};
  for (const TreeNode& node : tree.nodes()) {
    for (const double x : {node.box.min_x, node.box.max_x})
      if (std::isfinite(x)) box.min_x = std::min(box.min_x, x), box.max_x = std::max(box.max_x, x);
    for (const double y : {node.box.min_y, node.box.max_y})
      if (std::isfinite(y)) box.min_y = std::min(box.min_y, y), box.max_y = std::max(box.max_y, y);
  }
  if (box.min_x > box.max_x) box.min_x = box.max_x = 0;
  if (box.min_y > box.max_y) box.min_y = box.max_y = 0;
  const double width = box.max_x - box.min_x, height = box.max_y - box.min_y;
  const double beyond = width > 0 || height > 0 ? std::max(width, height) / 4 : 1;
  return {box.min_x - beyond, box.min_y - beyond, box.max_x + beyond, box.max_y + beyond};
}

}  // namespace

std::string report_json(const RunResult& result, const RunOptions& options, std::span<const std::string> inputs) {
  const TileTree& tree = result.plan.tree;
  Json json;
  json["schema"] = 1;
  json["cadt"] = CADT_VERSION;
  json["inputs"] = Json(std::vector<std::string>(inputs.begin(), inputs.end()));
  json["output"] = options.output.empty() ? Json(nullptr) : Json(options.output);
  json["tile_points"] = options.tile_points;
  json["mesh"] = {{"points", tree.number_of_points()},
                  {"distinct", result.whole.distinct},
                  {"duplicates", result.whole.points - result.whole.distinct},
                  {"triangles", result.whole.triangles},
                  {"hull", result.whole.hull_edges},
                  {"dimension", result.whole.dimension},
                  {"certified_edges", result.whole.certified_edges},
                  {"hash", result.hash.to_string()}};
  json["tree"] = {{"leaves", tree.leaves().size()}, {"nodes", tree.size()}, {"most_open", result.most_open}};
  json["seconds"] = {{"sample", result.sample_seconds},
                     {"shuffle", result.shuffle_seconds},
                     {"nodes", result.nodes_seconds},
                     {"links", result.links_seconds}};
  json["scratch_used"] = result.scratch_used;
  json["devices"] = Json::array();
  for (const std::string& device : result.devices) json["devices"].push_back(device);
  json["nodes"] = Json::array();
  for (std::uint32_t i = 0; i < tree.size(); ++i) json["nodes"].push_back(json_of(result.nodes[i], tree.node(i), i));
  // Names of files and devices need not be UTF-8; JSON must be.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string tree_svg(const TileTree& tree, std::span<const double> seconds) {
  constexpr double width = 1000;
  const TileBox all = drawn_box(tree);
  const double scale = width / (all.max_x - all.min_x), height = (all.max_y - all.min_y) * scale;
  double most = 0;
  const auto cost = [&](std::uint32_t leaf) {
    const auto points = static_cast<double>(std::max<std::uint64_t>(tree.node(leaf).points, 1));
    return seconds.empty() ? points : seconds[leaf] / points;
  };
  for (const std::uint32_t leaf : tree.leaves()) most = std::max(most, cost(leaf));
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(width) + " " + number(height) +
                    "\" font-family=\"sans-serif\" text-anchor=\"middle\">\n";
  for (const std::uint32_t leaf : tree.leaves()) {
    const TileBox& box = tree.node(leaf).box;
    const double x0 = (std::max(box.min_x, all.min_x) - all.min_x) * scale,
                 x1 = (std::min(box.max_x, all.max_x) - all.min_x) * scale,
                 y0 = (all.max_y - std::min(box.max_y, all.max_y)) * scale,
                 y1 = (all.max_y - std::max(box.min_y, all.min_y)) * scale;
    const double share = most > 0 ? cost(leaf) / most : 0;
    const auto shade = static_cast<int>(255 - 155 * share);
    svg += "<rect x=\"" + number(x0) + "\" y=\"" + number(y0) + "\" width=\"" + number(x1 - x0) + "\" height=\"" +
           number(y1 - y0) + "\" fill=\"rgb(" + std::to_string(shade) + "," + std::to_string(shade) +
           ",255)\" stroke=\"#333\"><title>node " + std::to_string(leaf) + ": " +
           std::to_string(tree.node(leaf).points) + " points" +
           (seconds.empty() ? std::string() : ", " + number(1000 * seconds[leaf]) + " ms") + "</title></rect>\n";
    const double size = std::min((x1 - x0) / 8, (y1 - y0) / 4);
    if (size < 3) continue;  // the title tells it
    svg += "<text x=\"" + number((x0 + x1) / 2) + "\" y=\"" + number((y0 + y1) / 2) + "\" font-size=\"" +
           number(std::min(size, 24.0)) + "\">" + std::to_string(leaf) +
           (seconds.empty() ? std::string() : ": " + number(1000 * seconds[leaf]) + " ms") + "</text>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace cadt::tiles
