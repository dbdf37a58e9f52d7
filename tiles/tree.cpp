// SPDX-License-Identifier: Apache-2.0
#include "tiles/tree.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace cadt::tiles {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::uint64_t least_sample = 1024;  // of an overfull leaf, where there are many

/// Whether point `index` is in a sample (the mixer of splitmix64).
std::uint64_t hash_of_index(std::uint64_t z) noexcept {
  z += 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

/// Parts of a box on both sides of a number: left is below it.
std::pair<TileBox, TileBox> cut(const TileBox& box, int axis, double at) noexcept {
  TileBox left = box, right = box;
  (axis == 0 ? left.max_x : left.max_y) = at;
  (axis == 0 ? right.min_x : right.min_y) = at;
  return {left, right};
}

void need(bool holds, const char* what) {
  if (!holds) throw Error(std::string("not a tree of tiles: ") + what);
}

/// Halves points by a number, of which they have two at least: the left half, which comes first, is below it, and
/// neither is empty. The number, and how many are left of it.
std::pair<double, std::size_t> halve(std::span<std::array<double, 2>> points, std::size_t axis) {
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(),
                   [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  double at = (*middle)[axis];
  const auto is_left = [&](const auto& p) { return p[axis] < at; };
  auto right = std::partition(points.begin(), middle, is_left);
  if (right == points.begin()) {  // nothing is below the median
    double next = infinite;
    for (const auto& p : points)
      if (p[axis] > at) next = std::min(next, p[axis]);
    at = next;
    right = std::partition(points.begin(), points.end(), is_left);
  }
  return {at, static_cast<std::size_t>(right - points.begin())};
}

}  // namespace

void require_complete(const NodeSums& whole, const TileTree& tree) {
  if (whole.points != tree.number_of_points())
    throw InternalError("the leaves have " + std::to_string(whole.points) + " points, and the tree " +
                        std::to_string(tree.number_of_points()));
  require_complete(whole);
}

TileTree::TileTree(std::uint64_t points) : nodes_(1), leaves_{0}, steps_(1) { nodes_[0].points = points; }

TileTree::TileTree(std::vector<TreeNode> nodes) : nodes_(std::move(nodes)), steps_(nodes_.size()) {
  need(!nodes_.empty() && nodes_.size() <= most_nodes, "the number of nodes");
  need(nodes_.back().box.is_plane() && nodes_.back().parent == no_node, "the last node is the plane");
  std::vector<std::uint32_t> open;  // subtrees without a parent yet
  for (std::uint32_t i = 0; i < size(); ++i) {
    const TreeNode& n = nodes_[i];
    if (n.is_leaf()) {
      need(n.right == no_node, "a node has none or two children");
      leaves_.push_back(i);
    } else {
      need(open.size() >= 2 && open.back() == n.right && open[open.size() - 2] == n.left,
           "the nodes are in post-order");
      const TreeNode &l = nodes_[n.left], &r = nodes_[n.right];
      need(l.parent == i && r.parent == i, "children know their parents");
      need(l.points + r.points == n.points, "the points of children add up");
      const int axis = l.box.max_x == n.box.max_x ? 1 : 0;
      const double at = axis == 0 ? l.box.max_x : l.box.max_y;
      need(cut(n.box, axis, at) == std::pair(l.box, r.box), "the boxes of children are halves of that of their parent");
      steps_[i] = {at, static_cast<std::uint32_t>(axis), {n.left, n.right}};
      open.resize(open.size() - 2);
    }
    open.push_back(i);
  }
  need(open.size() == 1, "there is one root");
}

TreePass& TreePass::operator+=(const TreePass& other) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts[i] += other.counts[i];
    for (const std::size_t k : {4 * i, 4 * i + 1}) bounds[k] = std::min(bounds[k], other.bounds[k]);
    for (const std::size_t k : {4 * i + 2, 4 * i + 3}) bounds[k] = std::max(bounds[k], other.bounds[k]);
  }
  sample.insert(sample.end(), other.sample.begin(), other.sample.end());
  return *this;
}

