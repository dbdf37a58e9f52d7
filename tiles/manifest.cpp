// SPDX-License-Identifier: Apache-2.0
#include "tiles/manifest.hpp"

#include <cadt/io/errors.hpp>

#include "tiles/hash.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace cadt::tiles {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "cadt mesh in tiles";
constexpr const char* sample_rule = "splitmix64 of the index, 2^20 points expected; all of smaller sets";

/// A whole number, as it is written: none that is negative, broken or too large.
template <class Number>
Number count_of(const Json& json) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > std::numeric_limits<Number>::max())
    throw Error("is damaged: " + json.dump() + " is no number of points, triangles, nodes or bytes");
  return json.get<Number>();
}

void require(bool holds, const char* what) {
  if (!holds) throw Error(std::string("is damaged: ") + what);
}

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
  sums.points = count_of<std::uint64_t>(json.at("points"));
  sums.distinct = count_of<std::uint64_t>(json.at("distinct"));
  sums.triangles = count_of<std::uint64_t>(json.at("triangles"));
  sums.hull_edges = count_of<std::uint64_t>(json.at("hull_edges"));
  sums.certified_edges = count_of<std::uint64_t>(json.at("certified_edges"));
  const Json& dimension = json.at("dimension");
  // 2^64 - 1 would equal -1.
  require(dimension.is_number_unsigned() ? dimension <= 2U : dimension == -1, "a dimension is from -1 to 2");
  sums.dimension = dimension;
  require(sums.dimension == 2 || sums.triangles == 0, "there are triangles, and the dimension is not 2");
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
  record.points = count_of<std::uint64_t>(json.at("points"));
  record.triangles = count_of<std::uint64_t>(json.at("triangles"));
  record.links = count_of<std::uint64_t>(json.at("links"));
  record.open = count_of<std::uint64_t>(json.at("open"));
  record.duplicates = count_of<std::uint64_t>(json.at("duplicates"));
  record.sums = sums_of(json.at("sums"));
  for (const Json& file : json.at("files"))
    record.files.push_back({file.at("name"), count_of<std::uint64_t>(file.at("bytes")), file.at("xxh3")});
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
    node.points = count_of<std::uint64_t>(from.at("points"));
    if (from.contains("children")) {
      node.left = count_of<std::uint32_t>(from["children"].at(0));
      node.right = count_of<std::uint32_t>(from["children"].at(1));
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
  manifest.plan.tile_points = count_of<std::uint64_t>(json.at("tile_points"));
  manifest.plan.first_id = count_of<std::uint64_t>(json.at("first_id"));
  manifest.plan.content = hash_from_string(json.at("content"));
  manifest.plan.tree = tree_of(json.at("tree"));
  require(count_of<std::uint64_t>(json.at("points")) == manifest.plan.tree.number_of_points(),
          "the number of points differs from that of the tree");
  manifest.complete = json.at("complete");
  if (!manifest.complete) return manifest;
  NodeSums sums;
  for (const Json& node : json.at("nodes")) {
    manifest.nodes.push_back(record_of(node));
    manifest.base.push_back(count_of<std::uint64_t>(node.at("base")));
    sums += manifest.nodes.back().sums;
  }
  require(manifest.nodes.size() == manifest.plan.tree.size(), "the number of nodes differs from that of the tree");
  for (std::uint32_t i = 0; i < manifest.nodes.size(); ++i)
    require(has_files(manifest.nodes[i], node_files(i)), "a node has not its files");
  manifest.whole = sums_of(json.at("whole"));
  manifest.hash = hash_from_string(json.at("hash"));
  require(sums == manifest.whole, "what it says of the mesh is not the sum of its nodes");
  require(hash_of(manifest.whole) == manifest.hash, "its hash of the mesh is not that of its sums");
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

std::vector<std::string> node_files(std::uint32_t node) {
  std::vector<std::string> names;
  for (const char* file : {"points", "ids", "triangles", "neighbors", "duplicates", "links"})
    names.push_back(node_name(node) + "/" + file + ".npy");
  return names;
}

bool has_files(const NodeRecord& record, const std::vector<std::string>& names) {
  return std::equal(record.files.begin(), record.files.end(), names.begin(), names.end(),
                    [](const FileRecord& file, const std::string& name) { return file.name == name; });
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
