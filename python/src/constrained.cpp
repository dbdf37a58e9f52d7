// SPDX-License-Identifier: Apache-2.0
// Constrained triangulations, polygons, label images.
#include "device.hpp"

#include <nanobind/stl/array.h>

namespace cadt_python {

namespace {

using ConstrainedMesh = cadt::ConstrainedTriangulation;
using Pairs = nb::ndarray<const std::int32_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Offsets = nb::ndarray<const std::int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IndexArray = nb::ndarray<const std::int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

template <class Array>
auto elements_of(const Array& a) {
  return std::span(a.data(), a.size());
}
std::span<const cadt::Segment> segments_of(const Pairs& pairs) {
  return {reinterpret_cast<const cadt::Segment*>(pairs.data()), pairs.shape(0)};
}
std::span<const std::int32_t> words_of(std::span<const std::array<std::int32_t, 2>> pairs) {
  return {reinterpret_cast<const std::int32_t*>(pairs.data()), 2 * pairs.size()};
}
NumpyArray<std::int32_t> array_of_pairs(const std::vector<std::array<std::int32_t, 2>>& pairs) {
  const auto words = words_of(pairs);
  return array_of(std::vector<std::int32_t>(words.begin(), words.end()), 2);
}

/// \throws nb::value_error
template <class Enum, std::size_t n>
Enum named(const std::string& name, const std::array<const char*, n>& names, const char* what) {
  for (std::size_t i = 0; i < n; ++i)
    if (name == names[i]) return static_cast<Enum>(i);
  throw nb::value_error((std::string(what) + " has no value '" + name + "'").c_str());
}

cadt::ConstraintOptions constraints_of(const std::string& crossing, double grid, const std::string& domain,
                                       const Coordinates& holes,
                                       const nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig>& regions) {
  constexpr std::array crossings = {"error", "exact", "grid"};
  constexpr std::array domains = {"hull", "outer", "even_odd", "nonzero", "layers", "seeds"};
  cadt::ConstraintOptions result;
  result.crossing = named<cadt::Crossing>(crossing, crossings, "crossing");
  result.grid = grid;
  result.domain = named<cadt::Domain>(domain, domains, "domain");
  for (std::size_t i = 0; i < holes.shape(0); ++i)
    result.holes.push_back({holes.data()[2 * i], holes.data()[2 * i + 1]});
  for (std::size_t i = 0; i < regions.shape(0); ++i)
    result.regions.push_back({regions.data()[3 * i], regions.data()[3 * i + 1], regions.data()[3 * i + 2]});
  return result;
}

void bind_constrained_mesh(nb::module_& m) {
  nb::class_<ConstrainedMesh>(m, "ConstrainedTriangulation")
      .def_prop_ro("mesh", [](const ConstrainedMesh& c) { return c.mesh(); })
      .def_prop_ro(
          "edge_flags", [](const ConstrainedMesh& c) { return array_of(c.edge_flags(), 0, c); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "chains",
          [](const ConstrainedMesh& c) {
            return nb::make_tuple(array_of(c.chain_offsets(), 0, c), array_of(c.chain_vertices(), 0, c));
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "edges",
          [](const ConstrainedMesh& c) {
            const auto edges = without_gil([&] { return c.constrained_edges(); });
            return array_of(words_of(edges), 2, c);
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "sources",
          [](const ConstrainedMesh& c) {
            const auto offsets = without_gil([&] { return c.source_offsets(); });
            return nb::make_tuple(array_of(offsets, 0, c), array_of(c.edge_sources(), 0, c));
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "degenerate_segments", [](const ConstrainedMesh& c) { return array_of(c.degenerate_segments(), 0, c); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "inside", [](const ConstrainedMesh& c) { return array_of(c.inside(), 0, c); }, nb::rv_policy::automatic)
      .def_prop_ro(
          "region", [](const ConstrainedMesh& c) { return array_of(c.region(), 0, c); }, nb::rv_policy::automatic)
      .def_prop_ro(
          "region_value", [](const ConstrainedMesh& c) { return array_of(c.region_value(), 0, c); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "region_attribute", [](const ConstrainedMesh& c) { return array_of(c.region_attribute(), 0, c); },
          nb::rv_policy::automatic)
      .def("triangles_inside",
           [](const ConstrainedMesh& c) { return array_of(without_gil([&] { return c.triangles_inside(); }), 3); })
      .def_prop_ro(
          "added_points", [](const ConstrainedMesh& c) { return array_of(c.added_points(), 2, c); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "added_parents", [](const ConstrainedMesh& c) { return array_of(words_of(c.added_parents()), 2, c); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "moved_points", [](const ConstrainedMesh& c) { return array_of(c.moved_points(), 2, c); },
          nb::rv_policy::automatic)
      .def_prop_ro("rounded_valid", &ConstrainedMesh::rounded_valid)
      .def("values_at_crossings",
           [](const ConstrainedMesh& c, const Points& points, const Values& values) {
             const cadt::PointsView view = view_of(points);
             return array_of(
                 without_gil([&] { return cadt::values_at_crossings(view, elements_of(values), values.shape(1), c); }));
           })
      .def("hash", [](const ConstrainedMesh& c) { return without_gil([&] { return c.hash().to_string(); }); })
      .def("verify", [](const ConstrainedMesh& c, const Points& points, const Pairs& segments,
                        const cadt::ConstraintOptions& constraints) {
        const cadt::PointsView view = view_of(points);
        return report_of(without_gil([&] { return cadt::verify(view, segments_of(segments), c, constraints); }));
      });
}

void bind_polygons(nb::module_& m) {
  using Polygons = std::shared_ptr<cadt::PolygonsResult>;
  struct PolygonsOf {
    Polygons result;
  };
  nb::class_<PolygonsOf>(m, "Polygons")
      .def_prop_ro(
          "triangles", [](const PolygonsOf& p) { return array_of(p.result->triangles(), 3, p.result); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "triangle_offsets", [](const PolygonsOf& p) { return array_of(p.result->triangle_offsets(), 0, p.result); },
          nb::rv_policy::automatic)
      .def_prop_ro("problems",
                   [](const PolygonsOf& p) {
                     nb::list list;
                     for (const cadt::PolygonProblem& problem : p.result->problems())
                       list.append(nb::make_tuple(problem.polygon, std::string(cadt::to_string(problem.status)),
                                                  problem.first, problem.second));
                     return list;
                   })
      .def_prop_ro("statistics", [](const PolygonsOf& p) { return to_dict(p.result->statistics()); });
  m.def(
      "triangulate_polygons",
      [](const Points& points, const Offsets& rings, const Offsets& polygons, cadt::Options& options,
         const nb::object& progress) {
        const cadt::PointsView view = view_of(points);
        return PolygonsOf{std::make_shared<cadt::PolygonsResult>(Call(progress)(options, [&] {
          return cadt::triangulate_polygons(view, elements_of(rings), elements_of(polygons), options);
        }))};
      },
      nb::arg("points"), nb::arg("ring_offsets"), nb::arg("polygon_offsets"), nb::arg("options"),
      nb::arg("progress") = nb::none());
}

void bind_labels(nb::module_& m) {
  using Image = nb::ndarray<const std::int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  m.def("label_segments", [](const Image& labels) {
    cadt::LabelSegments found =
        without_gil([&] { return cadt::label_segments(elements_of(labels), labels.shape(1), labels.shape(0)); });
    return nb::make_tuple(array_of(std::move(found.xy), 2), array_of_pairs(found.segments),
                          array_of_pairs(found.sides));
  });
  m.def("triangle_labels", [](const Coordinates& xy, const Indices& triangles, const Image& labels) {
    return array_of(without_gil([&] {
      return cadt::triangle_labels(elements_of(xy), elements_of(triangles), elements_of(labels), labels.shape(1),
                                   labels.shape(0));
    }));
  });
}

}  // namespace

void bind_constrained(nb::module_& m) {
  nb::class_<cadt::ConstraintOptions>(m, "ConstraintOptions")
      .def(
          "__init__",
          [](cadt::ConstraintOptions* self, const std::string& crossing, double grid, const std::string& domain,
             const Coordinates& holes, const nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig>& regions) {
            new (self) cadt::ConstraintOptions(constraints_of(crossing, grid, domain, holes, regions));
          },
          nb::arg("crossing"), nb::arg("grid"), nb::arg("domain"), nb::arg("holes"), nb::arg("regions"));
  bind_constrained_mesh(m);
  m.def(
      "triangulate_constrained",
      [](const Points& points, const Pairs& segments, const cadt::ConstraintOptions& constraints,
         cadt::Options& options, const nb::object& progress) {
        const cadt::PointsView view = view_of(points);
        return Call(progress)(
            options, [&] { return cadt::triangulate_constrained(view, segments_of(segments), constraints, options); });
      },
      nb::arg("points"), nb::arg("segments"), nb::arg("constraints"), nb::arg("options"),
      nb::arg("progress") = nb::none());
  m.def(
      "triangulate_constrained_by",
      [](const Shared& shared, const Points& points, const Pairs& segments, const cadt::ConstraintOptions& constraints,
         const cadt::Options& options, const nb::object& progress) {
        const cadt::PointsView view = view_of(points);
        return shared->run(options, progress, [&](cadt::Triangulator& own) {
          return own.triangulate_constrained(view, segments_of(segments), constraints);
        });
      },
      nb::arg("triangulator"), nb::arg("points"), nb::arg("segments"), nb::arg("constraints"), nb::arg("options"),
      nb::arg("progress") = nb::none());
  m.def(
      "triangulate_constrained_on_device",
      [](const Shared& shared, const DeviceCoordinates& points, const std::pair<std::uintptr_t, std::size_t>& segments,
         const cadt::ConstraintOptions& constraints, const cadt::Options& options, const nb::object& progress) {
        const cadt::DeviceArray pairs = {reinterpret_cast<void*>(segments.first), segments.second};
        return std::make_shared<DeviceMesh>(shared, shared->run(options, progress, [&](cadt::Triangulator& own) {
          return own.triangulate_constrained(points.points(), pairs, constraints);
        }));
      },
      nb::arg("triangulator"), nb::arg("points"), nb::arg("segments"), nb::arg("constraints"), nb::arg("options"),
      nb::arg("progress") = nb::none());
  m.def("polyline_segments", [](const Offsets& offsets, const IndexArray& vertices) {
    return array_of_pairs(cadt::polyline_segments(elements_of(offsets), elements_of(vertices)));
  });
  m.def("ring_segments", [](const Offsets& offsets, const IndexArray& vertices) {
    return array_of_pairs(cadt::ring_segments(elements_of(offsets), elements_of(vertices)));
  });
  m.def("find_crossings", [](const Points& points, const Pairs& segments, unsigned threads) {
    const cadt::PointsView view = view_of(points);
    cadt::Options options;
    options.threads = threads;
    const nb::object none = nb::none();
    return array_of_pairs(
        Call(none)(options, [&] { return cadt::find_crossings(view, segments_of(segments), options); }));
  });
  bind_polygons(m);
  bind_labels(m);
}

}  // namespace cadt_python
