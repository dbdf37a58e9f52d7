// SPDX-License-Identifier: Apache-2.0
// What a mesh directory says of itself, as JSON.
#pragma once

#include "tiles/files.hpp"
#include "tiles/tree.hpp"

#include <cadt/finalization.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace cadt::tiles {

inline constexpr int format_version = 1;

/// What makes a mesh what it is; known before any node is computed.
struct Plan {
  std::uint64_t tile_points = default_tile_points;
  std::uint64_t first_id = 0;
  Hash128 content;  ///< of the source: add_block_hash
  TileTree tree;
  friend bool operator==(const Plan&, const Plan&) = default;
};

struct NodeRecord {
  std::uint64_t points = 0, triangles = 0, links = 0, duplicates = 0, open = 0;
  NodeSums sums;
  /// Of the node: node_files(), but without links.npy and with what is for resuming before the manifest is complete.
  std::vector<FileRecord> files;
  friend bool operator==(const NodeRecord&, const NodeRecord&) = default;
};

struct Manifest {
  Plan plan;
  bool complete = false;
  // Of a complete one:
  std::vector<NodeRecord> nodes;
  std::vector<std::uint64_t> base;  ///< dense number of each node's first triangle
  NodeSums whole;
  Hash128 hash;  ///< Triangulation::hash of the whole mesh
};

/// Another source, tile size or format version than that of the directory that is to be resumed, or a directory that
/// is there already.
class ResumeError : public Error {
 public:
  using Error::Error;
};

[[nodiscard]] std::string to_json(const Manifest& manifest);
[[nodiscard]] std::string to_json(const NodeRecord& record);
/// `path` is for messages. \throws io::FileError for text that is none, or contradicts itself; ResumeError for another
/// format version
[[nodiscard]] Manifest manifest_from_json(const std::string& text, const std::string& path);
[[nodiscard]] NodeRecord record_from_json(const std::string& text, const std::string& path);
/// Of a directory.
[[nodiscard]] Manifest read_manifest(const std::string& directory);

/// Names of the files of a node of a complete mesh, in the order of their records.
[[nodiscard]] std::vector<std::string> node_files(std::uint32_t node);
/// Whether these, in this order, are the record's.
[[nodiscard]] bool has_files(const NodeRecord& record, const std::vector<std::string>& names);

/// "node-000017"
[[nodiscard]] std::string node_name(std::uint32_t node);

}  // namespace cadt::tiles
