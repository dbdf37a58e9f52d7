// SPDX-License-Identifier: Apache-2.0
#include "region_output.hpp"

#include "text.hpp"

namespace cadt::cli {

void add_region_output_options(CLI::App& command, OutputOptions& o) {
  add_output_options(command, o, join(io::region_write_formats(), " "), ".node .ele .poly .edge");
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

void write_regions(const std::vector<Output>& outputs, const OutputOptions& options, const RegionResult& result,
                   ProgressLine& line) {
  io::RegionMesh mesh;
  mesh.xy = result.points.xy;
  mesh.height = result.points.height;
  mesh.triangles = result.triangles;
  mesh.region = result.region;
  mesh.region_name = result.region_name;
  mesh.segments = result.segments;
  mesh.hull = result.hull;
  write_outputs(outputs, options, line, [&](const std::string& path, const io::WriteOptions& how) {
    io::write_region_mesh(path, mesh, how);
  });
}

}  // namespace cadt::cli
