// SPDX-License-Identifier: Apache-2.0
// Constrained edges of the mesh editor.
#include "common/constraints/exact_mesh/mesh_editor.hpp"

#include "common/constraints/exact_mesh/random_insertion.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace cadt::constraints {
namespace {

constexpr std::int32_t long_range = 1024;  // vertices whose tests take longer than a look at the clock
constexpr std::int32_t usual_work = 40;    // tests for a vertex of a chain that divides well

}  // namespace

/// The triangles around a vertex, one after the other: counterclockwise up to the hull, then clockwise.
struct MeshEditor::Fan {
  std::int32_t center, first, triangle;
  bool clockwise = false;
};

void MeshEditor::insert_chain(std::span<const std::int32_t> chain) {
  ++chain_;
  for (const std::int32_t v : chain) on_chain_[static_cast<std::size_t>(v)] = chain_;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) insert_edge(chain[i], chain[i + 1]);
}

/// Looks at one triangle of the fan. True if the edge to the target is one of it (crosses: false), or leaves the center
/// through it (crosses: true; the edge is the one opposite the center).
bool MeshEditor::step(Fan& fan, std::int32_t target, Edge& found, bool& crosses) {
  const std::int32_t t = fan.triangle;
  if (t < 0) throw InternalError("triangles with crossings of segments: an edge leaves its end through no triangle");
  const std::int32_t i = index_of_vertex(t, fan.center);
  const std::int32_t a = vertex(t, next(i)), b = vertex(t, previous(i));
  crosses = false;
  if (a == target || b == target) {
    found = {t, a == target ? previous(i) : next(i)};
    return true;
  }
  if (orientation(fan.center, a, target) > 0 && orientation(fan.center, b, target) < 0) {
    found = {t, i};
    crosses = true;
    return true;
  }
  fan.triangle = neighbor(t, fan.clockwise ? previous(i) : next(i));
  if (fan.triangle < 0 && !fan.clockwise) {
    fan.clockwise = true;
    fan.triangle = neighbor(fan.first, previous(index_of_vertex(fan.first, fan.center)));
  } else if (fan.triangle == fan.first) {
    fan.triangle = -1;
  }
  return false;
}

void MeshEditor::insert_edge(std::int32_t u, std::int32_t w) {
  check_stop_();
  const std::int32_t at_u = triangle_of_[static_cast<std::size_t>(u)], at_w = triangle_of_[static_cast<std::size_t>(w)];
  Fan from_u{u, at_u, at_u}, from_w{w, at_w, at_w};
  Edge edge{};
  bool crosses = false;
  for (;;) {  // in turns, as one of the ends may have very many triangles
    if (step(from_u, w, edge, crosses)) break;
    if (step(from_w, u, edge, crosses)) {
      std::swap(u, w);
      break;
    }
  }
  if (!crosses) return constrain(edge);
  clear_cavity(edge, u, w);
  free_ = crossed_;
  slits_.clear();
  // The left side as seen from u to w; the right side is the left one as seen from w to u.
  std::reverse(right_.chain.begin(), right_.chain.end());
  std::reverse(right_.beyond.begin(), right_.beyond.end());
  const std::int32_t left = fill(left_), right = fill(right_);
  neighbor(left, 2) = right;
  neighbor(right, 2) = left;
  join_slits();
  constrain({left, 2});
}

void MeshEditor::constrain(Edge edge) {
  const std::int32_t other = neighbor(edge.triangle, edge.k);
  flags_[static_cast<std::size_t>(edge.triangle)] |= static_cast<std::uint8_t>(1U << edge.k);
  if (other >= 0)
    flags_[static_cast<std::size_t>(other)] |= static_cast<std::uint8_t>(1U << index_of_neighbor(other, edge.triangle));
}

MeshEditor::Beyond MeshEditor::beyond(std::int32_t t, std::int32_t k) {
  const std::int32_t other = neighbor(t, k);
  return {{other, other < 0 ? -1 : index_of_neighbor(other, t)}, (flags_[static_cast<std::size_t>(t)] >> k & 1) != 0};
}

/// Collects the triangles between u and w that the edge crosses, and the sides of what they cover. `first`: the edge
/// opposite u in the first of them.
void MeshEditor::clear_cavity(Edge first, std::int32_t u, std::int32_t w) {
  crossed_by_.resize(flags_.size(), 0);
  ++edge_;
  crossed_.clear();
  std::int32_t t = first.triangle, k = first.k;
  right_ = {{u, vertex(t, next(k))}, {beyond(t, previous(k))}};
  left_ = {{u, vertex(t, previous(k))}, {beyond(t, next(k))}};
  for (;;) {
    crossed_.push_back(t);
    crossed_by_[static_cast<std::size_t>(t)] = edge_;
    if ((flags_[static_cast<std::size_t>(t)] >> k & 1) != 0)
      throw InternalError("triangles with crossings of segments: constrained edges cross");
    const std::int32_t other = neighbor(t, k), j = index_of_neighbor(other, t), p = vertex(other, j);
    t = other;  // p, left, right
    if (p == w) break;
    const int side = orientation(u, w, p);
    if (side == 0) throw InternalError("triangles with crossings of segments: a vertex lies on an edge");
    if (side > 0) {
      left_.chain.push_back(p);
      left_.beyond.push_back(beyond(t, previous(j)));
      k = next(j);
    } else {
      right_.chain.push_back(p);
      right_.beyond.push_back(beyond(t, next(j)));
      k = previous(j);
    }
  }
  crossed_.push_back(t);
  crossed_by_[static_cast<std::size_t>(t)] = edge_;
  const std::int32_t j = index_of_vertex(t, w);
  left_.chain.push_back(w);
  left_.beyond.push_back(beyond(t, previous(j)));
  right_.chain.push_back(w);
  right_.beyond.push_back(beyond(t, next(j)));
}