TreeBuilder::TreeBuilder(std::uint64_t points, std::uint64_t tile_points, std::uint32_t most)
    : points_(points), tile_points_(tile_points), most_(most), drafts_(1) {
  if (tile_points < least_tile_points)
    throw std::invalid_argument("a tile has at least " + std::to_string(least_tile_points) + " points");
  drafts_[0].points = points;
  if (points > tile_points) choose_pending({0});
}

void TreeBuilder::choose_pending(std::vector<std::uint32_t> drafts) {
  pending_.clear();
  for (const std::uint32_t draft : drafts) {
    Pending pending{.draft = draft};
    if (sampling_) {
      const std::uint64_t count = drafts_[draft].points;
      const std::uint64_t target = std::max<std::uint64_t>(sample_points / drafts.size(), least_sample);
      pending.whole = count <= target;
      pending.threshold = pending.whole ? ~std::uint64_t{0} : ~std::uint64_t{0} / count * target;
    }
    drafts_[draft].slot = static_cast<std::uint32_t>(pending_.size());
    pending_.push_back(pending);
  }
}

TreePass TreeBuilder::new_pass() const {
  TreePass pass;
  pass.counts.resize(pending_.size());
  for (std::size_t i = 0; i < pending_.size(); ++i)
    pass.bounds.insert(pass.bounds.end(), {infinite, infinite, -infinite, -infinite});
  return pass;
}

std::uint32_t TreeBuilder::draft_of(double x, double y) const noexcept {
  const double point[2] = {x, y};
  std::uint32_t at = 0;
  for (const Draft* draft = &drafts_[at]; draft->left != no_node; draft = &drafts_[at])
    at = draft->left + (point[draft->axis] < draft->at ? 0 : 1);  // children are neighbours
  return at;
}

void TreeBuilder::look_at(TreePass& pass, std::uint64_t first, std::span<const double> xy) const {
  for (std::size_t i = 0; i < xy.size() / 2; ++i) {
    const double x = xy[2 * i], y = xy[2 * i + 1];
    const std::uint32_t slot = drafts_[draft_of(x, y)].slot;
    if (slot == no_node) continue;
    ++pass.counts[slot];
    if (!sampling_) continue;
    double* bounds = &pass.bounds[std::size_t{4} * slot];
    bounds[0] = std::min(bounds[0], x), bounds[1] = std::min(bounds[1], y);
    bounds[2] = std::max(bounds[2], x), bounds[3] = std::max(bounds[3], y);
    if (pending_[slot].whole || hash_of_index(first + i) < pending_[slot].threshold)
      pass.sample.insert(pass.sample.end(), {x, y});
  }
}

void TreeBuilder::finish_pass(TreePass&& pass) {
  const std::vector<Pending> looked_at = pending_;
  std::vector<std::uint32_t> next;
  if (!sampling_) {
    for (std::size_t i = 0; i < looked_at.size(); ++i) {
      Draft& draft = drafts_[looked_at[i].draft];
      draft.points = pass.counts[i];
      draft.slot = no_node;
      if (draft.points > tile_points_) next.push_back(looked_at[i].draft);
    }
    sampling_ = true;
    choose_pending(std::move(next));
    return;
  }
  // The sample by leaf. The order within a leaf is of no importance.
  std::vector<std::vector<Point>> samples(looked_at.size());
  for (std::size_t i = 0; i < pass.sample.size(); i += 2) {
    const Point p{pass.sample[i], pass.sample[i + 1]};
    samples[drafts_[draft_of(p[0], p[1])].slot].push_back(p);
  }
  pass.sample = {};
  for (const Pending& pending : looked_at) drafts_[pending.draft].slot = no_node;
  const std::size_t before = drafts_.size();
  for (std::uint32_t slot = 0; slot < looked_at.size(); ++slot) {
    split_by_sample(slot, samples[slot], &pass.bounds[std::size_t{4} * slot], pass.counts[slot]);
    samples[slot] = {};
  }
  for (std::size_t i = before; i < drafts_.size(); ++i)
    if (drafts_[i].left == no_node) next.push_back(static_cast<std::uint32_t>(i));
  sampling_ = false;
  choose_pending(std::move(next));
}

