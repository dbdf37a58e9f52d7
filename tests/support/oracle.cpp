// SPDX-License-Identifier: Apache-2.0
#include "tests/support/oracle.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <chrono>
#include <cstddef>
#include <utility>

namespace cadt::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, Structure>;
using PlainDelaunay = CGAL::Delaunay_triangulation_2<Kernel>;

}  // namespace

OracleMesh cgal_delaunay(std::span<const double> xy) {
  OracleMesh mesh;
  mesh.representative = representatives(xy);
  std::vector<std::pair<Kernel::Point_2, std::int32_t>> distinct;
  distinct.reserve(mesh.representative.size());
  for (std::size_t i = 0; i < mesh.representative.size(); ++i) {
    if (mesh.representative[i] != static_cast<std::int32_t>(i)) continue;
    distinct.emplace_back(Kernel::Point_2(xy[2 * i], xy[2 * i + 1]), static_cast<std::int32_t>(i));
  }
  const Delaunay delaunay(distinct.begin(), distinct.end());
  mesh.dimension = delaunay.dimension();
  if (mesh.dimension < 2) return mesh;
  mesh.triangles.reserve(delaunay.number_of_faces());
  for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
    mesh.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  make_canonical(mesh.triangles);
  return mesh;
}

InsertionTime cgal_insertion(std::span<const double> xy) {
  std::vector<Kernel::Point_2> points;
  points.reserve(xy.size() / 2);
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) points.emplace_back(xy[i], xy[i + 1]);
  PlainDelaunay delaunay;
  const auto start = std::chrono::steady_clock::now();
  delaunay.insert(points.begin(), points.end());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {delaunay.number_of_faces(), taken.count()};
}

}  // namespace cadt::test
