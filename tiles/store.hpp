// SPDX-License-Identifier: Apache-2.0
// The directory of a mesh in nodes (docs/scale.md describes it):
//
//     mesh.cadt/manifest.json            the tree; in the end also counts, sums, bases and hashes of all nodes
//     mesh.cadt/node-000017/points.npy   n x 2 f8     ids.npy        n u8     triangles.npy  m x 3 i4
//                           links.npy    k u8         neighbors.npy  m x 3 i4 duplicates.npy d x 2 u8
//     mesh.cadt/unfinished/node-000017/  node.json, open.npy, messages.npy, links.npy: for --resume; removed in the end
//     mesh.cadt/run.json                 times and names: not part of the mesh, and left out of comparisons
//
// All but run.json are equal, byte by byte, for every back end and number of devices, threads and processes.
#pragma once

#include "tiles/node.hpp"
#include "tiles/tree.hpp"

#include <array>
#include <cstdint>
#include <optional>
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
};

struct FileRecord {
  std::string name;
  std::uint64_t bytes = 0;
  std::string hash;  ///< XXH3-128, 32 hexadecimal digits
  friend bool operator==(const FileRecord&, const FileRecord&) = default;
};

struct NodeRecord {
  std::uint64_t points = 0, triangles = 0, links = 0, duplicates = 0, open = 0;
  NodeSums sums;
  std::vector<FileRecord> files;  ///< of the node's folder; links.npy in the complete manifest alone
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

/// Writes the directory. Several processes may write different nodes of one directory on a shared file system, if one
/// of them begins (create) before the others open it, and one completes it after all have written.
class Store {
 public:
  enum class Start {
    create,  ///< a new directory. \throws ResumeError if there is one
    resume,  ///< that of an earlier run with the same plan, or a new one
    join     ///< another process has begun it
  };
  /// \throws io::FileError with the name of what cannot be written; ResumeError
  Store(std::string path, const Plan& plan, Start start);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
  /// Whether it is complete already: nothing is left to be done.
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  /// Whether the node is there and its files are what its hashes say. Reads them. Thread-safe.
  [[nodiscard]] bool is_valid(std::uint32_t node) const;
  /// Of a valid node. \throws io::FileError
  [[nodiscard]] Open read_open(std::uint32_t node) const;
  [[nodiscard]] NodeRecord read_record(std::uint32_t node) const;

  /// A node is there as a whole or not at all: temporary folder, sync, rename. Thread-safe for different nodes.
  /// \throws io::FileError, also for a full disk
  void write(const NodeData& node) const;

  /// All nodes are there: completes the links from the messages, adds up, checks (require_complete), writes the
  /// manifest and removes what was for resuming. O(open vertices of all nodes). \throws io::FileError, InternalError
  Manifest finish();

 private:
  void begin();
  [[nodiscard]] std::string node_folder(std::uint32_t node) const;
  [[nodiscard]] std::string unfinished_folder(std::uint32_t node) const;
  void complete_links(std::vector<NodeRecord>& records) const;

  std::string path_;
  Plan plan_;
  bool complete_ = false;
};

/// "node-000017"
[[nodiscard]] std::string node_name(std::uint32_t node);
/// \throws io::FileError for a file that is none; ResumeError for another format version
[[nodiscard]] Manifest read_manifest(const std::string& directory);
/// Bytes that the directory of so many points takes at most, with what is there while it is written.
[[nodiscard]] std::uint64_t directory_bytes(std::uint64_t points) noexcept;

}  // namespace cadt::tiles
