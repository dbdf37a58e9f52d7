// SPDX-License-Identifier: Apache-2.0
// The nodes of a tree on the devices of one process: a thread reads leaves ahead, two threads for each device compute,
// and others write what is finished.
#pragma once

#include "tiles/node.hpp"
#include "tiles/store.hpp"
#include "tiles/tree.hpp"

#include <cadt/triangulator.hpp>

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace cadt::tiles {

/// What one device computes with at the same time: joins are small and would keep it waiting.
struct Triangulators {
  Triangulator leaves, joins;
};

struct Job {
  Job(const TileTree& tree_of_nodes, std::vector<bool> done_before)
      : tree(tree_of_nodes), done(std::move(done_before)) {}

  const TileTree& tree;
  std::vector<bool> done;                              ///< by node: nothing to be done
  std::vector<bool> awaited = {};                      ///< by node: made elsewhere, and delivered; empty: none
  std::function<LeafPoints(std::uint32_t)> read_leaf;  ///< on the reading thread, leaves ascending
  std::function<Open(std::uint32_t)> read_open;        ///< of nodes that are done; on any thread
  ComputeOptions compute;
  bool keep_open = false;                              ///< NodeData::open goes to `finished` too
  std::function<void(const NodeData&)> computed = {};  ///< of each node, at once; on the threads of the devices
  /// Of each node that was computed, on one of the writing threads; different nodes at the same time. May be empty.
  std::function<void(NodeData&)> write = {};
  unsigned writers = 1;
  /// After it, one call at a time.
  std::function<void(unsigned device, NodeData&&)> finished;
  std::function<void(std::uint32_t nodes_done, std::uint64_t points_done)> progress;
  cadt::stop_token stop;
};

class Schedule {
 public:
  Schedule(std::vector<Triangulators>& devices, const Job& job);
  ~Schedule();
  Schedule(const Schedule&) = delete;
  Schedule& operator=(const Schedule&) = delete;
  /// As run_nodes, and returns when what is awaited was delivered, too.
  void run();
  /// What is open of a node that was awaited. Thread-safe.
  void deliver(std::uint32_t node, Open&& open);
  /// Ends run() with this error unless it has one. Thread-safe.
  void fail(std::exception_ptr error);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

/// Returns when all nodes are done. Each device has a thread for leaves and one for joins; the ready node with the
/// lowest number comes first, so what waits for its sibling is little. In memory are, for each device, a leaf that is
/// computed and one that waits for a writer, one that each writer writes, and one leaf more than there are devices that
/// have been read. \throws the first
/// error of any thread, after all have ended
void run_nodes(std::vector<Triangulators>& devices, const Job& job);

}  // namespace cadt::tiles
