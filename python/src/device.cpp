// SPDX-License-Identifier: Apache-2.0
// Triangulators that stay open, points and meshes in device memory.
#include "device.hpp"

namespace cadt_python {

namespace {

using Mesh = std::shared_ptr<DeviceMesh>;

/// An array of CUDA memory that keeps the owner; for __dlpack__ of array libraries.
template <class Owner>
nb::object cuda_array(const std::shared_ptr<Owner>& owner, void* memory, const std::vector<std::size_t>& shape,
                      nb::dlpack::dtype type) {
  using Kept = std::shared_ptr<Owner>;
  nb::capsule keep(new Kept(owner), [](void* p) noexcept { delete static_cast<Kept*>(p); });
  return nb::cast(nb::ndarray<nb::array_api>(memory, shape.size(), shape.data(), keep, nullptr, type,
                                             nb::device::cuda::value, owner->shared().device().index));
}
std::uintptr_t number_of(void* handle) { return reinterpret_cast<std::uintptr_t>(handle); }

}  // namespace

void bind_device(nb::module_& m) {
  nb::class_<DeviceCoordinates>(m, "DevicePoints")
      .def(
          "__init__",
          [](DeviceCoordinates* self, std::uintptr_t x, std::size_t size, bool float32, std::size_t skip) {
            new (self) DeviceCoordinates{x, size, float32, skip};
          },
          nb::arg("x"), nb::arg("size"), nb::arg("float32"), nb::arg("skip") = 0);

  nb::class_<SharedTriangulator>(m, "Triangulator")
      .def(nb::init<const cadt::Options&, nb::object>(), nb::arg("options"), nb::arg("stream") = nb::none())
      .def_prop_ro("backend",
                   [](const SharedTriangulator& t) { return std::string(cadt::to_string(t.device().backend)); })
      .def_prop_ro("device", [](const SharedTriangulator& t) { return t.device().name; })
      .def_prop_ro("device_index", [](const SharedTriangulator& t) { return t.device().index; })
      .def("release_memory",
           [](SharedTriangulator& t) {
             t.run(nb::none(), [](cadt::Triangulator& own) {
               own.release_memory();
               return 0;
             });
           })
      .def(
          "triangulate",
          [](SharedTriangulator& t, const Points& points, const cadt::Options& options, const nb::object& progress) {
            const cadt::PointsView view = view_of(points);
            return t.run(options, progress, [&](cadt::Triangulator& own) { return own.triangulate(view); });
          },
          nb::arg("points"), nb::arg("options"), nb::arg("progress") = nb::none());

  m.def(
      "triangulate_on_device",
      [](const Shared& shared, const DeviceCoordinates& points, const cadt::Options& options,
         const nb::object& progress) {
        return std::make_shared<DeviceMesh>(shared, shared->run(options, progress, [&](cadt::Triangulator& own) {
          return own.triangulate(points.points());
        }));
      },
      nb::arg("triangulator"), nb::arg("points"), nb::arg("options"), nb::arg("progress") = nb::none());

  nb::class_<DeviceMesh>(m, "DeviceTriangulation")
      .def_prop_ro("number_of_points", [](const DeviceMesh& d) { return d.mesh().number_of_points(); })
      .def_prop_ro("number_of_triangles", [](const DeviceMesh& d) { return d.mesh().number_of_triangles(); })
      .def_prop_ro("dimension", [](const DeviceMesh& d) { return d.mesh().dimension(); })
      .def_prop_ro("statistics", [](const DeviceMesh& d) { return to_dict(d.mesh().statistics()); })
      .def_prop_ro("number_inside", [](const DeviceMesh& d) { return d.mesh().number_inside(); })
      .def_prop_ro("triangles_handle", [](const DeviceMesh& d) { return number_of(d.mesh().triangles()); })
      .def_prop_ro("neighbors_handle", [](const DeviceMesh& d) { return number_of(d.mesh().neighbors()); })
      .def_prop_ro("edge_flags_handle", [](const DeviceMesh& d) { return number_of(d.mesh().edge_flags()); })
      .def_prop_ro("chain_offsets_handle", [](const DeviceMesh& d) { return number_of(d.mesh().chain_offsets()); })
      .def_prop_ro("chain_vertices_handle", [](const DeviceMesh& d) { return number_of(d.mesh().chain_vertices()); })
      .def_prop_ro("chain_length", [](const DeviceMesh& d) { return d.mesh().chain_length(); })
      .def_prop_ro("regions_handle", [](const DeviceMesh& d) { return number_of(d.mesh().regions()); })
      .def_prop_ro("inside_handle", [](const DeviceMesh& d) { return number_of(d.mesh().inside()); })
      .def_prop_ro("number_of_regions", [](const DeviceMesh& d) { return d.mesh().number_of_regions(); })
      .def_prop_ro("region_values_handle", [](const DeviceMesh& d) { return number_of(d.mesh().region_values()); })
      .def_prop_ro("region_attributes_handle",
                   [](const DeviceMesh& d) { return number_of(d.mesh().region_attributes()); })
      .def_prop_ro("triangles_inside_handle",
                   [](const DeviceMesh& d) { return number_of(d.mesh().triangles_inside()); })
      .def_prop_ro("number_added", [](const DeviceMesh& d) { return d.mesh().number_added(); })
      .def_prop_ro("rounded_valid", [](const DeviceMesh& d) { return d.mesh().rounded_valid(); })
      .def_prop_ro("all_points_handle", [](const DeviceMesh& d) { return number_of(d.mesh().all_points()); })
      .def_prop_ro("added_parents_handle", [](const DeviceMesh& d) { return number_of(d.mesh().added_parents()); })
      .def("download",
           [](const DeviceMesh& d) {
             return d.shared().run(nb::none(), [&](cadt::Triangulator&) { return d.mesh().download(); });
           })
      .def("download_constrained", [](const DeviceMesh& d) {
        return d.shared().run(nb::none(), [&](cadt::Triangulator&) { return d.mesh().download_constrained(); });
      });
  m.def(
      "cuda_array",
      [](const Mesh& mesh, std::uintptr_t handle, const std::vector<std::size_t>& shape, bool float64) {
        const nb::dlpack::dtype type = float64 ? nb::dtype<double>() : nb::dtype<std::int32_t>();
        return cuda_array(mesh, reinterpret_cast<void*>(handle), shape, type);
      },
      nb::arg("mesh"), nb::arg("handle"), nb::arg("shape"), nb::arg("float64"));

  nb::class_<DeviceMemory>(m, "DeviceMemory")
      .def(nb::init<Shared, std::vector<std::size_t>, bool>(), nb::arg("triangulator"), nb::arg("shape"),
           nb::arg("float64"))
      .def_prop_ro("address", [](const DeviceMemory& d) { return reinterpret_cast<std::uintptr_t>(d.get()); })
      .def_prop_ro("shape", [](const DeviceMemory& d) { return nb::tuple(nb::cast(d.shape())); });
  m.def("cuda_memory", [](const std::shared_ptr<DeviceMemory>& memory) {
    return cuda_array(memory, memory->get(), memory->shape(), memory->type());
  });
}

}  // namespace cadt_python
