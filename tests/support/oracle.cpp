// SPDX-License-Identifier: Apache-2.0
#include "tests/support/oracle.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

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

LocatedFaces cgal_locate(std::span<const double> xy, std::span<const double> queries) {
  std::vector<std::pair<Kernel::Point_2, std::int32_t>> points, where;
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2)
    points.emplace_back(Kernel::Point_2(xy[i], xy[i + 1]), static_cast<std::int32_t>(i / 2));
  for (std::size_t i = 0; i + 1 < queries.size(); i += 2)
    where.emplace_back(Kernel::Point_2(queries[i], queries[i + 1]), static_cast<std::int32_t>(i / 2));
  const Delaunay delaunay(points.begin(), points.end());
  using Map = CGAL::First_of_pair_property_map<std::pair<Kernel::Point_2, std::int32_t>>;
  CGAL::spatial_sort(where.begin(), where.end(), CGAL::Spatial_sort_traits_adapter_2<Kernel, Map>());
  LocatedFaces found;
  found.faces.assign(where.size(), {-1, -1, -1});
  std::vector<Delaunay::Face_handle> faces(where.size());
  std::vector<char> inside(where.size());
  Delaunay::Face_handle hint;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < where.size(); ++i) {
    Delaunay::Locate_type type;
    int index;
    hint = delaunay.locate(where[i].first, type, index, hint);
    faces[i] = hint;
    inside[i] = type == Delaunay::FACE;
  }
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (std::size_t i = 0; i < where.size(); ++i) {
    if (!inside[i]) continue;
    std::vector<Triangle> one = {
        {faces[i]->vertex(0)->info(), faces[i]->vertex(1)->info(), faces[i]->vertex(2)->info()}};
    make_canonical(one);
    found.faces[static_cast<std::size_t>(where[i].second)] = one.front();
  }
  return found;
}

}  // namespace cadt::test
