// SPDX-License-Identifier: Apache-2.0
// What a mesh can be asked, from host arrays and in device memory.
#include "device.hpp"

#include <nanobind/stl/array.h>

#include <functional>

namespace cadt_python {

namespace {

cadt::Interpolation method_of(const std::string& name) {
  for (const auto method : {cadt::Interpolation::linear, cadt::Interpolation::nearest, cadt::Interpolation::natural})
    if (cadt::to_string(method) == name) return method;
  throw nb::value_error("method must be 'linear', 'nearest' or 'natural'");
}
cadt::Outside outside_of(const std::string& name) {
  if (name != "nan" && name != "nearest") throw nb::value_error("outside must be 'nan' or 'nearest'");
  return name == "nan" ? cadt::Outside::nan : cadt::Outside::nearest;
}
using Corners = std::array<double, 4>;

/// Queries of a mesh of the host; it keeps mesh and points. One thread at a time asks; the first one opens them, and
/// the first one after a fork opens them again, on the host, as drivers do not survive a fork.
class HostQueries {
 public:
  template <class Mesh>
  HostQueries(const Points& points, const Mesh& mesh, const cadt::Options& options)
      : open_([points, view = view_of(points), mesh](const cadt::Options& how) {
          return cadt::MeshQueries(view, mesh, how);
        }),
        options_(options) {}
  ~HostQueries() {
    if (state_->forks != forks()) static_cast<void>(state_.release());
  }
  HostQueries(const HostQueries&) = delete;
  HostQueries& operator=(const HostQueries&) = delete;

  template <class Work>
  auto run(Work&& work) {
    if (state_->forks != forks()) {  // with the GIL: once
      static_cast<void>(state_.release());
      state_ = std::make_unique<State>();
      options_ = on_host(options_);
    }
    State& state = *state_;
    Call call(none_);
    return without_gil([&] {
      if (state.turns.is_mine()) {  // in the handler of a signal
        cadt::MeshQueries other = open_(options_);
        return call.run(other.options(), [&] { return work(other); });
      }
      const std::lock_guard turn(state.turns);
      if (!state.queries) state.queries.emplace(open_(options_));
      return call.run(state.queries->options(), [&] { return work(*state.queries); });
    });
  }

 private:
  struct State {
    std::optional<cadt::MeshQueries> queries;
    unsigned forks = cadt_python::forks();
    Turns turns;
  };

  std::function<cadt::MeshQueries(const cadt::Options&)> open_;  ///< keeps points and mesh
  cadt::Options options_;
  std::unique_ptr<State> state_ = std::make_unique<State>();
  nb::object none_ = nb::none();
};

/// Queries of a mesh in device memory.
class DeviceQueries {
 public:
  DeviceQueries(const std::shared_ptr<DeviceMesh>& mesh, const DeviceCoordinates& points)
      : mesh_(mesh), queries_(mesh->shared().run(nb::none(), [&](cadt::Triangulator& triangulator) {
          return std::make_shared<cadt::MeshQueries>(triangulator, points.points(), mesh->mesh());
        })) {
    // It has copied the options, and with them what reports to the call that has just ended.
    queries_->options().progress = nullptr;
    queries_->options().stop = {};
  }
  ~DeviceQueries() {
    if (queries_) mesh_->shared().retire(std::move(queries_));
  }
  DeviceQueries(const DeviceQueries&) = delete;
  DeviceQueries& operator=(const DeviceQueries&) = delete;

  template <class Work>
  auto run(Work&& work) {
    return mesh_->shared().run_with(queries_->options(), [&] { return work(*queries_); });
  }

