// SPDX-License-Identifier: Apache-2.0
// Open devices, and meshes in their memory.
#include "common/c_interface/convert.hpp"

using namespace cadt::c_interface;

cadt::Triangulator& cadt_triangulator::begin_call() {
  cadt::Options next = options.begin_call();
  cadt::Options& now = triangulator.options();
  // What was read when the device was opened stays as it was.
  next.backend = now.backend;
  next.device = now.device;
  next.threads = now.threads;
  next.queue = now.queue;
  next.allocator = now.allocator;
  next.tuning.work_group_size = now.tuning.work_group_size;
  now = std::move(next);
  return triangulator;
}

extern "C" {

cadt_status cadt_triangulator_open(const cadt_options* options, cadt_triangulator** triangulator) {
  return guarded([&] {
    auto& result = required(triangulator, "triangulator");
    result = new cadt_triangulator(options);
  });
}

void cadt_triangulator_free(cadt_triangulator* triangulator) { delete triangulator; }

cadt_status cadt_triangulator_set_options(cadt_triangulator* triangulator, const cadt_options* options) {
  return guarded([&] {
    cadt_triangulator& t = required(triangulator, "triangulator");
    t.options = CallOptions(options);
    t.begin_call();  // for memory_needed, which is const
  });
}

cadt_status cadt_triangulator_triangulate(cadt_triangulator* triangulator, const cadt_points* points,
                                          cadt_triangulation** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    cadt_triangulator& t = required(triangulator, "triangulator");
    const cadt::PointsView view = points_of(points);
    result = new cadt_triangulation{t.begin_call().triangulate(view)};
  });
}

cadt_status cadt_triangulator_memory_needed(const cadt_triangulator* triangulator, size_t points, size_t* bytes) {
  return guarded(
      [&] { required(bytes, "bytes") = required(triangulator, "triangulator").triangulator.memory_needed(points); });
}

cadt_status cadt_triangulator_reserve(cadt_triangulator* triangulator, size_t points) {
  return guarded([&] { required(triangulator, "triangulator").begin_call().reserve(points); });
}

cadt_status cadt_triangulator_release_memory(cadt_triangulator* triangulator) {
  return guarded([&] { required(triangulator, "triangulator").triangulator.release_memory(); });
}

cadt_status cadt_triangulator_triangulate_device(cadt_triangulator* triangulator, const cadt_device_points* points,
                                                 cadt_device_triangulation** mesh) {
  return guarded([&] {
    auto& result = required(mesh, "mesh");
    cadt_triangulator& t = required(triangulator, "triangulator");
    const cadt::DevicePoints given = points_of(points);
    result = new cadt_device_triangulation{t.begin_call().triangulate(given)};
  });
}

cadt_status cadt_triangulator_verify(cadt_triangulator* triangulator, const cadt_device_points* points,
                                     const cadt_device_triangulation* mesh, cadt_report** report) {
  return guarded([&] {
    auto& result = required(report, "report");
    cadt_triangulator& t = required(triangulator, "triangulator");
    const cadt::DevicePoints given = points_of(points);
    const cadt::DeviceTriangulation& m = required(mesh, "mesh").mesh;
    result = new cadt_report(t.begin_call().verify(given, m));
  });
}

cadt_status cadt_device_triangulation_size(const cadt_device_triangulation* mesh, size_t* points, size_t* triangles,
                                           size_t* duplicates) {
  return guarded([&] {
    const cadt::DeviceTriangulation& m = required(mesh, "mesh").mesh;
    auto &p = required(points, "points"), &t = required(triangles, "triangles"),
         &d = required(duplicates, "duplicates");
    p = m.number_of_points();
    t = m.number_of_triangles();
    d = m.number_of_duplicates();
  });
}

cadt_status cadt_device_triangulation_dimension(const cadt_device_triangulation* mesh, int32_t* dimension) {
  return guarded([&] { required(dimension, "dimension") = required(mesh, "mesh").mesh.dimension(); });
}

cadt_status cadt_device_triangulation_triangles(const cadt_device_triangulation* mesh, void** triangles) {
  return guarded([&] { required(triangles, "triangles") = required(mesh, "mesh").mesh.triangles(); });
}

cadt_status cadt_device_triangulation_neighbors(const cadt_device_triangulation* mesh, void** neighbors) {
  return guarded([&] { required(neighbors, "neighbors") = required(mesh, "mesh").mesh.neighbors(); });
}

cadt_status cadt_device_triangulation_duplicates(const cadt_device_triangulation* mesh, void** points,
                                                 void** representatives) {
  return guarded([&] {
    const cadt::DeviceTriangulation& m = required(mesh, "mesh").mesh;
    auto &p = required(points, "points"), &r = required(representatives, "representatives");
    p = m.duplicate_points();
    r = m.representatives();
  });
}

cadt_status cadt_device_triangulation_statistics(const cadt_device_triangulation* mesh, cadt_statistics* statistics) {
  return guarded([&] { give_statistics(required(mesh, "mesh").mesh.statistics(), statistics); });
}

cadt_status cadt_device_triangulation_download(const cadt_device_triangulation* mesh, cadt_triangulation** copy) {
  return guarded([&] {
    auto& result = required(copy, "copy");
    result = new cadt_triangulation{required(mesh, "mesh").mesh.download()};
  });
}

void cadt_device_triangulation_free(cadt_device_triangulation* mesh) { delete mesh; }
}