/// What is beyond an edge of the chain, from vertex `i` on, is across this edge.
void MeshEditor::close(const Side& side, std::int32_t i, Edge edge) {
  const Beyond& outer = side.beyond[static_cast<std::size_t>(i)];
  const std::int32_t from = side.chain[static_cast<std::size_t>(i)], to = side.chain[static_cast<std::size_t>(i) + 1];
  const auto [t, k] = outer.edge;
  neighbor(edge.triangle, edge.k) = t;
  if (outer.constrained) flags_[static_cast<std::size_t>(edge.triangle)] |= static_cast<std::uint8_t>(1U << edge.k);
  if (t >= 0 && crossed_by_[static_cast<std::size_t>(t)] == edge_)
    slits_.push_back({std::min(from, to), std::max(from, to), edge});
  else if (t >= 0)
    neighbor(t, k) = edge.triangle;
}

std::int32_t MeshEditor::take_triangle() {
  const std::int32_t t = free_.back();
  free_.pop_back();
  flags_[static_cast<std::size_t>(t)] = 0;
  return t;
}

/// Triangulates what is left of the edge from the first vertex of the chain to the last, up to the chain. Returns the
/// triangle at that edge, which is its edge 2. All vertices of a part of the chain are left of the edge between its
/// ends: each had an edge that crossed the new one, and these do not cross each other. A vertex from which a slit hangs
/// comes twice; what hangs there is between its edges that crossed, so inside its circle, and it is not chosen before
/// that. What is left of a chain that does not divide well is filled by random insertion.
std::int32_t MeshEditor::fill(const Side& side) {
  const auto at = [&](std::int32_t i) { return side.chain[static_cast<std::size_t>(i)]; };
  std::int32_t top = -1;
  ranges_.assign(1, {0, static_cast<std::int32_t>(side.chain.size()) - 1, {-1, -1}});
  std::int64_t work = std::int64_t{usual_work} * ranges_[0].high;
  while (!ranges_.empty()) {
    const auto [low, high, parent] = ranges_.back();
    ranges_.pop_back();
    if (high == low + 1) {
      close(side, low, parent);
      continue;
    }
    if (high - low > long_range) check_stop_();
    work -= high - low;
    if (work < 0 && high - low > long_range && parent.triangle >= 0) {
      if (fill_at_random(side, low, high, parent)) continue;
      work = std::int64_t{usual_work} * (high - low);
    }
    std::int32_t best = low + 1;  // the one whose circle with the ends has no other inside
    for (std::int32_t i = low + 2; i < high; ++i) {
      if (exact_.incircle_perturbed(in_.place(at(low)), in_.place(at(high)), in_.place(at(best)), in_.place(at(i))) > 0)
        best = i;
    }
    const std::int32_t t = take_triangle();
    set(t, {at(low), at(high), at(best)}, {-1, -1, parent.triangle});
    if (parent.triangle >= 0)
      neighbor(parent.triangle, parent.k) = t;
    else
      top = t;
    ranges_.push_back({best, high, {t, 0}});
    ranges_.push_back({low, best, {t, 1}});
  }
  return top;
}

/// The part of the chain from vertex `low` to `high`. False: that is not possible.
bool MeshEditor::fill_at_random(const Side& side, std::int32_t low, std::int32_t high, Edge parent) {
  std::vector<exact::Place> chain;
  for (std::int32_t i = low; i <= high; ++i) chain.push_back(in_.place(side.chain[static_cast<std::size_t>(i)]));
  const std::optional<ChainMesh> mesh = insert_at_random(exact_, chain, check_stop_);
  if (!mesh) return false;
  std::vector<std::int32_t> number(mesh->triangles.size());
  for (std::int32_t& t : number) t = take_triangle();
  for (std::size_t i = 0; i < number.size(); ++i) {
    std::array<std::int32_t, 3> vertices{}, neighbors{};
    for (std::size_t k = 0; k < 3; ++k) {
      vertices[k] = side.chain[static_cast<std::size_t>(low + mesh->triangles[i][k])];
      const std::int32_t other = mesh->across[3 * i + k];
      neighbors[k] = other < 0 ? -1 : number[static_cast<std::size_t>(other / 3)];
    }
    set(number[i], vertices, neighbors);
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh->across[3 * i + k] >= 0) continue;
      const std::int32_t a = mesh->triangles[i][(k + 1) % 3], b = mesh->triangles[i][(k + 2) % 3];
      const auto edge = static_cast<std::int32_t>(k);
      if (std::abs(a - b) == 1) {
        close(side, low + std::min(a, b), {number[i], edge});
      } else {
        neighbor(number[i], edge) = parent.triangle;
        neighbor(parent.triangle, parent.k) = number[i];
      }
    }
  }
  return true;
}

void MeshEditor::join_slits() {
  std::sort(slits_.begin(), slits_.end(),
            [](const Slit& a, const Slit& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  for (std::size_t i = 0; i + 1 < slits_.size(); i += 2) {
    const Edge a = slits_[i].edge, b = slits_[i + 1].edge;
    neighbor(a.triangle, a.k) = b.triangle;
    neighbor(b.triangle, b.k) = a.triangle;
  }
}

}  // namespace cadt::constraints
