// SPDX-License-Identifier: Apache-2.0
// Segments that must be edges, and polygons.
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "common/c_interface/convert.hpp"
#include "common/constraints/constraints.hpp"

using namespace cadt::c_interface;

struct cadt_constrained {
  cadt::ConstrainedTriangulation mesh;
};
struct cadt_crossings {
  std::vector<std::array<std::int32_t, 2>> pairs;
};
struct cadt_polygon_triangles {
  cadt::PolygonsResult result;
  std::vector<cadt_polygon_problem> problems;
};

namespace {

using cadt::Crossing, cadt::Domain, cadt::PolygonStatus;

static_assert(sizeof(cadt::Segment) == 2 * sizeof(std::int32_t));
static_assert(static_cast<int>(Crossing::error) == CADT_CROSSING_ERROR &&
              static_cast<int>(Crossing::exact) == CADT_CROSSING_EXACT &&
              static_cast<int>(Crossing::grid) == CADT_CROSSING_GRID);
static_assert(static_cast<int>(Domain::hull) == CADT_DOMAIN_HULL &&
              static_cast<int>(Domain::outer) == CADT_DOMAIN_OUTER &&
              static_cast<int>(Domain::even_odd) == CADT_DOMAIN_EVEN_ODD &&
              static_cast<int>(Domain::nonzero) == CADT_DOMAIN_NONZERO &&
              static_cast<int>(Domain::layers) == CADT_DOMAIN_LAYERS &&
              static_cast<int>(Domain::seeds) == CADT_DOMAIN_SEEDS);
static_assert(static_cast<int>(PolygonStatus::ok) == CADT_POLYGON_OK &&
              static_cast<int>(PolygonStatus::too_few_points) == CADT_POLYGON_TOO_FEW_POINTS &&
              static_cast<int>(PolygonStatus::not_finite) == CADT_POLYGON_NOT_FINITE &&
              static_cast<int>(PolygonStatus::self_crossing) == CADT_POLYGON_SELF_CROSSING &&
              static_cast<int>(PolygonStatus::ring_crossing) == CADT_POLYGON_RING_CROSSING &&
              static_cast<int>(PolygonStatus::zero_area) == CADT_POLYGON_ZERO_AREA);

std::span<const cadt::Segment> segments_of(const std::int32_t* segments, std::size_t count) {
  cadt::require_segments(count);
  if (count != 0) require(segments, "segments");
  return {reinterpret_cast<const cadt::Segment*>(segments), count};
}

cadt::ConstraintOptions constraints_of(const cadt_constraint_options* from) {
  cadt::ConstraintOptions result;
  if (from == nullptr) return result;
  const cadt_constraint_options given = take(from, "constraints");
  result.crossing = constant<Crossing>(given.crossing, CADT_CROSSING_GRID, "constraints->crossing");
  result.domain = constant<Domain>(given.domain, CADT_DOMAIN_SEEDS, "constraints->domain");
  result.grid = given.grid;
  if (given.hole_count != 0) require(given.holes, "constraints->holes");
  if (given.region_count != 0) require(given.regions, "constraints->regions");
  for (std::size_t i = 0; i < given.hole_count; ++i)
    result.holes.push_back({given.holes[2 * i], given.holes[2 * i + 1]});
  for (std::size_t i = 0; i < given.region_count; ++i)
    result.regions.push_back({given.regions[i].x, given.regions[i].y, given.regions[i].attribute});
  return result;
}

const cadt::ConstrainedTriangulation& mesh_of(const cadt_constrained* mesh) { return required(mesh, "mesh").mesh; }

/// A list of the mesh's, and its size in parts of `each` elements.
template <class T, class Element>
void give_list(std::span<const Element> list, std::size_t each, const T** array, std::size_t* count) {
  const T*& to = required(array, "array");
  required(count, "count") = list.size() / each;
  to = reinterpret_cast<const T*>(list.data());
}

std::span<const std::int64_t> offsets_of(const std::int64_t* offsets, std::size_t parts, const char* name) {
  require(offsets, name);
  if (parts > cadt::max_points())
    throw cadt::LimitError("at most " + std::to_string(cadt::max_points()) + " rings or polygons in one call", parts,
                           cadt::max_points());
  return {offsets, parts + 1};
}

}  // namespace

