// SPDX-License-Identifier: Apache-2.0
// One mesh in one process: the tree, its leaves and joins on one or several devices, and where the nodes go.
#pragma once

#include "tiles/node.hpp"
#include "tiles/source.hpp"
#include "tiles/store.hpp"
#include "tiles/tree.hpp"

#include <cadt/options.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace cadt::tiles {

struct RunProgress {
  std::string_view phase;  ///< "sample", "check", "shuffle", "tiles", "links"
  double fraction = 0;     ///< of the phase
  std::uint32_t nodes_done = 0, nodes = 0;
};

struct RunOptions {
  std::uint64_t tile_points = default_tile_points;
  std::uint64_t first_id = 0;  ///< input index of the first point
  /// One triangulator and one thread each. Order, stop and statistics are set by run().
  std::vector<Options> devices = {Options()};
  std::string output;             ///< directory; empty: nothing is written
  bool resume = false;            ///< continue in `output`
  std::string scratch;            ///< folder for points that memory does not take; empty: none
  std::uint64_t host_memory = 0;  ///< bytes that the points of all leaves may take in memory; 0: half of what is free
  NodeConsumer consumer;          ///< for each node that is computed, not for those that --resume skips
  std::function<void(NodeData&&)> collect;  ///< arrays of each node on the host, one call at a time; may be empty
  cadt::stop_token stop;
  std::function<void(const RunProgress&)> progress;  ///< one call at a time, from any thread; must not throw
};

struct NodeReport {
  NodeTimes times;
  std::uint64_t points = 0, triangles = 0, open = 0;
  unsigned device = 0;   ///< index in RunOptions::devices
  bool resumed = false;  ///< it was there
  Statistics statistics;
};

struct RunResult {
  Plan plan;
  NodeSums whole;
  Hash128 hash;  ///< Triangulation::hash of a single run
  std::vector<NodeReport> nodes;
  std::vector<std::string> devices;  ///< their names
  double sample_seconds = 0, shuffle_seconds = 0, nodes_seconds = 0, links_seconds = 0;
  std::uint64_t most_open = 0;  ///< open vertices of one node
  bool scratch_used = false;
};

/// The tree of a source, and its content's hash. \throws as PointSource::read, LimitError, Cancelled
[[nodiscard]] Plan make_plan(const PointSource& source, const RunOptions& options);

/// Checks disk and memory before any work: what the run will write, and what the points and a tile take.
/// \throws OutOfMemory, io::FileError, both with needed and available bytes
void preflight(const PointSource& source, const RunOptions& options);

/// Makes the mesh. The same nodes, byte by byte, for all devices. \throws io::FileError, InputError, LimitError,
/// OutOfMemory, ResumeError, Cancelled, and what the devices throw
RunResult run(const PointSource& source, const RunOptions& options);

}  // namespace cadt::tiles
