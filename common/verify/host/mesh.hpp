// SPDX-License-Identifier: Apache-2.0
// The mesh that the checks of `verify` work on, and the checks.
#pragma once

#include "exact_sign.hpp"

#include <cadt/verify.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/platform/parallel.hpp"

namespace cadt::verifier {

using platform::reduce_each;

/// A directed edge of the boundary, from `from` to `to` with the mesh on its left. `edge` is 3 * triangle + k.
struct BoundaryEdge {
  std::int32_t from, to;
  std::int64_t edge;
};

/// Outcome of one check; the lowest failing index is kept, so it is the same for every number of threads.
struct Findings {
  std::uint64_t failures = 0, examined = 0;
  std::int64_t first = -1;

  void fail(std::size_t where) {
    ++failures;
    const auto w = static_cast<std::int64_t>(where);
    if (first < 0 || w < first) first = w;
  }
  void merge(const Findings& other) {
    if (other.first >= 0 && (first < 0 || other.first < first)) first = other.first;
    failures += other.failures;
    examined += other.examined;
  }
};

struct Mesh {
  PointsView points;
  std::size_t count = 0;                      // triangles
  std::span<const std::int32_t> triangles;    // 3 * count
  std::span<const std::int32_t> neighbors;    // 3 * count; those of the caller, or `derived`
  std::span<const std::uint32_t> edge_flags;  // count, or empty: no edge is constrained
  std::vector<std::int32_t> derived;
  std::vector<std::uint8_t> used;      // per point: whether it is a vertex
  std::size_t vertices = 0;            // number of vertices
  std::vector<BoundaryEdge> boundary;  // ascending by `from` once collected
  std::vector<std::int32_t> loop;      // the boundary cycle from its smallest index on
  unsigned threads = 1;

  [[nodiscard]] Point point(std::int32_t i) const {
    const auto k = static_cast<std::size_t>(i);
    return {points.x(k), points.y(k)};
  }
  [[nodiscard]] std::int32_t vertex(std::size_t t, std::size_t k) const { return triangles[3 * t + k]; }
  /// Whether edge k of triangle t is constrained.
  [[nodiscard]] bool constrained(std::size_t t, std::size_t k) const {
    return !edge_flags.empty() && (edge_flags[t] >> k & 1U) != 0;
  }
  [[nodiscard]] std::string describe_triangle(std::int64_t t) const;
  [[nodiscard]] std::string describe_edge(std::int64_t edge) const;
};

constexpr std::size_t next3(std::size_t k) { return k == 2 ? 0 : k + 1; }
constexpr std::size_t previous3(std::size_t k) { return k == 0 ? 2 : k - 1; }

// Each check fills passed, failures, first and what. They run in this order; a check may rely on the ones named.
void check_range(Mesh& mesh, Check& check);                                       // sets used, vertices
void check_neighbors(const Mesh& mesh, Check& check, std::uint64_t& examined);    // after range
void derive_neighbors(Mesh& mesh, Check& check, std::uint64_t& examined);         // after range
void check_orientation(const Mesh& mesh, Check& check, std::uint64_t& examined);  // after range
void check_vertices(const Mesh& mesh, const MeshView& view, Check& check);        // after range
void check_collinear(const Mesh& mesh, const MeshView& view, Check& check);       // instead, without triangles
void check_boundary(Mesh& mesh, Check& check);     // after neighbors; sets boundary, loop
void check_euler(const Mesh& mesh, Check& check);  // after boundary has been collected
void check_hull(const Mesh& mesh, std::span<const std::int32_t> given, Check& check);  // after boundary
void check_delaunay(const Mesh& mesh, Check& delaunay, Check& ties, const VerifyOptions& options,
                    VerifyReport& report);  // after neighbors and orientation

// Parts of these that the verifier on the device uses as well (common/verify/device/verify_on_device.cpp).

/// Interior edges: illegal ones, and cocircular ones that are not decided as by the symbolic perturbation.
struct Circles {
  Findings illegal, unusual;
  std::uint64_t ties = 0;
  /// The edge (3 * triangle + k) of the triangle a, b, c that d lies across.
  void examine(std::size_t edge, const Point& a, const Point& b, const Point& c, const Point& d);
  void merge(const Circles& other) {
    illegal.merge(other.illegal);
    unusual.merge(other.unusual);
    ties += other.ties;
  }
};

/// check_boundary once mesh.boundary is filled, in any order.
void link_boundary(Mesh& mesh, Check& check);
/// Euler's formula alone, and connectedness alone.
void check_euler_formula(const Mesh& mesh, Check& check);
void check_connected(const Mesh& mesh, Check& check);
/// check_hull with the points of the loop.
void check_hull(std::span<const std::int32_t> loop, std::span<const Point> corners, std::span<const std::int32_t> given,
                unsigned threads, Check& check);

/// Sets the outcome from findings; `what()` describes the first failure, if there is one.
template <class What>
void conclude(Check& check, const Findings& findings, const What& what) {
  check.failures = findings.failures;
  check.first = findings.first;
  check.passed = findings.failures == 0;
  check.what = check.passed ? std::string() : what();
}
void fail(Check& check, std::int64_t first, const std::string& what);
void conclude_range(const Mesh& mesh, const Findings& findings, Check& check);
void conclude_neighbors(const Mesh& mesh, const Findings& findings, Check& check);
void conclude_orientation(const Mesh& mesh, const Findings& findings, Check& check);
void conclude_duplicates(std::span<const Duplicate> list, std::size_t expected, const Findings& findings, Check& check);
void conclude_delaunay(const Mesh& mesh, const Circles& circles, Check& delaunay, Check& ties,
                       const VerifyOptions& options, VerifyReport& report);

/// \throws InputError for the point of this index
[[noreturn]] void refuse_point(std::int64_t index);
/// Why the sizes of the arrays do not fit together; empty if they do.
[[nodiscard]] std::string size_error(PointsView points, const MeshView& view);
/// What the library's own result promises beyond a bare mesh.
void check_own_result(PointsView points, const Triangulation& mesh, VerifyReport& report);
[[nodiscard]] MeshView view_of(const Triangulation& mesh);

}  // namespace cadt::verifier