extern "C" {

cadt_status cadt_triangulate_constrained(const cadt_points* points, const int32_t* segments, size_t segment_count,
                                         const cadt_constraint_options* constraints, const cadt_options* options,
                                         cadt_constrained** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    const cadt::PointsView view = points_of(points);
    const auto between = segments_of(segments, segment_count);
    result = new cadt_constrained{
        cadt::triangulate_constrained(view, between, constraints_of(constraints), CallOptions(options).begin_call())};
  });
}

cadt_status cadt_triangulator_triangulate_constrained(cadt_triangulator* triangulator, const cadt_points* points,
                                                      const int32_t* segments, size_t segment_count,
                                                      const cadt_constraint_options* constraints,
                                                      cadt_constrained** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    cadt_triangulator& t = required(triangulator, "triangulator");
    const cadt::PointsView view = points_of(points);
    const auto between = segments_of(segments, segment_count);
    const cadt::ConstraintOptions how = constraints_of(constraints);
    result = new cadt_constrained{t.begin_call().triangulate_constrained(view, between, how)};
  });
}

void cadt_constrained_free(cadt_constrained* mesh) { delete mesh; }

cadt_status cadt_triangulator_triangulate_constrained_device(cadt_triangulator* triangulator,
                                                             const cadt_device_points* points,
                                                             const cadt_device_array* segments,
                                                             const cadt_constraint_options* constraints,
                                                             cadt_device_triangulation** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    cadt_triangulator& t = required(triangulator, "triangulator");
    const cadt::DevicePoints given = points_of(points);
    const cadt_device_array& between = required(segments, "segments");
    const cadt::ConstraintOptions how = constraints_of(constraints);
    result = new cadt_device_triangulation{
        t.begin_call().triangulate_constrained(given, cadt::DeviceArray{between.memory, between.size}, how)};
  });
}

cadt_status cadt_device_triangulation_constraints(const cadt_device_triangulation* mesh, void** edge_flags,
                                                  void** regions, void** triangles_inside, size_t* number_inside) {
  return guarded([&] {
    const cadt::DeviceTriangulation& m = required(mesh, "mesh").mesh;
    auto &flags = required(edge_flags, "edge_flags"), &of = required(regions, "regions"),
         &inside = required(triangles_inside, "triangles_inside");
    required(number_inside, "number_inside") = m.number_inside();
    flags = m.edge_flags();
    of = m.regions();
    inside = m.triangles_inside();
  });
}

cadt_status cadt_device_triangulation_regions(const cadt_device_triangulation* mesh, void** inside, void** values,
                                              void** attributes, size_t* count) {
  return guarded([&] {
    const cadt::DeviceTriangulation& m = required(mesh, "mesh").mesh;
    auto &flags = required(inside, "inside"), &value = required(values, "values"),
         &attribute = required(attributes, "attributes");
    required(count, "count") = m.number_of_regions();
    flags = m.inside();
    value = m.region_values();
    attribute = m.region_attributes();
  });
}

cadt_status cadt_device_triangulation_chains(const cadt_device_triangulation* mesh, void** offsets, void** vertices,
                                             size_t* length) {
  return guarded([&] {
    const cadt::DeviceTriangulation& m = required(mesh, "mesh").mesh;
    auto &begins = required(offsets, "offsets"), &along = required(vertices, "vertices");
    required(length, "length") = m.chain_length();
    begins = m.chain_offsets();
    along = m.chain_vertices();
  });
}

cadt_status cadt_device_triangulation_download_constrained(const cadt_device_triangulation* mesh,
                                                           cadt_constrained** copy) {
  return guarded([&] {
    auto& result = required(copy, "copy");
    result = new cadt_constrained{required(mesh, "mesh").mesh.download_constrained()};
  });
}

cadt_status cadt_device_triangulation_crossings(const cadt_device_triangulation* mesh, void** all_points,
                                                void** added_parents, size_t* count) {
  return guarded([&] {
    const cadt::DeviceTriangulation& m = required(mesh, "mesh").mesh;
    auto &points = required(all_points, "all_points"), &parents = required(added_parents, "added_parents");
    required(count, "count") = m.number_added();
    points = m.all_points();
    parents = m.added_parents();
  });
}

cadt_status cadt_constrained_mesh(const cadt_constrained* mesh, cadt_triangulation** triangles) {
  return guarded([&] {
    auto& result = required(triangles, "triangles");
    result = new cadt_triangulation{mesh_of(mesh).mesh()};
  });
}

