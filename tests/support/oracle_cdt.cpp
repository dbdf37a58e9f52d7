// SPDX-License-Identifier: Apache-2.0
#include "tests/support/oracle_cdt.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace cadt::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Constrained =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

}  // namespace

ConstrainedOracleMesh cgal_constrained(std::span<const double> xy,
                                       std::span<const std::array<std::int32_t, 2>> segments) {
  ConstrainedOracleMesh result;
  OracleMesh& mesh = result.mesh;
  mesh.representative = representatives(xy);
  std::vector<std::pair<Kernel::Point_2, std::int32_t>> distinct;
  for (std::size_t i = 0; i < mesh.representative.size(); ++i)
    if (mesh.representative[i] == static_cast<std::int32_t>(i))
      distinct.emplace_back(Kernel::Point_2(xy[2 * i], xy[2 * i + 1]), static_cast<std::int32_t>(i));
  const auto start = std::chrono::steady_clock::now();
  Constrained cdt;
  cdt.insert(distinct.begin(), distinct.end());
  std::vector<Constrained::Vertex_handle> handles(mesh.representative.size());
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v)
    handles[static_cast<std::size_t>(v->info())] = v;
  const auto vertex = [&](std::int32_t i) {
    return handles[static_cast<std::size_t>(mesh.representative[static_cast<std::size_t>(i)])];
  };
  for (const auto& [a, b] : segments)
    if (vertex(a) != vertex(b)) cdt.insert_constraint(vertex(a), vertex(b));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  mesh.dimension = cdt.dimension();
  for (auto e = cdt.finite_edges_begin(); e != cdt.finite_edges_end(); ++e) {
    if (!cdt.is_constrained(*e)) continue;
    const auto [low, high] =
        std::minmax({e->first->vertex(cdt.ccw(e->second))->info(), e->first->vertex(cdt.cw(e->second))->info()});
    result.edges.push_back({low, high});
  }
  std::ranges::sort(result.edges);
  if (mesh.dimension < 2) return result;
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face)
    mesh.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  make_canonical(mesh.triangles);
  return result;
}

}  // namespace cadt::test
