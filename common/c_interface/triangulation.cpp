// SPDX-License-Identifier: Apache-2.0
// Meshes of the host.
#include "common/c_interface/convert.hpp"

using namespace cadt::c_interface;

namespace {

std::size_t number_of_edges(const cadt::Triangulation& mesh) {
  return (3 * mesh.number_of_triangles() + mesh.hull().size()) / 2;
}

/// Compressed rows into the caller's arrays.
template <class Rows>
void give_rows(std::size_t needed, std::size_t* indptr, std::int32_t* indices, std::size_t capacity, std::size_t* count,
               const Rows& rows_of) {
  const bool only_count = indptr == nullptr && indices == nullptr;  // without triangles there are no indices
  if (!has_room(indices, capacity, needed, count) && (only_count || needed != 0)) {
    if (only_count) return;
    throw BufferTooSmall(needed, capacity);
  }
  require(indptr, "indptr");
  const cadt::CompressedRows rows = rows_of();
  std::ranges::copy(rows.indptr, indptr);
  std::ranges::copy(rows.indices, indices);
}

}  // namespace

extern "C" {

cadt_status cadt_triangulate(const cadt_points* points, const cadt_options* options, cadt_triangulation** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    const cadt::PointsView view = points_of(points);
    result = new cadt_triangulation{cadt::triangulate(view, CallOptions(options).begin_call())};
  });
}

cadt_status cadt_triangulation_adopt(const cadt_points* points, const int32_t* triangles, const int32_t* neighbors,
                                     size_t triangle_count, int32_t trusted, int32_t keep_points,
                                     cadt_triangulation** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    const cadt::PointsView view = points_of(points);
    if (triangle_count != 0) require(triangles, "triangles");
    const std::size_t indices = indices_of(triangle_count);
    const auto array = [&](const std::int32_t* from) {
      return from == nullptr ? std::span<const std::int32_t>() : std::span(from, indices);
    };
    result = new cadt_triangulation{cadt::Triangulation::adopt(
        view, array(triangles), array(neighbors), trusted != 0 ? cadt::Trust::geometry : cadt::Trust::verify,
        keep_points_of(keep_points))};
  });
}

cadt_status cadt_triangulation_copy(const cadt_triangulation* mesh, cadt_triangulation** copy) {
  return guarded([&] {
    auto& result = required(copy, "copy");
    result = new cadt_triangulation(required(mesh, "mesh"));
  });
}

void cadt_triangulation_free(cadt_triangulation* mesh) { delete mesh; }

cadt_status cadt_triangulation_size(const cadt_triangulation* mesh, size_t* points, size_t* triangles) {
  return guarded([&] {
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    auto &p = required(points, "points"), &t = required(triangles, "triangles");
    p = m.number_of_points();
    t = m.number_of_triangles();
  });
}

cadt_status cadt_triangulation_dimension(const cadt_triangulation* mesh, int32_t* dimension) {
  return guarded([&] { required(dimension, "dimension") = required(mesh, "mesh").mesh.dimension(); });
}

cadt_status cadt_triangulation_triangles(const cadt_triangulation* mesh, const int32_t** triangles) {
  return guarded([&] { required(triangles, "triangles") = required(mesh, "mesh").mesh.triangles().data(); });
}

cadt_status cadt_triangulation_neighbors(const cadt_triangulation* mesh, const int32_t** neighbors) {
  return guarded([&] { required(neighbors, "neighbors") = required(mesh, "mesh").mesh.neighbors().data(); });
}

cadt_status cadt_triangulation_hull(const cadt_triangulation* mesh, const int32_t** hull, size_t* count) {
  return guarded([&] {
    const auto loop = required(mesh, "mesh").mesh.hull();
    auto& array = required(hull, "hull");
    required(count, "count") = loop.size();
    array = loop.data();
  });
}

cadt_status cadt_triangulation_duplicates(const cadt_triangulation* mesh, const cadt_duplicate** list, size_t* count) {
  return guarded([&] {
    const auto duplicates = required(mesh, "mesh").mesh.duplicates();
    auto& array = required(list, "list");
    required(count, "count") = duplicates.size();
    array = list_of(duplicates);
  });
}

cadt_status cadt_triangulation_points(const cadt_triangulation* mesh, cadt_points* points) {
  return guarded([&] {
    const cadt::PointsView view = required(mesh, "mesh").mesh.points();
    required(points, "points") = {view.x_data(), view.y_data(), view.size(), view.stride(),
                                  view.scalar_size() == sizeof(double) ? CADT_FLOAT64 : CADT_FLOAT32};
  });
}

cadt_status cadt_triangulation_hash(const cadt_triangulation* mesh, uint64_t* high, uint64_t* low) {
  return guarded([&] {
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    auto &first = required(high, "high"), &second = required(low, "low");
    const cadt::Hash128 hash = m.hash();
    first = hash.high;
    second = hash.low;
  });
}

cadt_status cadt_triangulation_statistics(const cadt_triangulation* mesh, cadt_statistics* statistics) {
  return guarded([&] { give_statistics(required(mesh, "mesh").mesh.statistics(), statistics); });
}

cadt_status cadt_triangulation_vertex_triangle(const cadt_triangulation* mesh, int32_t* triangles, size_t capacity,
                                               size_t* count) {
  return guarded([&] {
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    if (has_room(triangles, capacity, m.number_of_points(), count)) std::ranges::copy(m.vertex_triangle(), triangles);
  });
}

cadt_status cadt_triangulation_edges(const cadt_triangulation* mesh, int32_t* edges, size_t capacity, size_t* count) {
  return guarded([&] {
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    if (!has_room(edges, capacity, 2 * number_of_edges(m), count)) return;
    for (const auto& [a, b] : cadt::edges(m)) {
      *edges++ = a;
      *edges++ = b;
    }
  });
}

cadt_status cadt_triangulation_half_edges(const cadt_triangulation* mesh, int64_t* half_edges, size_t capacity,
                                          size_t* count) {
  return guarded([&] {
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    if (has_room(half_edges, capacity, m.triangles().size(), count)) std::ranges::copy(cadt::half_edges(m), half_edges);
  });
}

cadt_status cadt_triangulation_vertex_neighbors(const cadt_triangulation* mesh, size_t* indptr, int32_t* neighbors,
                                                size_t capacity, size_t* count) {
  return guarded([&] {
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    give_rows(2 * number_of_edges(m), indptr, neighbors, capacity, count, [&] { return cadt::vertex_neighbors(m); });
  });
}

cadt_status cadt_triangulation_incident_triangles(const cadt_triangulation* mesh, size_t* indptr, int32_t* triangles,
                                                  size_t capacity, size_t* count) {
  return guarded([&] {
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    give_rows(m.triangles().size(), indptr, triangles, capacity, count, [&] { return cadt::incident_triangles(m); });
  });
}
}
