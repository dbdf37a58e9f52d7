// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact_mesh/random_insertion.hpp"

#include <cmath>
#include <deque>
#include <numeric>
#include <random>
#include <utility>

namespace cadt::constraints {
namespace {

using exact::Place;

class GrowingPolygon {
 public:
  GrowingPolygon(const exact::ImplicitPoints& exact, std::span<const Place> chain)
      : exact_(exact), chain_(chain), high_(static_cast<std::int32_t>(chain.size()) - 1) {
    mesh_.triangles.resize(chain.size() - 2);
    mesh_.across.assign(3 * mesh_.triangles.size(), -1);
    edge_.assign(chain.size(), -1);
    queued_.assign(mesh_.triangles.size(), 0);
  }

  std::optional<ChainMesh> triangulate(const StopCheck& check_stop) {
    if (!take_out()) return std::nullopt;
    for (; !out_.empty(); out_.pop_back()) {
      if (out_.size() % vertices_a_check == 0) check_stop();
      if (!insert(out_.back())) return std::nullopt;
      legalize();
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::size_t vertices_a_check = 4096;

  /// A vertex that is not in the polygon, and those that were on its sides.
  struct Out {
    std::int32_t before, vertex, after;
  };

  [[nodiscard]] const Place& at(std::int32_t v) const { return chain_[static_cast<std::size_t>(v)]; }
  [[nodiscard]] std::int32_t& across(std::int32_t half_edge) {
    return mesh_.across[static_cast<std::size_t>(half_edge)];
  }
  [[nodiscard]] std::int32_t corner(std::int32_t t, std::int32_t k) const {
    return mesh_.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(k % 3)];
  }
  /// A sum of two doubles: a vertex may be an ulp from the base.
  struct Pair {
    double high, low;
  };
  [[nodiscard]] static Pair difference(double a, double b) {
    const double high = a - b, part = high - a;
    return {high, (a - (high - part)) - (b + part)};
  }
  [[nodiscard]] static Pair product(const Pair& a, const Pair& b) {
    const double high = a.high * b.high;
    return {high, std::fma(a.high, b.high, -high) + (a.high * b.low + a.low * b.high)};
  }
  /// The distance from the base of a rounded place, times its length.
  [[nodiscard]] double height(std::int32_t v) const {
    const Place &p = chain_.front(), &q = chain_.back(), &x = at(v);
    const Pair left = product(difference(q.x, p.x), difference(x.y, p.y)),
               right = product(difference(q.y, p.y), difference(x.x, p.x)), all = difference(left.high, right.high);
    return all.high + (all.low + (left.low - right.low));
  }

  /// All vertices but the ends of the base. False: it does not come to an end.
  bool take_out() {
    constexpr int most_rounds = 256;  // each one takes out about a quarter at least
    std::mt19937 random(1);
    std::vector<std::int32_t> next(chain_.size());
    std::iota(next.begin(), next.end(), 1);
    for (int round = 0; next[0] != high_; ++round) {
      if (round == most_rounds) return false;
      const bool last = next[static_cast<std::size_t>(next[0])] == high_;
      double height_before = 0, height_now = height(next[0]);
      for (std::int32_t before = 0, v = next[0]; v != high_;) {
        const std::int32_t after = next[static_cast<std::size_t>(v)];
        const double height_after = height(after);
        if ((height_now < height_before && height_now < height_after) || (!last && (random() & 1U) != 0)) {
          before = v;
          height_before = height_now;
        } else {
          out_.push_back({before, v, after});
          next[static_cast<std::size_t>(before)] = after;
        }
        v = after;
        height_now = height_after;
      }
    }
    return true;
  }

  /// What is across edge k of triangle t, and there this edge in turn; an edge of the chain is known by the vertex that
  /// it goes to.
  void set_side(std::int32_t t, std::int32_t k, std::int32_t other) {
    across(3 * t + k) = other;
    if (other >= 0)
      across(other) = 3 * t + k;
    else
      edge_[static_cast<std::size_t>(corner(t, k + 2))] = 3 * t + k;
  }

  /// Flips edge k of triangle t: x v w and y w v become x v y and x y w, the first one in t. Returns the other one.
  std::int32_t flip(std::int32_t t, std::int32_t k) {
    const std::int32_t behind = across(3 * t + k), u = behind / 3, j = behind % 3;
    const std::int32_t x = corner(t, k), v = corner(t, k + 1), w = corner(t, k + 2), y = corner(u, j);
    const std::int32_t wx = across(3 * t + (k + 1) % 3), xv = across(3 * t + (k + 2) % 3);
    const std::int32_t vy = across(3 * u + (j + 1) % 3), yw = across(3 * u + (j + 2) % 3);
    mesh_.triangles[static_cast<std::size_t>(t)] = {x, v, y};
    mesh_.triangles[static_cast<std::size_t>(u)] = {x, y, w};
    set_side(t, 0, vy);
    set_side(t, 2, xv);
    set_side(u, 0, yw);
    set_side(u, 1, wx);
    set_side(t, 1, 3 * u + 2);
    return u;
  }

  void enqueue(std::int32_t t) {
    if (std::exchange(queued_[static_cast<std::size_t>(t)], std::uint8_t{1}) != 0) return;
    queue_.push_back(t);
  }

  /// Beyond the edge between those on its sides; its triangles get an area by flips. False: not all can.
  bool insert(const Out& out) {
    const auto [v, x, w] = out;
    std::int32_t t = x - 1;
    const std::int32_t behind = edge_[static_cast<std::size_t>(v)];  // -1: the base is to be its edge
    mesh_.triangles[static_cast<std::size_t>(t)] = {x, v, w};
    set_side(t, 0, behind);
    set_side(t, 1, -1);
    set_side(t, 2, -1);
    for (;;) {  // around x, from v to w; t has x as corner 0
      while (exact_.orientation(at(x), at(corner(t, 1)), at(corner(t, 2))) <= 0) {
        if (across(3 * t) < 0) return false;
        flip(t, 0);
      }
      enqueue(t);
      const std::int32_t beside = across(3 * t + 1);
      if (beside < 0) return true;
      t = beside / 3;
    }
  }

  void legalize() {
    while (!queue_.empty()) {
      const std::int32_t t = queue_.front();
      queue_.pop_front();
      queued_[static_cast<std::size_t>(t)] = 0;
      for (std::int32_t k = 0; k < 3; ++k) {
        const std::int32_t behind = across(3 * t + k);
        if (behind < 0 || exact_.incircle_perturbed(at(corner(t, 0)), at(corner(t, 1)), at(corner(t, 2)),
                                                    at(corner(behind / 3, behind % 3))) <= 0)
          continue;
        enqueue(flip(t, k));
        enqueue(t);
        break;
      }
    }
  }

  const exact::ImplicitPoints& exact_;
  const std::span<const Place> chain_;
  const std::int32_t high_;
  ChainMesh mesh_;  // triangle t is that of vertex t + 1
  std::vector<Out> out_;
  std::vector<std::int32_t> edge_;  // of the chain so far, from each vertex on; -1: none yet
  std::deque<std::int32_t> queue_;  // triangles to be looked at
  std::vector<std::uint8_t> queued_;
};

}  // namespace

std::optional<ChainMesh> insert_at_random(const exact::ImplicitPoints& exact, std::span<const Place> chain,
                                          const StopCheck& check_stop) {
  return GrowingPolygon(exact, chain).triangulate(check_stop);
}

}  // namespace cadt::constraints
