// SPDX-License-Identifier: Apache-2.0
#include "region_output.hpp"

#include "text.hpp"

namespace cadt::cli {

void add_region_output_options(CLI::App& command, OutputOptions& o) {
  add_output_options(command, o, join(io::region_write_formats(), " "), ".node .ele .poly .edge");
}

io::RegionMesh RegionResult::view() const {
  return {points.xy, points.height, triangles, region, region_name, segments, hull, holes, regions, crs};
}

void append_inside(RegionResult& result, const ConstrainedTriangulation& mesh, std::int32_t first_point) {
  const auto triangles = mesh.mesh().triangles();
  const auto inside = mesh.inside();
  const auto region = mesh.region();
  for (std::size_t t = 0; t < inside.size(); ++t) {
    if (inside[t] == 0) continue;
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) result.triangles.push_back(triangles[k] + first_point);
    result.region.push_back(region[t]);
  }
  for (const Segment& edge : mesh.constrained_edges()) {
    result.segments.push_back({edge[0] + first_point, edge[1] + first_point});
  }
}

RegionResult region_result(const Graph& graph, const ConstrainedTriangulation& mesh, Domain domain) {
  RegionResult result;
  result.points = points_of(graph, mesh);
  result.crs = graph.crs;
  result.holes = graph.holes;
  result.regions = graph.regions;
  append_inside(result, mesh);
  const auto hull = mesh.mesh().hull();
  if (domain == Domain::hull) result.hull.assign(hull.begin(), hull.end());
  return result;
}

void write_regions(const std::vector<Output>& outputs, const OutputOptions& options, const RegionResult& result,
                   ProgressLine& line) {
  const io::RegionMesh mesh = result.view();
  write_outputs(outputs, options, line,
                [&](const std::string& path, const io::WriteOptions& how) { io::write_region_mesh(path, mesh, how); });
}

}  // namespace cadt::cli
