// SPDX-License-Identifier: Apache-2.0
// Points to the leaves of the tree, each with its input index; within a leaf the indices ascend.
#pragma once

#include "tiles/array.hpp"
#include "tiles/source.hpp"
#include "tiles/tree.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cadt::tiles {

struct LeafPoints {
  Array<double> xy;  ///< x0 y0 x1 y1 ...
  Array<std::uint64_t> ids;
  /// Instead of arrays: `count` points from `first` on of a set that is made on the device; input indices begin at
  /// `first_id`.
  const UniformCells* cells = nullptr;
  std::uint64_t first = 0, count = 0, first_id = 0;
};

inline constexpr std::uint64_t bytes_per_shuffled_point = 24;

/// Where points go: x0 y0 x1 y1 ..., and their ids.
struct Room {
  double* xy = nullptr;
  std::uint64_t* ids = nullptr;
};

/// The points are not those that the tree and its content were made of. \throws io::FileError
[[noreturn]] void fail_changed();

/// Takes points in the order of their indices, and gives them back leaf by leaf.
class LeafStore {
 public:
  LeafStore() = default;
  LeafStore(const LeafStore&) = delete;
  LeafStore& operator=(const LeafStore&) = delete;
  virtual ~LeafStore() = default;
  /// Points of one leaf, ids above all that the leaf has. Not thread-safe. \throws io::FileError, as fail_changed() if
  /// the leaf gets more than the tree says
  virtual void add(std::uint32_t leaf, std::span<const double> xy, std::span<const std::uint64_t> ids) = 0;
  /// Adds `count` points to a leaf that are written by whoever asks, before finish(). Null if this store has no memory
  /// for them: they go through add(). Neither is thread-safe, but rooms may be filled concurrently.
  [[nodiscard]] virtual Room add_room(std::uint32_t leaf, std::size_t count) = 0;
  /// Nothing is added after this.
  virtual void finish() = 0;
  /// The points of a leaf, which are forgotten. Thread-safe for different leaves. \throws io::FileError
  [[nodiscard]] virtual LeafPoints take(std::uint32_t leaf) = 0;
};
[[nodiscard]] std::unique_ptr<LeafStore> leaves_in_memory(const TileTree& tree);
/// A file for each leaf in a new folder below `scratch`, which is removed in the end. Buffers take at most `memory`
/// bytes, but 12 KiB a leaf at least. \throws io::FileError
[[nodiscard]] std::unique_ptr<LeafStore> leaves_in_files(const TileTree& tree, const std::string& scratch,
                                                         std::uint64_t memory = std::uint64_t{256} << 20);

struct ShuffleOptions {
  std::string scratch;                  ///< folder for bucket files; empty: none
  std::uint64_t first_id = 0;           ///< input index of the first point
  std::optional<Hash128> content = {};  ///< of the source when the tree was made, with which it is compared
  std::uint64_t memory = 0;             ///< bytes that the points may take; more go to `scratch`. 0: no limit
  std::vector<bool> wanted = {};        ///< by node: leaves that will be taken; empty: all
  unsigned threads = 0;                 ///< 0: one for each core
  cadt::stop_token stop = {};
  std::function<void(std::uint64_t)> progress = {};  ///< points so far; one call at a time, from any thread
};

/// Whether so many bytes of points go to `scratch`. \throws OutOfMemory if they must and there is none
[[nodiscard]] bool needs_scratch(std::uint64_t bytes, std::uint64_t memory, const std::string& scratch);
/// The same of the wanted points.
[[nodiscard]] bool needs_scratch(const TileTree& tree, const ShuffleOptions& options);

/// One pass over the source: blocks are read and sorted by all threads, and get their places in the leaves in the order
/// of the input. \throws io::FileError, also as fail_changed(), InputError, Cancelled, OutOfMemory if the points take
/// more than `memory` and there is no `scratch`
[[nodiscard]] std::unique_ptr<LeafStore> shuffle(const PointSource& source, const TileTree& tree,
                                                 const ShuffleOptions& options);

/// Points of a block that belong to one leaf, in the order of the input.
struct LeafRun {
  std::uint32_t leaf = 0;
  std::span<const double> xy;
  std::span<const std::uint64_t> ids;
};

/// Distributes blocks by leaf, keeping the order.
class BlockSorter {
 public:
  explicit BlockSorter(const TileTree& tree);
  /// A run for each leaf that has points of the block, leaves ascending. Valid until the next call.
  std::span<const LeafRun> sort(std::uint64_t first_id, std::span<const double> xy);

 private:
  const TileTree& tree_;
  std::vector<std::uint32_t> leaf_, touched_;
  std::vector<std::uint32_t> count_;  // of each node, between calls 0
  std::vector<double> xy_;
  std::vector<std::uint64_t> ids_;
  std::vector<LeafRun> runs_;
};

}  // namespace cadt::tiles
