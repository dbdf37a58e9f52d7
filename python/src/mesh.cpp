// SPDX-License-Identifier: Apache-2.0
// Meshes on the host: triangulate, batches, topology, verify.
#include "common.hpp"

namespace cadt_python {

namespace {

using cadt::Triangulation;

NumpyArray<const std::int32_t> duplicates_of(const Triangulation& mesh) {
  static_assert(sizeof(cadt::Duplicate) == 2 * sizeof(std::int32_t));
  const auto duplicates = mesh.duplicates();
  return array_of(std::span(reinterpret_cast<const std::int32_t*>(duplicates.data()), 2 * duplicates.size()), 2, mesh);
}

nb::tuple rows(cadt::CompressedRows&& r) {
  std::vector<std::int64_t> begin(r.indptr.begin(), r.indptr.end());
  return nb::make_tuple(array_of(std::move(begin)), array_of(std::move(r.indices)));
}

}  // namespace

nb::dict report_of(const cadt::VerifyReport& r) {
  nb::list checks;
  for (const cadt::Check& c : r.checks) checks.append(nb::make_tuple(c.name, c.passed, c.failures, c.first, c.what));
  nb::dict d;
  d["ok"] = r.ok;
  d["checks"] = checks;
  d["summary"] = r.summary();
  d["triangles_examined"] = r.triangles_examined;
  d["edges_examined"] = r.edges_examined;
  d["ties"] = r.ties;
  return d;
}

void bind_mesh(nb::module_& m) {
  m.def("max_points", &cadt::max_points);
  m.def(
      "triangulate",
      [](const Points& points, cadt::Options& options, const nb::object& progress) {
        const cadt::PointsView view = view_of(points);
        return Call(progress)(options, [&] { return cadt::triangulate(view, options); });
      },
      nb::arg("points"), nb::arg("options"), nb::arg("progress") = nb::none());

  nb::class_<Triangulation>(m, "Triangulation")
      .def_prop_ro("number_of_points", &Triangulation::number_of_points)
      .def_prop_ro("number_of_triangles", &Triangulation::number_of_triangles)
      .def_prop_ro("dimension", &Triangulation::dimension)
      .def_prop_ro(
          "triangles", [](const Triangulation& t) { return array_of(t.triangles(), 3, t); }, nb::rv_policy::automatic)
      .def_prop_ro(
          "neighbors", [](const Triangulation& t) { return array_of(t.neighbors(), 3, t); }, nb::rv_policy::automatic)
      .def_prop_ro(
          "hull", [](const Triangulation& t) { return array_of(t.hull(), 0, t); }, nb::rv_policy::automatic)
      .def_prop_ro("duplicates", &duplicates_of, nb::rv_policy::automatic)
      .def_prop_ro("statistics", [](const Triangulation& t) { return to_dict(t.statistics()); })
      .def("vertex_triangle",
           [](const Triangulation& t) { return array_of(without_gil([&] { return t.vertex_triangle(); })); })
      .def("hash", [](const Triangulation& t) { return without_gil([&] { return t.hash().to_string(); }); })
      .def("edges",
           [](const Triangulation& t) {
             auto edges = without_gil([&] { return cadt::edges(t); });
             const std::size_t count = edges.size();
             return array_of_shape<std::int32_t>({count, 2}, std::move(edges));
           })
      .def("vertex_neighbors",
           [](const Triangulation& t) { return rows(without_gil([&] { return cadt::vertex_neighbors(t); })); })
      .def("incident_triangles",
           [](const Triangulation& t) { return rows(without_gil([&] { return cadt::incident_triangles(t); })); })
      .def("half_edges",
           [](const Triangulation& t) { return array_of(without_gil([&] { return cadt::half_edges(t); })); })
      .def("verify", [](const Triangulation& t, const Points& points) {
        const cadt::PointsView view = view_of(points);
        return report_of(without_gil([&] { return cadt::verify(view, t); }));
      });

  m.def(
      "verify",
      [](const Points& points, const Indices& triangles, std::optional<Indices> neighbors, bool canonical_ties) {
        const cadt::PointsView view = view_of(points);
        cadt::MeshView mesh{
            .triangles = {triangles.data(), triangles.size()}, .neighbors = {}, .hull = {}, .duplicates = {}};
        if (neighbors) mesh.neighbors = {neighbors->data(), neighbors->size()};
        return report_of(without_gil([&] { return cadt::verify(view, mesh, {.canonical_ties = canonical_ties}); }));
      },
      nb::arg("points"), nb::arg("triangles"), nb::arg("neighbors") = nb::none(), nb::arg("canonical_ties") = false);
  m.def("clockwise", [](const Points& points, const Indices& triangles) {
    const cadt::PointsView view = view_of(points);
    const auto place = [&](std::int32_t v) {
      return std::array<double, 2>{view.x(static_cast<std::size_t>(v)), view.y(static_cast<std::size_t>(v))};
    };
    return array_of(without_gil([&] {
      std::vector<std::uint8_t> flags(triangles.shape(0));
      for (std::size_t t = 0; t < flags.size(); ++t) {
        const std::int32_t* v = triangles.data() + 3 * t;
        flags[t] = cadt::exact_orientation(place(v[0]), place(v[1]), place(v[2])) < 0 ? 1 : 0;
      }
      return flags;
    }));
  });
  m.def(
      "adopt",
      [](const Points& points, const Indices& triangles, std::optional<Indices> neighbors, bool verify) {
        const cadt::PointsView view = view_of(points);
        const std::span<const std::int32_t> of =
            neighbors ? std::span(neighbors->data(), neighbors->size()) : std::span<const std::int32_t>();
        return without_gil([&] {
          return Triangulation::adopt(view, {triangles.data(), triangles.size()}, of,
                                      verify ? cadt::Trust::verify : cadt::Trust::geometry);
        });
      },
      nb::arg("points"), nb::arg("triangles"), nb::arg("neighbors") = nb::none(), nb::arg("verify") = true);

  using Batch = std::shared_ptr<cadt::TriangulationBatch>;
  struct BatchOf {
    Batch batch;
  };
  nb::class_<BatchOf>(m, "TriangulationBatch")
      .def_prop_ro("size", [](const BatchOf& b) { return b.batch->size(); })
      .def_prop_ro(
          "triangles", [](const BatchOf& b) { return array_of(b.batch->triangles(), 3, b.batch); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "neighbors", [](const BatchOf& b) { return array_of(b.batch->neighbors(), 3, b.batch); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "triangle_offsets",
          [](const BatchOf& b) {
            const auto offsets = b.batch->triangle_offsets();
            return array_of(std::vector<std::int64_t>(offsets.begin(), offsets.end()));
          },
          nb::rv_policy::automatic)
      .def_prop_ro("statistics", [](const BatchOf& b) { return to_dict(b.batch->statistics()); })
      .def("triangulation", [](const BatchOf& b, std::size_t set) { return b.batch->triangulation(set); });
  m.def(
      "triangulate_batch",
      [](const Points& points,
         const nb::ndarray<const std::int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>& offsets,
         cadt::Options& options, const nb::object& progress) {
        const cadt::PointsView view = view_of(points);
        std::vector<std::size_t> begin(offsets.size());
        for (std::size_t i = 0; i < begin.size(); ++i) begin[i] = static_cast<std::size_t>(offsets.data()[i]);
        return BatchOf{std::make_shared<cadt::TriangulationBatch>(
            Call(progress)(options, [&] { return cadt::triangulate_batch(view, begin, options); }))};
      },
      nb::arg("points"), nb::arg("offsets"), nb::arg("options"), nb::arg("progress") = nb::none());
}

}  // namespace cadt_python
