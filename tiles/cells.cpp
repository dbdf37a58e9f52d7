// SPDX-License-Identifier: Apache-2.0
#include "tiles/cells.hpp"

#include <cadt/errors.hpp>

#include "tiles/hash.hpp"

#include <array>
#include <utility>

namespace cadt::tiles {
namespace {

class CellSource : public PointSource {
 public:
  CellSource(std::uint64_t points, std::uint64_t seed) : cells_(points, seed) {}
  [[nodiscard]] std::uint64_t size() const noexcept override { return cells_.size(); }
  [[nodiscard]] std::string name_of(std::uint64_t /*index*/) const override { return "generated set cells"; }
  [[nodiscard]] std::vector<std::string> names() const override { return {name_of(0)}; }
  [[nodiscard]] const UniformCells* cells() const noexcept override { return &cells_; }

 protected:
  void read_raw(std::uint64_t first, std::size_t count, double* xy) const override {
    cells_.generate(first, count, xy);
  }

 private:
  UniformCells cells_;
};

/// Appends the nodes of a part in post-order; returns the last, its root.
std::uint32_t append(std::vector<TreeNode>& nodes, const UniformCells& cells, unsigned depth, unsigned most,
                     std::uint64_t index) {
  const UniformCells::Part part = cells.part(depth, index);
  TreeNode node{.box = part.box, .points = part.count};
  if (depth < most) {
    node.left = append(nodes, cells, depth + 1, most, 2 * index);
    node.right = append(nodes, cells, depth + 1, most, 2 * index + 1);
    nodes[node.left].parent = nodes[node.right].parent = static_cast<std::uint32_t>(nodes.size());
  }
  nodes.push_back(node);
  return static_cast<std::uint32_t>(nodes.size()) - 1;
}

}  // namespace

std::unique_ptr<PointSource> uniform_cells(std::uint64_t points, std::uint64_t seed) {
  return std::make_unique<CellSource>(points, seed);
}

std::optional<TileTree> tree_of_cells(const UniformCells& cells, std::uint64_t tile_points) {
  const std::optional<unsigned> depth = cells.depth_for(tile_points);
  if (!depth) return std::nullopt;
  const std::uint64_t size = (std::uint64_t{2} << *depth) - 1;
  if (size > most_nodes)
    throw LimitError("the tree would have " + std::to_string(size) + " nodes, more than " + std::to_string(most_nodes) +
                         ": take larger tiles",
                     size, most_nodes);
  std::vector<TreeNode> nodes;
  nodes.reserve(size);
  append(nodes, cells, 0, *depth, 0);
  return TileTree(std::move(nodes));
}

bool in_cells(const PointSource& source, std::uint64_t tile_points) {
  return source.cells() != nullptr && source.cells()->depth_for(tile_points);
}

std::function<LeafPoints(std::uint32_t)> cells_of_leaves(const PointSource& source, const TileTree& tree,
                                                         std::uint64_t first_id) {
  std::vector<std::uint64_t> firsts(tree.size());
  std::uint64_t first = 0;
  for (const std::uint32_t leaf : tree.leaves()) {
    firsts[leaf] = first;
    first += tree.node(leaf).points;
  }
  return [&source, &tree, first_id, firsts = std::move(firsts)](std::uint32_t leaf) {
    LeafPoints points;
    points.cells = source.cells();
    points.first = firsts[leaf];
    points.count = tree.node(leaf).points;
    points.first_id = first_id + points.first;
    return points;
  };
}

Hash128 content_of_cells(const UniformCells& cells) noexcept {
  const std::array<std::uint64_t, 2> words = {cells.size(), cells.seed()};
  return hash_bytes(words.data(), sizeof words, 1);
}

}  // namespace cadt::tiles
