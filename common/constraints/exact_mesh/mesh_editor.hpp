// SPDX-License-Identifier: Apache-2.0
// A triangulation on the host into which points and edges are inserted one after the other, by exact predicates for
// implicit points.
#pragma once

#include "common/constraints/crossings/arrangement.hpp"
#include "common/constraints/stop_check.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::constraints {

/// Vertices are those of the arrangement. Triangles are counterclockwise; edge k is opposite vertex k.
class MeshEditor {
 public:
  /// A Delaunay triangulation of all points of the arrangement, with its vertices. The arrangement must outlive this
  /// object. `check_stop` ends the insertion of a chain.
  MeshEditor(const Arrangement& arrangement, std::vector<std::int32_t> triangles, std::vector<std::int32_t> neighbors,
             const StopCheck& check_stop = {});

  /// Inserts a vertex into the Delaunay triangulation: the triangle that it is in is divided, then edges are flipped
  /// (C. L. Lawson, "Software for C1 surface interpolation", 1977). The search begins where the last one ended. \pre
  /// the vertex is strictly inside the hull, and no edge is constrained yet. \throws InternalError
  void insert_vertex(std::int32_t vertex);

  /// Makes the edges between consecutive vertices of a wall's chain constrained ones, and the rest Delaunay again: the
  /// triangles that an edge crosses go, and both sides are triangulated anew (M. V. Anglada, "An improved incremental
  /// algorithm for constructing restricted Delaunay triangulations", Computers & Graphics 21, 1997). O(degree of the
  /// end that has fewer edges + k log k) for k crossed triangles, expected. \throws InternalError
  void insert_chain(std::span<const std::int32_t> chain);

  [[nodiscard]] const std::vector<std::int32_t>& triangles() const { return vertices_; }
  [[nodiscard]] const std::vector<std::int32_t>& neighbors() const { return neighbors_; }
  /// Bit k: edge k is constrained.
  [[nodiscard]] const std::vector<std::uint8_t>& flags() const { return flags_; }

 private:
  /// An edge of a triangle, by its number.
  struct Edge {
    std::int32_t triangle, k;
  };
  /// A side of a cavity: vertices along it, and what is beyond the edge from each to the next.
  struct Beyond {
    Edge edge;  // of the triangle there; -1 outside
    bool constrained;
  };
  struct Side {
    std::vector<std::int32_t> chain;
    std::vector<Beyond> beyond;
  };
  struct Fan;

  [[nodiscard]] static std::int32_t next(std::int32_t k) { return k == 2 ? 0 : k + 1; }
  [[nodiscard]] static std::int32_t previous(std::int32_t k) { return k == 0 ? 2 : k - 1; }
  [[nodiscard]] std::int32_t& vertex(std::int32_t t, std::int32_t k) {
    return vertices_[static_cast<std::size_t>(3 * t + k)];
  }
  [[nodiscard]] std::int32_t& neighbor(std::int32_t t, std::int32_t k) {
    return neighbors_[static_cast<std::size_t>(3 * t + k)];
  }
  [[nodiscard]] std::int32_t index_of_neighbor(std::int32_t t, std::int32_t other);
  [[nodiscard]] std::int32_t index_of_vertex(std::int32_t t, std::int32_t v);
  [[nodiscard]] int orientation(std::int32_t a, std::int32_t b, std::int32_t c) const;
  void set(std::int32_t t, std::array<std::int32_t, 3> vertices, std::array<std::int32_t, 3> neighbors);
  void replace_neighbor(std::int32_t t, std::int32_t from, std::int32_t to);
  [[nodiscard]] std::int32_t add_triangle();

  void divide_triangle(std::int32_t t, std::int32_t v);
  void flip(std::int32_t t);
  void legalize();

  void insert_edge(std::int32_t u, std::int32_t w);
  bool step(Fan& fan, std::int32_t target, Edge& found, bool& crosses);
  void constrain(Edge edge);
  void clear_cavity(Edge first, std::int32_t u, std::int32_t w);
  [[nodiscard]] Beyond beyond(std::int32_t t, std::int32_t k);
  void close(const Side& side, std::int32_t i, Edge edge);
  [[nodiscard]] std::int32_t take_triangle();
  [[nodiscard]] std::int32_t fill(const Side& side);
  [[nodiscard]] bool fill_at_random(const Side& side, std::int32_t low, std::int32_t high, Edge parent);
  void join_slits();

  const Arrangement& in_;
  StopCheck check_stop_;
  exact::ImplicitPoints exact_;
  std::vector<std::int32_t> vertices_, neighbors_, triangle_of_;
  std::vector<std::uint8_t> flags_;
  std::int32_t last_ = 0;
  std::vector<std::int32_t> suspects_;  // triangles whose vertex 0 is new

  std::vector<std::int32_t> on_chain_;  // for each vertex the last chain that it was on
  std::int32_t chain_ = 0;
  std::vector<std::int32_t> crossed_, free_;
  std::vector<std::int32_t> crossed_by_;  // for each triangle the last edge that crossed it
  std::int32_t edge_ = 0;
  Side left_, right_;
  struct Slit {
    std::int32_t low, high;
    Edge edge;
  };
  std::vector<Slit> slits_;  // edges of the cavity with the cavity on both sides
  struct Range {
    std::int32_t low, high;
    Edge parent;
  };
  std::vector<Range> ranges_;
};

}  // namespace cadt::constraints