void TreeBuilder::add_children(std::uint32_t draft, int axis, double at) {
  if (drafts_.size() + 2 > most_) {
    throw LimitError("tiles of " + std::to_string(tile_points_) + " points make a tree of too many nodes for " +
                         std::to_string(points_) + " points; make the tiles larger (--tile-points)",
                     drafts_.size() + 2, most_);
  }
  const auto [left, right] = cut(drafts_[draft].box, axis, at);
  const auto first = static_cast<std::uint32_t>(drafts_.size());
  drafts_[draft].left = first;
  drafts_[draft].right = first + 1;
  drafts_[draft].axis = axis;
  drafts_[draft].at = at;
  drafts_.push_back({.box = left});
  drafts_.push_back({.box = right});
}

void TreeBuilder::split_by_sample(std::uint32_t slot, std::span<Point> sample, const double* bounds,
                                  std::uint64_t count) {
  struct Piece {
    std::uint32_t draft;
    std::size_t begin, end;  // points of the sample
  };
  const bool whole = pending_[slot].whole;
  const std::size_t all = sample.size();
  // Points that m of the sample stand for, at most: four standard deviations spare most passes of a second round.
  const auto is_overfull = [&](std::size_t m) {
    if (whole) return m > tile_points_;
    const double share = static_cast<double>(m) + 4 * std::sqrt(static_cast<double>(m));
    return share * static_cast<double>(count) > static_cast<double>(tile_points_) * static_cast<double>(all);
  };
  std::vector<Piece> todo{{pending_[slot].draft, 0, all}};
  while (!todo.empty()) {
    const Piece piece = todo.back();
    todo.pop_back();
    const std::size_t m = piece.end - piece.begin;
    const bool is_slot = m == all;  // its exact bounds are known, and that it is overfull
    if (!is_slot && !is_overfull(m)) continue;
    double low[2] = {infinite, infinite}, high[2] = {-infinite, -infinite};
    const std::span<Point> of_piece = sample.subspan(piece.begin, m);
    for (const Point& p : of_piece) {
      for (const std::size_t a : {0U, 1U}) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
    }
    if (m == 0) std::copy_n(bounds, 2, low), std::copy_n(bounds + 2, 2, high);
    // Halves, since the difference of two doubles may be infinite.
    const int longer = high[1] / 2 - low[1] / 2 > high[0] / 2 - low[0] / 2 ? 1 : 0;
    const int axis = low[longer] < high[longer] ? longer : 1 - longer;
    if (m == 0 || !(low[axis] < high[axis])) {
      // One place. If the sample was not all points, the bounds tell whether there are others.
      if (whole || !is_slot) continue;
      for (const int a : {0, 1}) {
        if (bounds[a] < low[a] || (m == 0 && bounds[a] < bounds[2 + a])) {
          add_children(piece.draft, a, m == 0 ? high[a] : low[a]);
          break;
        }
        if (bounds[2 + a] > high[a]) {
          add_children(piece.draft, a, std::nextafter(high[a], infinite));
          break;
        }
      }
      continue;
    }
    const auto [at, lefts] = halve(of_piece, static_cast<std::size_t>(axis));
    const std::size_t middle = piece.begin + lefts;
    add_children(piece.draft, axis, at);
    todo.push_back({drafts_[piece.draft].left, piece.begin, middle});
    todo.push_back({drafts_[piece.draft].right, middle, piece.end});
  }
}

TileTree TreeBuilder::take() {
  std::vector<TreeNode> nodes;
  std::vector<std::uint32_t> number(drafts_.size(), no_node);
  std::vector<std::pair<std::uint32_t, bool>> todo{{0, false}};  // draft, whether its children are done
  while (!todo.empty()) {
    const auto [draft, ready] = todo.back();
    todo.pop_back();
    const Draft& from = drafts_[draft];
    if (from.left != no_node && !ready) {
      todo.emplace_back(draft, true);
      todo.emplace_back(from.right, false);
      todo.emplace_back(from.left, false);
      continue;
    }
    const auto i = static_cast<std::uint32_t>(nodes.size());
    TreeNode node{.box = from.box, .points = from.points};
    if (from.left != no_node) {
      node.left = number[from.left], node.right = number[from.right];
      nodes[node.left].parent = nodes[node.right].parent = i;
      node.points = nodes[node.left].points + nodes[node.right].points;
    }
    number[draft] = i;
    nodes.push_back(node);
  }
  return TileTree(std::move(nodes));
}

}  // namespace cadt::tiles
