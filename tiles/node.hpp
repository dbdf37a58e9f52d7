// SPDX-License-Identifier: Apache-2.0
// A node of the tree from its points to its arrays in the memory of the host.
#pragma once

#include "tiles/shuffle.hpp"

#include <cadt/finalization.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace cadt::tiles {

/// A node as it finishes, for consumers. On the device until `part` is gone.
struct NodeView {
  std::uint32_t node = 0;
  const TileBox& box;
  bool leaf = true;
  std::span<const double> xy;          ///< of the node's points
  std::span<const std::uint64_t> ids;  ///< their input indices, ascending
  const FinishedNode& finished;        ///< its part is on the device; sums include its hash
};
/// Called on the thread of the device, before the node's memory there is freed. Calls for different nodes may run
/// concurrently if there are several devices.
using NodeConsumer = std::function<void(const NodeView&)>;

/// Seconds of a node's phases.
struct NodeTimes {
  double read = 0, compute = 0, download = 0, consume = 0, write = 0;
};

/// Everything of a node, on the host. Arrays as in cadt/finalization.hpp.
struct NodeData {
  std::uint32_t node = 0;
  Array<double> xy;
  Array<std::uint64_t> ids;
  Array<std::int32_t> triangles, neighbors;  ///< as of a Part
  std::vector<TriangleId> links;
  std::vector<Link> messages;
  std::vector<DuplicateId> duplicates;
  Open open;
  std::size_t open_vertices = 0;  ///< also where `open` has been passed on
  NodeSums sums;                  ///< with the hash of the part
  Statistics statistics;
  NodeTimes times;
};

struct ComputeOptions {
  bool arrays = true;     ///< triangles, neighbors, xy and ids of NodeData are wanted
  NodeConsumer consumer;  ///< may be empty
};
/// Triangulates a leaf; takes its points. \throws as finish_leaf, with input indices in InputError
[[nodiscard]] NodeData compute_leaf(Triangulator& triangulator, LeafPoints&& points, const TileBox& box,
                                    std::uint32_t node, const ComputeOptions& options);
/// Joins children. \throws as finish_join
[[nodiscard]] NodeData compute_join(Triangulator& triangulator, std::span<const Open> children, const TileBox& box,
                                    std::uint32_t node, const ComputeOptions& options);

/// What goes from process to process and into files, as little-endian words of 64 bits. Unpacking throws Error for
/// words that are no such thing.
[[nodiscard]] std::vector<std::uint64_t> pack(const Open& open);
[[nodiscard]] std::vector<std::uint64_t> pack(std::span<const Link> messages);
[[nodiscard]] Open unpack_open(std::span<const std::uint64_t> words);
[[nodiscard]] std::vector<Link> unpack_messages(std::span<const std::uint64_t> words);

}  // namespace cadt::tiles
