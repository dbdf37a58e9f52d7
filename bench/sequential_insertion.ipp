// SPDX-License-Identifier: Apache-2.0
// The insertion, for either variant of the predicates (CADT_WIDE). The device text is included into an unnamed
// namespace, so that the two variants do not collide.
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "bench/sequential_insertion.hpp"

namespace {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"  // not all of it is needed here
#include "common/predicates/filtered_predicates.dev.h"
#pragma GCC diagnostic pop

/// A triangle, counterclockwise. One vertex may be the ghost, the point at infinity: such a triangle stands for what
/// lies outside of a hull edge, and makes the mesh a sphere without boundary.
struct Face {
  std::array<std::uint32_t, 3> vertex;
  /// Opposite each vertex the same edge as the neighbour has it: 4 * triangle + its vertex opposite the edge.
  std::array<std::uint32_t, 3> across;
};

constexpr std::uint32_t ghost = CADT_NONE;
constexpr std::uint32_t next(std::uint32_t k) { return CADT_NEXT(k); }
constexpr std::uint32_t previous(std::uint32_t k) { return CADT_PREV(k); }

class Insertion {
 public:
  Insertion(std::span<const double> xy, std::span<std::uint32_t> input_ids)
      : xy_(xy), input_ids_(input_ids), count_(static_cast<std::uint32_t>(input_ids.size())) {
    cadt_counters_clear(&counters_);
  }

  cadt::bench::SequentialMesh run() {
    if (!start()) return {};
    for (std::uint32_t p = 1; p < count_; ++p)
      if (p != second_ && p != third_) insert(p);
    return finite_triangles();
  }

 private:
  /// Where a point is: in a triangle, on an edge of it, or at a vertex of it.
  struct Place {
    enum class Kind { inside, edge, vertex } kind;
    std::uint32_t triangle, k;  ///< k: vertex opposite the edge, or the vertex
  };

  [[nodiscard]] cadt_point at(std::uint32_t v) const { return {xy_[2 * std::size_t{v}], xy_[2 * std::size_t{v} + 1]}; }
  [[nodiscard]] int orientation(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return cadt_orientation(at(a), at(b), at(c), &counters_);
  }
  void link(std::uint32_t edge, std::uint32_t other) { faces_[edge >> 2].across[edge & 3u] = other; }

  /// The seed triangle, of the first points that are not collinear, and the three ghost triangles outside of its edges.
  bool start() {
    const auto equal = [&](std::uint32_t a, std::uint32_t b) { return at(a).x == at(b).x && at(a).y == at(b).y; };
    second_ = 1;
    while (second_ < count_ && equal(0, second_)) ++second_;
    third_ = second_ + 1;
    while (third_ < count_ && orientation(0, second_, third_) == 0) ++third_;
    if (third_ >= count_) return false;
    faces_.reserve(2 * std::size_t{count_});  // Euler: 2 * vertices - 4, the ghost being one of them
    std::array<std::uint32_t, 3> v = {0, second_, third_};
    if (orientation(0, second_, third_) < 0) v = {0, third_, second_};
    faces_.push_back({v, {4, 8, 12}});
    for (std::uint32_t k = 0; k < 3; ++k) {
      // Opposite vertex k of the seed: triangle k + 1, its ghost first. The other two are adjacent to it.
      const std::uint32_t after = 4 * (next(k) + 1), before = 4 * (previous(k) + 1);
      faces_.push_back({{ghost, v[previous(k)], v[next(k)]}, {k, before + 2, after + 1}});
    }
    return true;
  }

  void insert(std::uint32_t p) {
    const Place place = locate(p);
    switch (place.kind) {
      case Place::Kind::inside:
        return split_triangle(place.triangle, p);
      case Place::Kind::edge:
        return split_edge(place.triangle, place.k, p);
      case Place::Kind::vertex: {
        std::uint32_t& input_id = input_ids_[faces_[place.triangle].vertex[place.k]];
        input_id = cadt_min_u32(input_id, input_ids_[p]);
        recent_ = place.triangle;
      }
    }
  }

  /// Walks from the triangle of the last point across edges that have p on their other side. With exact signs this
  /// terminates in a Delaunay triangulation.
  [[nodiscard]] Place locate(std::uint32_t p) {
    const cadt_point q = at(p);
    std::uint32_t t = recent_;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (faces_[t].vertex[k] != ghost) continue;
      t = faces_[t].across[k] >> 2;
      break;
    }
    // The edge just crossed has p strictly on this side, so it is not tested again.
    std::uint32_t k = 0, left = 3, zeros = 0, zero_sum = 0;
    while (left > 0) {
      const Face& face = faces_[t];
      const int side = cadt_orientation(at(face.vertex[next(k)]), at(face.vertex[previous(k)]), q, &counters_);
      if (side >= 0) {
        if (side == 0) ++zeros, zero_sum += k;
        k = next(k);
        --left;
        continue;
      }
      const std::uint32_t edge = face.across[k];
      t = edge >> 2;
      if (faces_[t].vertex[edge & 3u] == ghost) return {Place::Kind::inside, t, 0};
      k = next(edge & 3u);
      left = 2;
      zeros = zero_sum = 0;
    }
    if (zeros == 0) return {Place::Kind::inside, t, 0};
    // A point on two edges is at their common vertex, the one opposite the third.
    if (zeros == 1) return {Place::Kind::edge, t, zero_sum};
    return {Place::Kind::vertex, t, 3 - zero_sum};
  }

