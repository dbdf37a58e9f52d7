// SPDX-License-Identifier: Apache-2.0
#include "tests/support/oracle_constrained.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

namespace cadt::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Structure = CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>,
                                                       CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Constrained = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_intersections_tag>;
using Plus = CGAL::Constrained_triangulation_plus_2<Constrained>;
using Point = Kernel::Point_2;
using Exact = CGAL::Exact_rational;

/// From the two doubles next to an approximation.
double nearest(const Kernel::FT& number) {
  const Exact exact = CGAL::exact(number);
  double best = CGAL::to_double(exact);
  const auto distance = [&](double v) { return CGAL::abs(Exact(exact - Exact(v))); };
  for (bool moved = true; moved;) {
    moved = false;
    for (const double to : {-1.0, 1.0}) {
      const double other = std::nextafter(best, to * std::numeric_limits<double>::infinity());
      if (std::isinf(other)) continue;
      const auto order = CGAL::compare(distance(other), distance(best));
      std::uint64_t bits;
      static_assert(sizeof bits == sizeof other);
      std::memcpy(&bits, &other, sizeof bits);
      if (order == CGAL::SMALLER || (order == CGAL::EQUAL && bits % 2 == 0)) best = other, moved = true;
    }
  }
  return best;
}

}  // namespace

CrossedOracleMesh cgal_constrained_plus(std::span<const double> xy,
                                        std::span<const std::array<std::int32_t, 2>> segments,
                                        std::span<const std::array<std::int32_t, 2>> pairs) {
  const auto point = [&](std::int32_t i) {
    const auto k = 2 * static_cast<std::size_t>(i);
    return Point(xy[k], xy[k + 1]);
  };
  const auto n = static_cast<std::int32_t>(xy.size() / 2);
  std::map<Point, std::int32_t> numbers;
  for (std::int32_t i = 0; i < n; ++i) numbers.emplace(point(i), i);
  CrossedOracleMesh mesh;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto line = [&](std::size_t k) {
      const auto& s = segments[static_cast<std::size_t>(pairs[p][k])];
      return Kernel::Line_2(point(s[0]), point(s[1]));
    };
    const auto common = CGAL::intersection(line(0), line(1));
    const auto* where = common ? boost::get<Point>(&*common) : nullptr;
    if (where == nullptr) {
      ++mesh.unknown;
      continue;
    }
    numbers.emplace(*where, n + static_cast<std::int32_t>(p));
    mesh.added_xy.insert(mesh.added_xy.end(), {nearest(where->x()), nearest(where->y())});
  }
  Plus plus;
  for (std::int32_t i = 0; i < n; ++i) plus.insert(point(i));
  for (const auto& s : segments)
    if (point(s[0]) != point(s[1])) plus.insert_constraint(point(s[0]), point(s[1]));
  const auto number = [&](Plus::Vertex_handle v) {
    const auto found = numbers.find(v->point());
    if (found != numbers.end()) return found->second;
    ++mesh.unknown;
    return std::int32_t{-1};
  };
  if (plus.dimension() < 2) return mesh;
  for (auto f = plus.finite_faces_begin(); f != plus.finite_faces_end(); ++f)
    mesh.triangles.push_back({number(f->vertex(0)), number(f->vertex(1)), number(f->vertex(2))});
  make_canonical(mesh.triangles);
  for (auto e = plus.finite_edges_begin(); e != plus.finite_edges_end(); ++e) {
    if (!plus.is_constrained(*e)) continue;
    const std::int32_t a = number(e->first->vertex(Plus::cw(e->second)));
    const std::int32_t b = number(e->first->vertex(Plus::ccw(e->second)));
    mesh.constrained.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(mesh.constrained.begin(), mesh.constrained.end());
  return mesh;
}

}  // namespace cadt::test
