// SPDX-License-Identifier: Apache-2.0
// The segments that a sweep line meets, from the lowest to the highest: a treap (C. R. Aragon, R. G. Seidel,
// "Randomized search trees", FOCS 1989) whose nodes are in a list, too. It compares nothing itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cadt::constraints {

class SweepStatus {
 public:
  static constexpr std::int32_t none = -1;

  [[nodiscard]] std::int32_t segment(std::int32_t node) const { return at(node).segment; }
  void set_segment(std::int32_t node, std::int32_t segment) { at(node).segment = segment; }
  [[nodiscard]] std::int32_t next(std::int32_t node) const { return at(node).next; }
  [[nodiscard]] std::int32_t previous(std::int32_t node) const { return at(node).previous; }
  [[nodiscard]] std::int32_t highest() const { return highest_; }

  /// The lowest node whose segment fulfils a condition that holds from some node on; none if none does. O(log n).
  template <class Condition>
  [[nodiscard]] std::int32_t find_first(const Condition& condition) const {
    std::int32_t found = none;
    for (std::int32_t node = root_; node != none;) {
      if (condition(at(node).segment)) {
        found = node;
        node = at(node).left;
      } else {
        node = at(node).right;
      }
    }
    return found;
  }

  /// A new node above `below`, at the bottom if that is none. O(1) expected.
  std::int32_t insert_above(std::int32_t below, std::int32_t segment) {
    const std::int32_t node = take(segment);
    const std::int32_t above = below == none ? lowest_ : at(below).next;
    at(node).previous = below;
    at(node).next = above;
    (below == none ? lowest_ : at(below).next) = node;
    (above == none ? highest_ : at(above).previous) = node;
    if (below != none && at(below).right == none) {
      at(below).right = node;
      at(node).parent = below;
    } else if (above != none) {  // the lowest node of what is right of `below`
      at(above).left = node;
      at(node).parent = above;
    } else {
      root_ = node;
    }
    while (at(node).parent != none && at(at(node).parent).priority < at(node).priority) rotate_up(node);
    return node;
  }

  /// O(1) expected.
  void erase(std::int32_t node) {
    while (at(node).left != none && at(node).right != none)
      rotate_up(at(at(node).left).priority > at(at(node).right).priority ? at(node).left : at(node).right);
    const std::int32_t child = at(node).left != none ? at(node).left : at(node).right;
    const std::int32_t parent = at(node).parent;
    if (child != none) at(child).parent = parent;
    link_of(parent, node) = child;
    const std::int32_t below = at(node).previous, above = at(node).next;
    (below == none ? lowest_ : at(below).next) = above;
    (above == none ? highest_ : at(above).previous) = below;
    unused_.push_back(node);
  }

 private:
  struct Node {
    std::int32_t segment, left, right, parent, previous, next;
    std::uint32_t priority;
  };

  [[nodiscard]] Node& at(std::int32_t node) { return nodes_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] const Node& at(std::int32_t node) const { return nodes_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] std::int32_t& link_of(std::int32_t parent, std::int32_t child) {
    if (parent == none) return root_;
    return at(parent).left == child ? at(parent).left : at(parent).right;
  }

  std::int32_t take(std::int32_t segment) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;  // D. E. Knuth's MMIX
    const Node fresh{segment, none, none, none, none, none, static_cast<std::uint32_t>(state_ >> 32)};
    if (unused_.empty()) {
      nodes_.push_back(fresh);
      return static_cast<std::int32_t>(nodes_.size() - 1);
    }
    const std::int32_t node = unused_.back();
    unused_.pop_back();
    at(node) = fresh;
    return node;
  }

  void rotate_up(std::int32_t node) {
    const std::int32_t parent = at(node).parent, top = at(parent).parent;
    const bool left = at(parent).left == node;
    const std::int32_t moves = left ? at(node).right : at(node).left;
    (left ? at(parent).left : at(parent).right) = moves;
    if (moves != none) at(moves).parent = parent;
    (left ? at(node).right : at(node).left) = parent;
    link_of(top, parent) = node;
    at(parent).parent = node;
    at(node).parent = top;
  }

  std::vector<Node> nodes_;
  std::vector<std::int32_t> unused_;
  std::int32_t root_ = none, lowest_ = none, highest_ = none;
  std::uint64_t state_ = 1;
};

}  // namespace cadt::constraints