  [[nodiscard]] std::uint32_t new_record() {
    faces_.emplace_back();
    return static_cast<std::uint32_t>(faces_.size() - 1);
  }

  void split_triangle(std::uint32_t t, std::uint32_t p) {
    const Face old = faces_[t];
    const std::array<std::uint32_t, 3> triangles = {t, new_record(), new_record()};
    const auto& e = old.across;
    fan<3>(p, triangles, old.vertex, {e[2], e[0], e[1]});
  }

  void split_edge(std::uint32_t t, std::uint32_t k, std::uint32_t p) {
    const Face a = faces_[t];
    const std::uint32_t s = a.across[k] >> 2, j = a.across[k] & 3u;
    const Face b = faces_[s];
    fan<4>(p, {t, s, new_record(), new_record()}, {a.vertex[k], a.vertex[next(k)], b.vertex[j], a.vertex[previous(k)]},
           {a.across[previous(k)], b.across[next(j)], b.across[previous(j)], a.across[next(k)]});
  }

  /// Creates the triangles between p and the edges of a polygon around it, counterclockwise; edge i starts at vertex i.
  /// Then flips the edges that p has made illegal.
  template <std::size_t n>
  void fan(std::uint32_t p, const std::array<std::uint32_t, n>& triangles, const std::array<std::uint32_t, n>& rim,
           const std::array<std::uint32_t, n>& outer) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t after = (i + 1) % n, before = (i + n - 1) % n;
      faces_[triangles[i]] = {{p, rim[i], rim[after]}, {outer[i], 4 * triangles[after] + 2, 4 * triangles[before] + 1}};
      link(outer[i], 4 * triangles[i]);
      stack_.push_back(triangles[i]);
    }
    recent_ = triangles[0];
    legalise(p);
  }

  /// Whether the edge u, v of the triangle p, u, v is illegal, with w on its other side.
  [[nodiscard]] bool illegal(std::uint32_t p, std::uint32_t u, std::uint32_t v, std::uint32_t w) {
    if (w == ghost) return false;
    // Circles through infinity are lines: the half-plane outside of a hull edge.
    if (u == ghost) return orientation(w, v, p) > 0;
    if (v == ghost) return orientation(u, w, p) > 0;
    return cadt_incircle(at(w), at(v), at(u), at(p), &counters_) > 0;
  }

  /// Tests the edges opposite p in the triangles on the stack, and those that flips add. All triangles have p first.
  void legalise(std::uint32_t p) {
    while (!stack_.empty()) {
      const std::uint32_t t = stack_.back();
      Face& own = faces_[t];
      const std::uint32_t s = own.across[0] >> 2, j = own.across[0] & 3u;
      Face& other = faces_[s];
      const std::uint32_t u = own.vertex[1], v = own.vertex[2], w = other.vertex[j];
      if (!illegal(p, u, v, w)) {
        stack_.pop_back();
        continue;
      }
      const std::uint32_t beyond_u = other.across[next(j)], beyond_v = other.across[previous(j)], side = own.across[1];
      own.vertex[2] = w;
      own.across[0] = beyond_u;
      own.across[1] = 4 * s + 2;
      other = {{p, w, v}, {beyond_v, side, 4 * t + 1}};
      link(beyond_u, 4 * t);
      link(beyond_v, 4 * s);
      link(side, 4 * s + 1);
      stack_.push_back(s);
    }
  }

  [[nodiscard]] cadt::bench::SequentialMesh finite_triangles() const {
    cadt::bench::SequentialMesh mesh;
    mesh.triangles.reserve(faces_.size());
    for (const Face& face : faces_) {
      const auto& v = face.vertex;
      if (v[0] == ghost || v[1] == ghost || v[2] == ghost) continue;
      const auto input_id = [&](std::uint32_t k) { return static_cast<std::int32_t>(input_ids_[v[k]]); };
      mesh.triangles.push_back({input_id(0), input_id(1), input_id(2)});
    }
    return mesh;
  }

  std::span<const double> xy_;
  std::span<std::uint32_t> input_ids_;
  std::uint32_t count_, second_ = 0, third_ = 0;
  std::uint32_t recent_ = 0;  ///< a triangle of the last point
  std::vector<Face> faces_;
  std::vector<std::uint32_t> stack_;
  cadt_counters counters_;
};

}  // namespace
