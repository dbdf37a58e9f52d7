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

#include "tiles/files.hpp"
#include "tiles/manifest.hpp"
#include "tiles/node.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace cadt::tiles {

/// Writes the directory. Several processes may write different nodes of one directory on a shared file system, if one
/// of them begins (create) before the others open it, and one completes it after all have written.
class Store {
 public:
  enum class Start {
    create,  ///< a new directory. \throws ResumeError if there is one
    resume,  ///< that of an earlier run with the same plan, or a new one
    join     ///< another process of this run has begun it. \throws ResumeError if it is not that directory
  };
  /// All but join keep the directory for this store: another run that comes meanwhile is refused.
  /// \throws io::FileError with the name of what cannot be written; ResumeError
  Store(std::string path, const Plan& plan, Start start);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
  /// Whether it is complete already: nothing is left to be done.
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  /// Whether the node is there, with all of its files, and these are what its hashes say. Reads them. Thread-safe.
  [[nodiscard]] bool is_valid(std::uint32_t node) const;
  /// Of a valid node. \throws io::FileError
  [[nodiscard]] Open read_open(std::uint32_t node) const;
  [[nodiscard]] NodeRecord read_record(std::uint32_t node) const;

  /// A node is there as a whole or not at all: temporary folder, sync, rename. Large arrays are written at the same
  /// time by up to `threads` threads. Thread-safe for different nodes. \throws io::FileError, also for a full disk
  void write(const NodeData& node, unsigned threads = 1) const;

  /// All nodes are there: completes the links from the messages, adds up, checks (require_complete), writes the
  /// manifest and removes what was for resuming. O(open vertices of all nodes). \throws io::FileError, InternalError
  Manifest finish();

 private:
  void lock();
  void begin();
  void join() const;
  [[nodiscard]] std::string node_folder(std::uint32_t node) const;
  [[nodiscard]] std::string unfinished_folder(std::uint32_t node) const;
  void check_same_plan(const Manifest& found) const;
  void write_links(std::vector<NodeRecord>& records) const;

  std::string path_;
  Plan plan_;
  FolderLock lock_;
  bool complete_ = false;
};

/// What Store::Start::create will ask, before any work. \throws ResumeError, io::FileError
void check_new_directory(const std::string& path);
/// Calls complete(node, messages to it) for each node, ascending. \throws InternalError for a message to no node
void complete_links(std::vector<Link> messages, std::uint32_t nodes,
                    const std::function<void(std::uint32_t, std::span<const Link>)>& complete);
/// Completes the links of a node from all messages to it. \throws InternalError if a row is told twice or never
void apply_messages(std::uint32_t node, std::span<const Link> messages, std::span<TriangleId> links);
/// Bytes that the directory of so many points takes at most, with what is there while it is written.
[[nodiscard]] std::uint64_t directory_bytes(std::uint64_t points) noexcept;

}  // namespace cadt::tiles
