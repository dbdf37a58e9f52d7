// SPDX-License-Identifier: Apache-2.0
// Checks without geometry: index ranges, the boundary cycle, Euler's formula. Together with positive orientation and a
// convex boundary that is wound once they make the mesh a triangulation of the hull: O. Devillers, G. Liotta, F. P.
// Preparata, R. Tamassia, "Checking the convexity of polytopes and the planarity of subdivisions" (1998).
#include "mark.hpp"
#include "mesh.hpp"

#include <algorithm>
#include <numeric>

namespace cadt::verifier {

std::string Mesh::describe_triangle(std::int64_t t) const {
  const auto k = static_cast<std::size_t>(t);
  return "triangle " + std::to_string(t) + " (" + std::to_string(vertex(k, 0)) + " " + std::to_string(vertex(k, 1)) +
         " " + std::to_string(vertex(k, 2)) + ")";
}

std::string Mesh::describe_edge(std::int64_t edge) const {
  const auto t = static_cast<std::size_t>(edge / 3), k = static_cast<std::size_t>(edge % 3);
  return "the edge opposite vertex " + std::to_string(k) + " of " + describe_triangle(edge / 3) + ", from " +
         std::to_string(vertex(t, next3(k))) + " to " + std::to_string(vertex(t, previous3(k)));
}

void fail(Check& check, std::int64_t first, const std::string& what) {
  check.passed = false;
  check.failures = 1;
  check.first = first;
  check.what = what;
}

void check_range(Mesh& mesh, Check& check) {
  const auto points = static_cast<std::int64_t>(mesh.points.size());
  const auto count = static_cast<std::int64_t>(mesh.count);
  mesh.used.assign(mesh.points.size(), 0);
  const Findings findings = reduce_each<Findings>(mesh.count, mesh.threads, [&](std::size_t t, Findings& mine) {
    bool good = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t v = mesh.vertex(t, k);
      if (v < 0 || v >= points || v == mesh.vertex(t, next3(k))) {
        good = false;
      } else {
        // Many triangles share a vertex; all of them write the same value.
        mark(mesh.used[static_cast<std::size_t>(v)]);
      }
      if (!mesh.neighbors.empty()) {
        const std::int64_t s = mesh.neighbors[3 * t + k];
        good = good && s >= -1 && s < count;
      }
    }
    if (!good) mine.fail(t);
  });
  mesh.vertices = static_cast<std::size_t>(std::accumulate(mesh.used.begin(), mesh.used.end(), std::uint64_t{0}));
  conclude_range(mesh, findings, check);
}

void conclude_range(const Mesh& mesh, const Findings& findings, Check& check) {
  conclude(check, findings, [&] {
    return mesh.describe_triangle(findings.first) +
           " has an index out of range, a neighbour out of range or a vertex twice";
  });
}

namespace {

struct Edges {
  std::vector<BoundaryEdge> list;
  void merge(const Edges& other) { list.insert(list.end(), other.list.begin(), other.list.end()); }
};

}  // namespace

void check_boundary(Mesh& mesh, Check& check) {
  mesh.boundary = reduce_each<Edges>(mesh.count, mesh.threads, [&](std::size_t t, Edges& mine) {
                    for (std::size_t k = 0; k < 3; ++k)
                      if (mesh.neighbors[3 * t + k] < 0)
                        mine.list.push_back({mesh.vertex(t, next3(k)), mesh.vertex(t, previous3(k)),
                                             static_cast<std::int64_t>(3 * t + k)});
                  }).list;
  link_boundary(mesh, check);
}

void link_boundary(Mesh& mesh, Check& check) {
  std::vector<BoundaryEdge>& edges = mesh.boundary;
  std::sort(edges.begin(), edges.end(), [](const BoundaryEdge& a, const BoundaryEdge& b) {
    return a.from != b.from ? a.from < b.from : a.edge < b.edge;
  });
  if (edges.empty()) return fail(check, -1, "the mesh has no boundary");
  Findings findings;
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].from == edges[i - 1].from) findings.fail(static_cast<std::size_t>(edges[i].edge));
  if (findings.failures != 0)
    return conclude(check, findings, [&] {
      return mesh.describe_edge(findings.first) + ", is not the only boundary edge that leaves its start";
    });
  // Exactly one edge leaves each vertex. If a walk from the first edge comes back to it after all edges, the boundary
  // is one cycle.
  mesh.loop.reserve(edges.size());
  std::size_t at = 0;
  do {
    mesh.loop.push_back(edges[at].from);
    const auto it = std::lower_bound(edges.begin(), edges.end(), edges[at].to,
                                     [](const BoundaryEdge& e, std::int32_t v) { return e.from < v; });
    if (it == edges.end() || it->from != edges[at].to)
      return fail(check, edges[at].edge, mesh.describe_edge(edges[at].edge) + ", ends where no boundary edge starts");
    at = static_cast<std::size_t>(it - edges.begin());
  } while (at != 0 && mesh.loop.size() < edges.size());
  if (at != 0 || mesh.loop.size() != edges.size())
    return fail(check, edges[0].edge,
                "the boundary is not one cycle: the one at point " + std::to_string(edges[0].from) + " has " +
                    std::to_string(mesh.loop.size()) + " of " + std::to_string(edges.size()) + " edges");
  check.passed = true;
}

void check_euler(const Mesh& mesh, Check& check) {
  check_euler_formula(mesh, check);
  if (check.passed) check_connected(mesh, check);
}

void check_euler_formula(const Mesh& mesh, Check& check) {
  const auto triangles = static_cast<std::int64_t>(mesh.count);
  const auto expected =
      2 * static_cast<std::int64_t>(mesh.vertices) - 2 - static_cast<std::int64_t>(mesh.boundary.size());
  if (triangles != expected)
    return fail(check, -1,
                "there are " + std::to_string(triangles) + " triangles, Euler's formula asks for " +
                    std::to_string(expected) + " with " + std::to_string(mesh.vertices) + " vertices, " +
                    std::to_string(mesh.boundary.size()) + " of them on the boundary");
  check.passed = true;
}

void check_connected(const Mesh& mesh, Check& check) {
  std::vector<std::uint8_t> reached(mesh.count, 0);
  std::vector<std::int32_t> open{0};
  reached[0] = 1;
  std::size_t seen = 1;
  while (!open.empty()) {
    const auto t = static_cast<std::size_t>(open.back());
    open.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t s = mesh.neighbors[3 * t + k];
      if (s < 0 || reached[static_cast<std::size_t>(s)] != 0) continue;
      reached[static_cast<std::size_t>(s)] = 1;
      ++seen;
      open.push_back(s);
    }
  }
  if (seen != mesh.count) {
    const auto missing = std::find(reached.begin(), reached.end(), std::uint8_t{0}) - reached.begin();
    return fail(check, missing, mesh.describe_triangle(missing) + " is not connected with triangle 0");
  }
  check.passed = true;
}

}  // namespace cadt::verifier
