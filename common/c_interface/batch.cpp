// SPDX-License-Identifier: Apache-2.0
// Many sets in one call.
#include "common/c_interface/convert.hpp"

using namespace cadt::c_interface;

namespace {

template <class Batch>
void give_offsets(const Batch& batch, const std::size_t** offsets, std::size_t* sets) {
  auto& array = required(offsets, "offsets");
  required(sets, "sets") = batch.size();
  array = batch.triangle_offsets().data();
}

}  // namespace

extern "C" {

cadt_status cadt_triangulate_batch(const cadt_points* points, const size_t* offsets, size_t sets,
                                   const cadt_options* options, cadt_batch** batch) {
  return guarded([&] {
    auto& result = required(batch, "batch");
    const cadt::PointsView view = points_of(points);
    result =
        new cadt_batch{cadt::triangulate_batch(view, offsets_of(offsets, sets), CallOptions(options).begin_call())};
  });
}

cadt_status cadt_triangulator_triangulate_batch(cadt_triangulator* triangulator, const cadt_points* points,
                                                const size_t* offsets, size_t sets, cadt_batch** batch) {
  return guarded([&] {
    auto& result = required(batch, "batch");
    cadt_triangulator& t = required(triangulator, "triangulator");
    const cadt::PointsView view = points_of(points);
    const auto parts = offsets_of(offsets, sets);
    result = new cadt_batch{t.begin_call().triangulate_batch(view, parts)};
  });
}

cadt_status cadt_batch_triangle_offsets(const cadt_batch* batch, const size_t** offsets, size_t* sets) {
  return guarded([&] { give_offsets(required(batch, "batch").batch, offsets, sets); });
}

cadt_status cadt_batch_triangles(const cadt_batch* batch, const int32_t** triangles) {
  return guarded([&] { required(triangles, "triangles") = required(batch, "batch").batch.triangles().data(); });
}

cadt_status cadt_batch_neighbors(const cadt_batch* batch, const int32_t** neighbors) {
  return guarded([&] { required(neighbors, "neighbors") = required(batch, "batch").batch.neighbors().data(); });
}

cadt_status cadt_batch_dimension(const cadt_batch* batch, size_t set, int32_t* dimension) {
  return guarded([&] { required(dimension, "dimension") = required(batch, "batch").batch.dimension(set); });
}

cadt_status cadt_batch_duplicates(const cadt_batch* batch, size_t set, const cadt_duplicate** list, size_t* count) {
  return guarded([&] {
    const auto duplicates = required(batch, "batch").batch.duplicates(set);
    auto& array = required(list, "list");
    required(count, "count") = duplicates.size();
    array = list_of(duplicates);
  });
}

cadt_status cadt_batch_statistics(const cadt_batch* batch, cadt_statistics* statistics) {
  return guarded([&] { give_statistics(required(batch, "batch").batch.statistics(), statistics); });
}

cadt_status cadt_batch_triangulation(const cadt_batch* batch, size_t set, cadt_triangulation** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    result = new cadt_triangulation{required(batch, "batch").batch.triangulation(set)};
  });
}

void cadt_batch_free(cadt_batch* batch) { delete batch; }

cadt_status cadt_triangulator_triangulate_device_batch(cadt_triangulator* triangulator,
                                                       const cadt_device_points* points, const size_t* offsets,
                                                       size_t sets, cadt_device_batch** batch) {
  return guarded([&] {
    auto& result = required(batch, "batch");
    cadt_triangulator& t = required(triangulator, "triangulator");
    const cadt::DevicePoints given = points_of(points);
    const auto parts = offsets_of(offsets, sets);
    result = new cadt_device_batch{t.begin_call().triangulate_batch(given, parts)};
  });
}

cadt_status cadt_device_batch_triangle_offsets(const cadt_device_batch* batch, const size_t** offsets, size_t* sets) {
  return guarded([&] { give_offsets(required(batch, "batch").batch, offsets, sets); });
}

cadt_status cadt_device_batch_arrays(const cadt_device_batch* batch, void** triangle_offsets, void** triangles,
                                     void** neighbors) {
  return guarded([&] {
    const cadt::DeviceTriangulationBatch& b = required(batch, "batch").batch;
    auto &o = required(triangle_offsets, "triangle_offsets"), &t = required(triangles, "triangles"),
         &n = required(neighbors, "neighbors");
    o = b.device_triangle_offsets();
    t = b.triangles();
    n = b.neighbors();
  });
}

cadt_status cadt_device_batch_download(const cadt_device_batch* batch, cadt_batch** copy) {
  return guarded([&] {
    auto& result = required(copy, "copy");
    result = new cadt_batch{required(batch, "batch").batch.download()};
  });
}

void cadt_device_batch_free(cadt_device_batch* batch) { delete batch; }
}
