// SPDX-License-Identifier: Apache-2.0
#include "tiles/manifest.hpp"

#include <cadt/io/errors.hpp>

#include "tiles/hash.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace cadt::tiles {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "cadt mesh in tiles";
constexpr const char* sample_rule = "splitmix64 of the index, 2^20 points expected; all of smaller sets";

Json side(double v) { return std::isinf(v) ? Json(nullptr) : Json(v); }

double side(const Json& v, double outside) { return v.is_null() ? outside : v.get<double>(); }

Json json_of(const NodeSums& sums) {
  return {{"points", sums.points},
          {"distinct", sums.distinct},
          {"triangles", sums.triangles},
          {"hull_edges", sums.hull_edges},
          {"certified_edges", sums.certified_edges},
          {"dimension", sums.dimension},
          {"hash", sums.hash.to_string()}};
}

NodeSums sums_of(const Json& json) {
  NodeSums sums;
  sums.points = json.at("points");
  sums.distinct = json.at("distinct");
  sums.triangles = json.at("triangles");
  sums.hull_edges = json.at("hull_edges");
  sums.certified_edges = json.at("certified_edges");
  sums.dimension = json.at("dimension");
  sums.hash = hash_from_string(json.at("hash"));
  return sums;
}

Json json_of(const NodeRecord& record) {
  Json files = Json::array();
  for (const FileRecord& file : record.files)
    files.push_back({{"name", file.name}, {"bytes", file.bytes}, {"xxh3", file.hash}});
  return {{"points", record.points}, {"triangles", record.triangles},   {"links", record.links},
          {"open", record.open},     {"duplicates", record.duplicates}, {"sums", json_of(record.sums)},
          {"files", files}};
}

NodeRecord record_of(const Json& json) {
  NodeRecord record;
  record.points = json.at("points");
  record.triangles = json.at("triangles");
  record.links = json.at("links");
  record.open = json.at("open");
  record.duplicates = json.at("duplicates");
  record.sums = sums_of(json.at("sums"));
  for (const Json& file : json.at("files"))
    record.files.push_back({file.at("name"), file.at("bytes"), file.at("xxh3")});
  return record;
}

Json json_of(const TileTree& tree) {
  Json nodes = Json::array();
  for (const TreeNode& node : tree.nodes()) {
    const TileBox& box = node.box;
    Json json{{"box", {side(box.min_x), side(box.min_y), side(box.max_x), side(box.max_y)}}, {"points", node.points}};
    if (!node.is_leaf()) json["children"] = {node.left, node.right};
    nodes.push_back(std::move(json));
  }
  return nodes;
}

TileTree tree_of(const Json& json) {
  constexpr double outside = std::numeric_limits<double>::infinity();
  std::vector<TreeNode> nodes;
  for (const Json& from : json) {
    TreeNode node;
    const Json& box = from.at("box");
    node.box = {side(box.at(0), -outside), side(box.at(1), -outside), side(box.at(2), outside),
                side(box.at(3), outside)};
    node.points = from.at("points");
    if (from.contains("children")) {
      node.left = from["children"].at(0), node.right = from["children"].at(1);
      for (const std::uint32_t child : {node.left, node.right}) {
        if (child >= nodes.size()) throw Error("not a tree of tiles: a child comes after its parent");
        nodes[child].parent = static_cast<std::uint32_t>(nodes.size());
      }
    }
    nodes.push_back(node);
  }
  return TileTree(std::move(nodes));
}

Manifest manifest_of(const Json& json, const std::string& path) {
  if (json.at("format") != format_name) throw Error("is not the manifest of a mesh in tiles");
  if (json.at("version") != format_version) {
    throw ResumeError(path + ": format version " + json.at("version").dump() + ", and this program knows version " +
                      std::to_string(format_version) + ": use the version of cadt that made it");
  }
  Manifest manifest;
  manifest.plan.tile_points = json.at("tile_points");
  manifest.plan.first_id = json.at("first_id");
  manifest.plan.content = hash_from_string(json.at("content"));
  manifest.plan.tree = tree_of(json.at("tree"));
  manifest.complete = json.at("complete");
  if (!manifest.complete) return manifest;
  for (const Json& node : json.at("nodes")) {
    manifest.nodes.push_back(record_of(node));
    manifest.base.push_back(node.at("base"));
  }
  if (manifest.nodes.size() != manifest.plan.tree.size())
    throw Error("the number of nodes differs from that of the tree");
  manifest.whole = sums_of(json.at("whole"));
  manifest.hash = hash_from_string(json.at("hash"));
  return manifest;
}

/// Whatever is wrong with the text is an error of the file.
template <class Parse>
auto parsed(const std::string& text, const std::string& path, const Parse& parse) {
  try {
    return parse(Json::parse(text));
  } catch (const ResumeError&) {
    throw;
  } catch (const Json::exception& e) {
    throw io::FileError(path, 0, std::string("is damaged: ") + e.what());
  } catch (const Error& e) {
    throw io::FileError(path, 0, e.what());
  }
}

}  // namespace

std::string node_name(std::uint32_t node) {
  const std::string digits = std::to_string(node);
  return "node-" + std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

std::string to_json(const Manifest& manifest) {
  Json json{{"format", format_name},
            {"version", format_version},
            {"complete", manifest.complete},
            {"points", manifest.plan.tree.number_of_points()},
            {"first_id", manifest.plan.first_id},
            {"content", manifest.plan.content.to_string()},
            {"tile_points", manifest.plan.tile_points},
            {"sample", sample_rule}};
  if (manifest.complete) {
    json["whole"] = json_of(manifest.whole);
    json["hash"] = manifest.hash.to_string();
  }
  json["tree"] = json_of(manifest.plan.tree);
  if (manifest.complete) {
    Json nodes = Json::array();
    for (std::size_t i = 0; i < manifest.nodes.size(); ++i) {
      Json node{{"base", manifest.base[i]}};
      node.update(json_of(manifest.nodes[i]));
      nodes.push_back(std::move(node));
    }
    json["nodes"] = std::move(nodes);
  }
  return json.dump(1) + '\n';
}

std::string to_json(const NodeRecord& record) {
  const Json json = json_of(record);
  const std::string text = json.dump();
  return Json{{"record", json}, {"xxh3", hash_bytes(text.data(), text.size()).to_string()}}.dump(1) + '\n';
}

Manifest manifest_from_json(const std::string& text, const std::string& path) {
  return parsed(text, path, [&](const Json& json) { return manifest_of(json, path); });
}

NodeRecord record_from_json(const std::string& text, const std::string& path) {
  return parsed(text, path, [](const Json& json) {
    const std::string record = json.at("record").dump();
    if (json.at("xxh3") != hash_bytes(record.data(), record.size()).to_string())
      throw Error("is damaged: its hash differs");
    return record_of(json.at("record"));
  });
}

Manifest read_manifest(const std::string& directory) {
  const std::string path = directory + "/manifest.json";
  return manifest_from_json(read_text(path), path);
}

}  // namespace cadt::tiles