cadt_status cadt_constrained_edge_flags(const cadt_constrained* mesh, const uint32_t** flags) {
  return guarded([&] { required(flags, "flags") = mesh_of(mesh).edge_flags().data(); });
}

cadt_status cadt_constrained_chains(const cadt_constrained* mesh, const int64_t** offsets, size_t* segments,
                                    const int32_t** vertices) {
  return guarded([&] {
    const auto& m = mesh_of(mesh);
    auto& begin = required(offsets, "offsets");
    auto& chain = required(vertices, "vertices");
    required(segments, "segments") = m.chain_offsets().size() - 1;
    begin = m.chain_offsets().data();
    chain = m.chain_vertices().data();
  });
}

cadt_status cadt_constrained_edges(const cadt_constrained* mesh, const int32_t** edges, size_t* count) {
  return guarded([&] { give_list(mesh_of(mesh).constrained_edges(), 1, edges, count); });
}

cadt_status cadt_constrained_sources(const cadt_constrained* mesh, const int64_t** offsets, const int32_t** sources) {
  return guarded([&] {
    const auto& m = mesh_of(mesh);
    auto& begin = required(offsets, "offsets");
    required(sources, "sources") = m.edge_sources().data();
    begin = m.source_offsets().data();
  });
}

cadt_status cadt_constrained_degenerate_segments(const cadt_constrained* mesh, const int32_t** segments,
                                                 size_t* count) {
  return guarded([&] { give_list(mesh_of(mesh).degenerate_segments(), 1, segments, count); });
}

cadt_status cadt_constrained_inside(const cadt_constrained* mesh, const uint8_t** inside, size_t* count) {
  return guarded([&] {
    const auto& m = mesh_of(mesh);
    auto& flags = required(inside, "inside");
    required(count, "count") = m.number_inside();
    flags = m.inside().data();
  });
}

cadt_status cadt_constrained_triangles_inside(const cadt_constrained* mesh, int32_t* triangles, size_t capacity,
                                              size_t* count) {
  return guarded([&] {
    const auto& m = mesh_of(mesh);
    if (has_room(triangles, capacity, 3 * m.number_inside(), count)) std::ranges::copy(m.triangles_inside(), triangles);
  });
}

cadt_status cadt_constrained_regions(const cadt_constrained* mesh, const int32_t** region, const int32_t** values,
                                     const double** attributes, size_t* count) {
  return guarded([&] {
    const auto& m = mesh_of(mesh);
    auto &of = required(region, "region"), &numbers = required(values, "values");
    auto& names = required(attributes, "attributes");
    required(count, "count") = m.number_of_regions();
    of = m.region().data();
    numbers = m.region_value().data();
    names = m.region_attribute().data();
  });
}

cadt_status cadt_constrained_added_points(const cadt_constrained* mesh, const double** xy, const int32_t** parents,
                                          size_t* count) {
  return guarded([&] {
    const auto& m = mesh_of(mesh);
    auto& of = required(parents, "parents");
    give_list(m.added_points(), 2, xy, count);
    of = reinterpret_cast<const std::int32_t*>(m.added_parents().data());
  });
}

cadt_status cadt_constrained_rounded_valid(const cadt_constrained* mesh, int32_t* valid) {
  return guarded([&] { required(valid, "valid") = mesh_of(mesh).rounded_valid() ? 1 : 0; });
}

cadt_status cadt_constrained_moved_points(const cadt_constrained* mesh, const double** xy, size_t* count) {
  return guarded([&] { give_list(mesh_of(mesh).moved_points(), 2, xy, count); });
}

cadt_status cadt_constrained_hash(const cadt_constrained* mesh, uint64_t* high, uint64_t* low) {
  return guarded([&] {
    auto &h = required(high, "high"), &l = required(low, "low");
    const cadt::Hash128 hash = mesh_of(mesh).hash();
    h = hash.high;
    l = hash.low;
  });
}

cadt_status cadt_constrained_verify(const cadt_constrained* mesh, const cadt_points* points, const int32_t* segments,
                                    size_t segment_count, const cadt_constraint_options* constraints,
                                    cadt_report** report) {
  return guarded([&] {
    auto& result = required(report, "report");
    const auto& m = mesh_of(mesh);
    const cadt::PointsView view = points_of(points);
    const auto between = segments_of(segments, segment_count);
    result = new cadt_report(cadt::verify(view, between, m, constraints_of(constraints)));
  });
}

