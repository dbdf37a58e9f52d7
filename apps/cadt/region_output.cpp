// SPDX-License-Identifier: Apache-2.0
#include "region_output.hpp"

#include "failure.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "text.hpp"

#include <fmt/format.h>

namespace cadt::cli {

void add_region_output_options(CLI::App& command, RegionOutputOptions& o) {
  command
      .add_option("-o,--output", o.outputs,
                  "write the mesh or a picture of it; may be given several times; '-' is standard output (with -t)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option("-t,--to", o.formats,
                  "format of the outputs: " + join(io::region_write_formats(), " ") +
                      "; default: from each suffix. Once for all outputs, or once for each (auto: from the suffix)")
      ->type_name("FORMAT")
      ->allow_extra_args(false);
  command.add_option("--base", o.base, "first index in .node .ele .poly .edge files: 0 or 1 (default: 0)")
      ->type_name("0|1")
      ->check(CLI::IsMember({0, 1}).description(""));
  command.add_flag("--ascii", o.ascii, "text instead of binary where the format has both (ply)");
  command.add_option("--width", o.width, "width of pictures (default: 1600)")
      ->type_name("PIXELS")
      ->check(CLI::Range(16, 32768).description(""));
}

io::RegionMesh RegionResult::view() const {
  return {points.xy, points.height, triangles, region, region_name, segments, hull};
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
  append_inside(result, mesh);
  const auto hull = mesh.mesh().hull();
  if (domain == Domain::hull) result.hull.assign(hull.begin(), hull.end());
  return result;
}

void write_regions(const std::vector<Output>& outputs, const RegionOutputOptions& options, const RegionResult& result,
                   ProgressLine& line) {
  const io::RegionMesh mesh = result.view();
  io::WriteOptions write;
  write.base = options.base;
  write.ascii = options.ascii;
  write.width = options.width;
  std::vector<std::string> written;
  for (const Output& output : outputs) {
    {
      const InPhase phase(writing_phase(output.path));
      line.step(fmt::format("writing {}", display_name(output.path, false)));
      write.format = output.format;
      io::write_region_mesh(output.path, mesh, write);
      if (output.path == "-") finish_stdout();
    }
    written.push_back(display_name(output.path, false));
    try {
      check_interrupt();
    } catch (const Cancelled&) {
      line.clear();
      say(fmt::format("cadt: complete before the interruption: {}\n", join(written)));
      throw;
    }
  }
  line.clear();
}

}  // namespace cadt::cli