 private:
  std::shared_ptr<DeviceMesh> mesh_;
  std::shared_ptr<cadt::MeshQueries> queries_;
};

/// Memory of the caller's: address or cl_mem, and elements.
cadt::DeviceArray memory(const std::pair<std::uintptr_t, std::size_t>& m) {
  return {reinterpret_cast<void*>(m.first), m.second};
}
using Memory = std::pair<std::uintptr_t, std::size_t>;

void bind_device_queries(nb::module_& m) {
  nb::class_<DeviceQueries>(m, "DeviceQueries")
      .def(nb::init<const std::shared_ptr<DeviceMesh>&, const DeviceCoordinates&>())
      .def("locate",
           [](DeviceQueries& q, const DeviceCoordinates& p, const Memory& to) {
             return q.run([&](cadt::MeshQueries& own) { return own.locate(p.points(), memory(to)); });
           })
      .def("barycentric",
           [](DeviceQueries& q, const DeviceCoordinates& p, const Memory& triangles, const Memory& weights) {
             return q.run([&](cadt::MeshQueries& own) {
               return own.locate_barycentric(p.points(), memory(triangles), memory(weights));
             });
           })
      .def("nearest",
           [](DeviceQueries& q, const DeviceCoordinates& p, std::size_t k, const Memory& to) {
             return q.run([&](cadt::MeshQueries& own) { return own.nearest_vertices(p.points(), k, memory(to)); });
           })
      .def("interpolate",
           [](DeviceQueries& q, const Memory& values, const DeviceCoordinates& p, const Memory& to,
              const std::string& method, const std::string& outside) {
             return q.run([&, how = method_of(method), beyond = outside_of(outside)](cadt::MeshQueries& own) {
               return own.interpolate(memory(values), p.points(), memory(to), how, beyond);
             });
           })
      .def("rasterize",
           [](DeviceQueries& q, const Corners& grid, std::size_t columns, std::size_t rows, const Memory& values,
              const Memory& to, const std::string& method, double max_edge) {
             const cadt::Grid cells{grid[0], grid[1], grid[2], grid[3], columns, rows};
             return q.run([&, how = method_of(method)](cadt::MeshQueries& own) {
               return own.rasterize(cells, memory(values), memory(to), how, max_edge);
             });
           })
      .def("circumcenters", [](DeviceQueries& q, const Memory& to) {
        return q.run([&](cadt::MeshQueries& own) { return own.circumcenters(memory(to)); });
      });
}

}  // namespace

void bind_queries(nb::module_& m) {
  nb::class_<HostQueries>(m, "Queries")
      .def(nb::init<const Points&, const cadt::Triangulation&, const cadt::Options&>())
      .def(nb::init<const Points&, const cadt::ConstrainedTriangulation&, const cadt::Options&>())
      .def("locate",
           [](HostQueries& q, const Points& p) {
             return array_of(q.run([&, view = view_of(p)](cadt::MeshQueries& own) { return own.locate(view); }));
           })
      .def("barycentric",
           [](HostQueries& q, const Points& p) {
             cadt::Located located =
                 q.run([&, view = view_of(p)](cadt::MeshQueries& own) { return own.locate_barycentric(view); });
             return nb::make_tuple(array_of(std::move(located.triangles)), array_of(std::move(located.barycentric), 3));
           })
      .def("within_hull",
           [](HostQueries& q, const Points& p) {
             return array_of(q.run([&, view = view_of(p)](cadt::MeshQueries& own) { return own.within_hull(view); }));
           })
      .def("nearest",
           [](HostQueries& q, const Points& p, std::size_t k) {
             return array_of(q.run([&, view = view_of(p)](cadt::MeshQueries& own) {
               return k == 1 ? own.nearest_vertex(view) : own.nearest_vertices(view, k);
             }));
           })
      .def("interpolate",
           [](HostQueries& q, const Values& values, const Points& p, const std::string& method,
              const std::string& outside) {
             return array_of(q.run(
                 [&, view = view_of(p), how = method_of(method), beyond = outside_of(outside)](cadt::MeshQueries& own) {
                   return own.interpolate({values.data(), values.size()}, view, how, beyond);
                 }));
           })
      .def(
          "rasterize",
          [](HostQueries& q, const Corners& grid, std::size_t columns, std::size_t rows, const Values& values,
             const std::string& method, double max_edge, std::size_t first_column, std::size_t first_row) {
            const cadt::Grid cells{grid[0], grid[1], grid[2], grid[3], columns, rows, first_column, first_row};
            return array_of(q.run([&, how = method_of(method)](cadt::MeshQueries& own) {
              return own.rasterize(cells, {values.data(), values.size()}, how, max_edge);
            }));
          },
          nb::arg("grid"), nb::arg("columns"), nb::arg("rows"), nb::arg("values"), nb::arg("method"),
          nb::arg("max_edge"), nb::arg("first_column") = 0, nb::arg("first_row") = 0)
      .def(
          "circumcenters",
          [](HostQueries& q) { return array_of(q.run([](cadt::MeshQueries& own) { return own.circumcenters(); }), 2); })
      .def("voronoi",
           [](HostQueries& q) {
             cadt::VoronoiDiagram v = q.run([](cadt::MeshQueries& own) { return own.voronoi(); });
             return nb::make_tuple(array_of(std::move(v.vertices), 2), array_of(std::move(v.cell_begin)),
                                   array_of(std::move(v.cells)), array_of(std::move(v.edge_points), 2),
                                   array_of(std::move(v.edge_vertices), 2));
           })
      .def("voronoi_polygons",
           [](HostQueries& q, const Corners& box) {
             cadt::VoronoiPolygons v = q.run([&](cadt::MeshQueries& own) {
               return own.voronoi_polygons({box[0], box[1], box[2], box[3]});
             });
             return nb::make_tuple(array_of(std::move(v.begin)), array_of(std::move(v.xy), 2));
           })
      .def("largest_empty_circles",
           [](HostQueries& q, std::size_t k) {
             const auto circles = q.run([&](cadt::MeshQueries& own) { return own.largest_empty_circles(k); });
             std::vector<double> centers, radii;
             std::vector<std::int32_t> triangles;
             for (const cadt::Circle& c : circles) {
               centers.insert(centers.end(), {c.x, c.y});
               radii.push_back(c.radius);
               triangles.push_back(c.triangle);
             }
             return nb::make_tuple(array_of(std::move(centers), 2), array_of(std::move(radii)),
                                   array_of(std::move(triangles)));
           })
      .def("outline", [](HostQueries& q, double max_radius, double max_edge) {
        cadt::Outline outline = q.run([&](cadt::MeshQueries& own) { return own.outline(max_radius, max_edge); });
        return nb::make_tuple(array_of(std::move(outline.triangles)), array_of(std::move(outline.edges), 2));
      });
  bind_device_queries(m);
}

}  // namespace cadt_python
