// SPDX-License-Identifier: Apache-2.0
// The k-d tree of half-open boxes that cuts a point set into tiles. A function of the points (in the order of their
// indices) and of the size of a tile alone: it is the same for every number of processes, threads and devices.
#pragma once

#include <cadt/finalization.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::tiles {

inline constexpr std::uint64_t default_tile_points = std::uint64_t{1} << 27;
inline constexpr std::uint64_t least_tile_points = 3;
inline constexpr std::uint64_t sample_points = std::uint64_t{1}
                                               << 20;  ///< expected size of a sample; smaller sets: all
inline constexpr std::uint32_t most_nodes = (std::uint32_t{1} << node_bits) - 1;
inline constexpr std::uint32_t no_node = ~std::uint32_t{0};

struct TreeNode {
  TileBox box;
  std::uint32_t parent = no_node, left = no_node, right = no_node;
  std::uint64_t points = 0;  ///< input points in the box, exactly
  [[nodiscard]] bool is_leaf() const noexcept { return left == no_node; }
  friend bool operator==(const TreeNode&, const TreeNode&) = default;
};

/// Nodes in post-order: children before their parents, leaves from left to right, the root last. Immutable, so const
/// functions may run concurrently.
class TileTree {
 public:
  /// One leaf, the plane.
  explicit TileTree(std::uint64_t points = 0);
  /// As read from a file. \throws Error if the nodes are no such tree
  explicit TileTree(std::vector<TreeNode> nodes);

  [[nodiscard]] std::span<const TreeNode> nodes() const noexcept { return nodes_; }
  [[nodiscard]] const TreeNode& node(std::uint32_t i) const noexcept { return nodes_[i]; }
  [[nodiscard]] std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(nodes_.size()); }
  [[nodiscard]] std::uint32_t root() const noexcept { return size() - 1; }
  [[nodiscard]] std::uint64_t number_of_points() const noexcept { return nodes_.back().points; }
  /// Numbers of the leaves, ascending.
  [[nodiscard]] std::span<const std::uint32_t> leaves() const noexcept { return leaves_; }
  /// The leaf whose box has the point. O(depth).
  [[nodiscard]] std::uint32_t leaf_of(double x, double y) const noexcept {
    const double point[2] = {x, y};
    std::uint32_t at = root();
    for (const Step* step = &steps_[at]; step->children[0] != no_node; step = &steps_[at])
      at = step->children[point[step->axis] < step->at ? 0 : 1];
    return at;
  }
  friend bool operator==(const TileTree& a, const TileTree& b) { return a.nodes_ == b.nodes_; }

 private:
  struct Step {  // of the way down: the left child has what is below `at`
    double at = 0;
    std::uint32_t axis = 0, children[2] = {no_node, no_node};
  };
  std::vector<TreeNode> nodes_;
  std::vector<std::uint32_t> leaves_;
  std::vector<Step> steps_;  // of each node
};

/// As cadt::require_complete, and that the sums are of all points of the tree. \throws InternalError
void require_complete(const NodeSums& whole, const TileTree& tree);

/// What one pass over a part of the input finds; those of several parts are added.
struct TreePass {
  std::vector<std::uint64_t> counts;  ///< of each open leaf of the builder
  std::vector<double> bounds;         ///< of each: min x, min y, max x, max y; infinite if it is empty
  std::vector<double> sample;         ///< x0 y0 x1 y1 ..., in any order
  TreePass& operator+=(const TreePass& other);
};

/// Builds the tree in passes over the input: sample, count, and again for the leaves that turn out too full. The
/// caller makes the passes, so that they can be divided among threads or processes:
///
///     TreeBuilder builder(n, tile_points);
///     while (!builder.done()) {
///       TreePass pass = builder.new_pass();
///       // For each chunk of the input; concurrently, each thread with a pass of its own:
///       builder.look_at(pass, first, xy);
///       // Then the sum of all of them:
///       builder.finish_pass(std::move(pass));
///     }
///     TileTree tree = builder.take();
class TreeBuilder {
 public:
  /// \throws std::invalid_argument for fewer than least_tile_points
  TreeBuilder(std::uint64_t points, std::uint64_t tile_points, std::uint32_t most = most_nodes);

  [[nodiscard]] bool done() const noexcept { return pending_.empty(); }
  [[nodiscard]] TreePass new_pass() const;
  /// Points first, first + 1, ... of the input, finite. O(points * depth).
  void look_at(TreePass& pass, std::uint64_t first, std::span<const double> xy) const;
  /// \throws LimitError if the tree would have more nodes than `most`
  void finish_pass(TreePass&& pass);
  /// \pre done()
  [[nodiscard]] TileTree take();

 private:
  struct Draft {  // a node before post-order is known
    TileBox box;
    std::uint32_t left = no_node, right = no_node;
    std::uint64_t points = 0;
    std::uint32_t slot = no_node;  // of the pass
    int axis = 0;
    double at = 0;  // where it is cut: what is below belongs to the left child
  };
  struct Pending {
    std::uint32_t draft = 0;
    std::uint64_t threshold = 0;  // of the hash of an index, for the sample
    bool whole = false;           // the sample is all points of the leaf
  };
  [[nodiscard]] std::uint32_t draft_of(double x, double y) const noexcept;
  using Point = std::array<double, 2>;
  void split_by_sample(std::uint32_t slot, std::span<Point> sample, const double* bounds, std::uint64_t count);
  void add_children(std::uint32_t draft, int axis, double at);
  void choose_pending(std::vector<std::uint32_t> drafts);

  std::uint64_t points_, tile_points_;
  std::uint32_t most_;
  bool sampling_ = true;
  std::vector<Draft> drafts_;
  std::vector<Pending> pending_;
};

}  // namespace cadt::tiles