cadt_status cadt_constrained_values_at_crossings(const cadt_constrained* mesh, const cadt_points* points,
                                                 const double* values, size_t value_count, size_t columns,
                                                 double* result, size_t capacity, size_t* count) {
  return guarded([&] {
    const auto& m = mesh_of(mesh);
    const cadt::PointsView view = points_of(points);
    if (!has_room(result, capacity, (view.size() + m.added_points().size() / 2) * columns, count)) return;
    if (value_count != 0) require(values, "values");
    std::ranges::copy(cadt::values_at_crossings(view, {values, value_count}, columns, m), result);
  });
}

cadt_status cadt_find_crossings(const cadt_points* points, const int32_t* segments, size_t segment_count,
                                const cadt_options* options, cadt_crossings** crossings) {
  return guarded([&] {
    auto& result = required(crossings, "crossings");
    const cadt::PointsView view = points_of(points);
    const auto between = segments_of(segments, segment_count);
    auto found = std::make_unique<cadt_crossings>();
    found->pairs = cadt::find_crossings(view, between, CallOptions(options).begin_call());
    result = found.release();
  });
}

void cadt_crossings_free(cadt_crossings* crossings) { delete crossings; }

cadt_status cadt_crossings_pairs(const cadt_crossings* crossings, const int32_t** pairs, size_t* count) {
  return guarded([&] {
    const auto& found = required(crossings, "crossings").pairs;
    auto& list = required(pairs, "pairs");
    required(count, "count") = found.size();
    list = found.empty() ? nullptr : found.front().data();
  });
}

cadt_status cadt_queries_open_constrained(const cadt_points* points, const cadt_constrained* mesh,
                                          const cadt_options* options, cadt_queries** queries) {
  return guarded([&] {
    auto& result = required(queries, "queries");
    const auto& of = mesh_of(mesh);
    const cadt::PointsView view = points_of(points);
    const CallOptions given(options);
    result = new cadt_queries{given, cadt::MeshQueries(view, of, given.begin_call())};
  });
}

cadt_status cadt_triangulate_polygons(const cadt_points* ring_points, const int64_t* ring_offsets, size_t rings,
                                      const int64_t* polygon_offsets, size_t polygons, const cadt_options* options,
                                      cadt_polygon_triangles** triangles) {
  return guarded([&] {
    auto& to = required(triangles, "triangles");
    const cadt::PointsView view = points_of(ring_points);
    const auto of_rings = offsets_of(ring_offsets, rings, "ring_offsets");
    const auto of_polygons = offsets_of(polygon_offsets, polygons, "polygon_offsets");
    auto made = std::make_unique<cadt_polygon_triangles>();
    made->result = cadt::triangulate_polygons(view, of_rings, of_polygons, CallOptions(options).begin_call());
    for (const cadt::PolygonProblem& p : made->result.problems())
      made->problems.push_back({p.polygon, static_cast<std::int32_t>(p.status), p.first, p.second});
    to = made.release();
  });
}

void cadt_polygon_triangles_free(cadt_polygon_triangles* triangles) { delete triangles; }

cadt_status cadt_polygon_triangles_get(const cadt_polygon_triangles* triangles, const int64_t** offsets,
                                       size_t* polygons, const int32_t** vertices) {
  return guarded([&] {
    const cadt::PolygonsResult& r = required(triangles, "triangles").result;
    auto& begin = required(offsets, "offsets");
    auto& all = required(vertices, "vertices");
    required(polygons, "polygons") = r.size();
    begin = r.triangle_offsets().data();
    all = r.triangles().data();
  });
}

cadt_status cadt_polygon_triangles_problems(const cadt_polygon_triangles* triangles, const cadt_polygon_problem** list,
                                            size_t* count) {
  return guarded([&] {
    const auto& problems = required(triangles, "triangles").problems;
    auto& array = required(list, "list");
    required(count, "count") = problems.size();
    array = problems.data();
  });
}

const char* cadt_polygon_status_name(int32_t status) {
  if (status < CADT_POLYGON_OK || status > CADT_POLYGON_ZERO_AREA) return "unknown status";
  return cadt::to_string(static_cast<PolygonStatus>(status)).data();  // literals, which end with a zero
}
}
