// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact_mesh/mesh_editor.hpp"

#include <cadt/errors.hpp>

namespace cadt::constraints {

using exact::Place;

MeshEditor::MeshEditor(const Arrangement& arrangement, std::vector<std::int32_t> triangles,
                       std::vector<std::int32_t> neighbors, const StopCheck& check_stop)
    : in_(arrangement),
      check_stop_(check_stop),
      exact_(arrangement.lines),
      vertices_(std::move(triangles)),
      neighbors_(std::move(neighbors)) {
  const std::size_t vertices = in_.points.size() + in_.crossings.size();
  const std::size_t most =
      vertices_.size() + 6 * in_.crossings.size();  // each vertex inside the hull makes two triangles
  vertices_.reserve(most);
  neighbors_.reserve(most);
  flags_.reserve(most / 3);
  flags_.resize(vertices_.size() / 3);
  triangle_of_.assign(vertices, -1);
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    triangle_of_[static_cast<std::size_t>(vertices_[i])] = static_cast<std::int32_t>(i / 3);
  on_chain_.assign(vertices, 0);
}

std::int32_t MeshEditor::index_of_neighbor(std::int32_t t, std::int32_t other) {
  for (std::int32_t k = 0; k < 3; ++k)
    if (neighbor(t, k) == other) return k;
  throw InternalError("triangles with crossings of segments: a neighbour does not know its neighbour");
}

std::int32_t MeshEditor::index_of_vertex(std::int32_t t, std::int32_t v) {
  return vertex(t, 0) == v ? 0 : (vertex(t, 1) == v ? 1 : 2);
}

// Vertices of the chain that is inserted are on a line: no long number has to say so.
int MeshEditor::orientation(std::int32_t a, std::int32_t b, std::int32_t c) const {
  if (chain_ != 0 && on_chain_[static_cast<std::size_t>(a)] == chain_ &&
      on_chain_[static_cast<std::size_t>(b)] == chain_ && on_chain_[static_cast<std::size_t>(c)] == chain_)
    return 0;
  return exact_.orientation(in_.place(a), in_.place(b), in_.place(c));
}

void MeshEditor::set(std::int32_t t, std::array<std::int32_t, 3> vertices, std::array<std::int32_t, 3> neighbors) {
  for (std::int32_t k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    vertex(t, k) = vertices[i];
    neighbor(t, k) = neighbors[i];
    triangle_of_[static_cast<std::size_t>(vertices[i])] = t;
  }
}

void MeshEditor::replace_neighbor(std::int32_t t, std::int32_t from, std::int32_t to) {
  if (t >= 0) neighbor(t, index_of_neighbor(t, from)) = to;
}

std::int32_t MeshEditor::add_triangle() {
  const auto t = static_cast<std::int32_t>(flags_.size());
  vertices_.resize(vertices_.size() + 3);
  neighbors_.resize(neighbors_.size() + 3);
  flags_.push_back(0);
  return t;
}

// A vertex on an edge makes a triangle without area. The point beyond that edge is in its circle, which is a
// half-plane, so the edge is flipped.
void MeshEditor::insert_vertex(std::int32_t v) {
  const Place p = in_.place(v);
  std::int32_t t = last_, from = -1;
  for (std::int32_t k = 0; k < 3;) {
    const bool came = from >= 0 && neighbor(t, k) == from;
    if (came || exact_.orientation(in_.place(vertex(t, next(k))), in_.place(vertex(t, previous(k))), p) >= 0) {
      ++k;
      continue;
    }
    from = t;
    t = neighbor(t, k);
    k = 0;
    if (t < 0) throw InternalError("triangles with crossings of segments: a crossing is outside of the hull");
  }
  divide_triangle(t, v);
  legalize();
  last_ = triangle_of_[static_cast<std::size_t>(v)];
}

void MeshEditor::divide_triangle(std::int32_t t, std::int32_t p) {
  const std::int32_t a = vertex(t, 0), b = vertex(t, 1), c = vertex(t, 2);
  const std::int32_t na = neighbor(t, 0), nb = neighbor(t, 1), nc = neighbor(t, 2);
  const std::int32_t t1 = add_triangle(), t2 = add_triangle();
  set(t, {p, b, c}, {na, t1, t2});
  set(t1, {p, c, a}, {nb, t2, t});
  set(t2, {p, a, b}, {nc, t, t1});
  replace_neighbor(nb, t, t1);
  replace_neighbor(nc, t, t2);
  suspects_.insert(suspects_.end(), {t, t1, t2});
}

/// Flips the edge opposite vertex 0.
void MeshEditor::flip(std::int32_t t) {
  const std::int32_t u = neighbor(t, 0), j = index_of_neighbor(u, t);
  const std::int32_t p = vertex(t, 0), a = vertex(t, 1), b = vertex(t, 2), q = vertex(u, j);
  const std::int32_t bp = neighbor(t, 1), pa = neighbor(t, 2);
  const std::int32_t aq = neighbor(u, next(j)), qb = neighbor(u, previous(j));  // u is q, b, a
  set(t, {p, a, q}, {aq, u, pa});
  set(u, {p, q, b}, {qb, bp, t});
  replace_neighbor(aq, u, t);
  replace_neighbor(bp, t, u);
}

void MeshEditor::legalize() {
  while (!suspects_.empty()) {
    const std::int32_t t = suspects_.back(), u = neighbor(t, 0);
    suspects_.pop_back();
    if (u < 0) continue;
    const std::int32_t q = vertex(u, index_of_neighbor(u, t));
    if (exact_.incircle_perturbed(in_.place(vertex(t, 0)), in_.place(vertex(t, 1)), in_.place(vertex(t, 2)),
                                  in_.place(q)) <= 0)
      continue;
    flip(t);
    suspects_.insert(suspects_.end(), {t, u});
  }
}

}  // namespace cadt::constraints
