// SPDX-License-Identifier: Apache-2.0
// Reports of the verifiers.
#include "common/c_interface/convert.hpp"

using namespace cadt::c_interface;

namespace {

template <class T>
std::span<const T> array_of(const T* values, std::size_t count, const char* name) {
  if (count != 0) require(values, name);
  return {values, count};
}

}  // namespace

extern "C" {

cadt_status cadt_verify(const cadt_points* points, const cadt_mesh_view* mesh, const cadt_options* options,
                        cadt_report** report) {
  return guarded([&] {
    auto& result = required(report, "report");
    const cadt::PointsView at = points_of(points);
    const cadt_mesh_view m = take(mesh, "mesh");
    std::vector<cadt::Duplicate> duplicates;
    for (const cadt_duplicate& d : array_of(m.duplicates, m.duplicate_count, "mesh->duplicates"))
      duplicates.push_back({d.point, d.representative});
    cadt::MeshView view;
    view.triangles = array_of(m.triangles, indices_of(m.triangle_count), "mesh->triangles");
    if (m.neighbors != nullptr) view.neighbors = {m.neighbors, indices_of(m.triangle_count)};
    view.hull = array_of(m.hull, m.hull_count, "mesh->hull");
    view.duplicates = duplicates;
    view.has_duplicates = m.has_duplicates != 0;
    if (m.edge_flags != nullptr) view.edge_flags = {m.edge_flags, m.triangle_count};
    const cadt::VerifyOptions how{.threads = m.threads, .canonical_ties = m.any_ties == 0};
    result =
        new cadt_report(options == nullptr ? cadt::verify(at, view, how)
                                           : cadt::verify_on_device(at, view, CallOptions(options).begin_call(), how));
  });
}

cadt_status cadt_triangulation_verify(const cadt_triangulation* mesh, const cadt_points* points,
                                      const cadt_options* options, cadt_report** report) {
  return guarded([&] {
    auto& result = required(report, "report");
    const cadt::Triangulation& m = required(mesh, "mesh").mesh;
    const cadt::PointsView at = points_of(points);
    result = new cadt_report(options == nullptr ? cadt::verify(at, m)
                                                : cadt::verify_on_device(at, m, CallOptions(options).begin_call()));
  });
}

cadt_status cadt_report_ok(const cadt_report* report, int32_t* ok) {
  return guarded([&] { required(ok, "ok") = required(report, "report").report.ok ? 1 : 0; });
}

cadt_status cadt_report_summary(const cadt_report* report, const char** summary) {
  return guarded([&] { required(summary, "summary") = required(report, "report").summary.c_str(); });
}

cadt_status cadt_report_size(const cadt_report* report, size_t* checks) {
  return guarded([&] { required(checks, "checks") = required(report, "report").report.checks.size(); });
}

cadt_status cadt_report_check(const cadt_report* report, size_t index, cadt_check* check) {
  return guarded([&] {
    const auto& checks = required(report, "report").report.checks;
    if (index >= checks.size())
      throw InvalidArgument("index", "there are " + std::to_string(checks.size()) + " checks, none has the number " +
                                         std::to_string(index));
    const cadt::Check& found = checks[index];
    cadt_check c{};
    c.name = found.name.c_str();
    c.what = found.what.c_str();
    c.passed = found.passed ? 1 : 0;
    c.failures = found.failures;
    c.first = found.first;
    give(check, c, "check");
  });
}

void cadt_report_free(cadt_report* report) { delete report; }
}
