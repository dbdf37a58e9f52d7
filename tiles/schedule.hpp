// SPDX-License-Identifier: Apache-2.0
// The nodes of a tree on the devices of one process: a thread reads leaves ahead, a thread for each device computes,
// and a thread writes what is finished.
#pragma once

#include "tiles/node.hpp"
#include "tiles/store.hpp"
#include "tiles/tree.hpp"

#include <cadt/triangulator.hpp>

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace cadt::tiles {

struct Job {
  Job(const TileTree& tree_of_nodes, std::vector<bool> done_before)
      : tree(tree_of_nodes), done(std::move(done_before)) {}

  const TileTree& tree;
  std::vector<bool> done;                              ///< by node: nothing to be done
  std::function<LeafPoints(std::uint32_t)> read_leaf;  ///< on the reading thread, leaves ascending
  std::function<Open(std::uint32_t)> read_open;        ///< of nodes that are done; on any thread
  ComputeOptions compute;
  bool keep_open = false;  ///< NodeData::open goes to `finished` too
  /// On the writing thread, in the order in which nodes finish.
  std::function<void(unsigned device, NodeData&&)> finished;
  std::function<void(std::uint32_t nodes_done, std::uint64_t points_done)> progress;
  cadt::stop_token stop;
};

/// Returns when all nodes are done. On each device the ready node with the lowest number comes first, so what waits for
/// its sibling is little. In memory are, for each device, a leaf that is computed and one that is written, and one leaf
/// more than there are devices that have been read. \throws the first error of any thread, after all have ended
void run_nodes(std::vector<Triangulator>& devices, const Job& job);

}  // namespace cadt::tiles
