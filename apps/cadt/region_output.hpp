// SPDX-License-Identifier: Apache-2.0
// Meshes of regions as outputs, of cadt triangulate, polygons and labels.
#pragma once

#include "graph.hpp"
#include "output_options.hpp"

#include <cadt/constrained.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/io/region_file.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cadt::cli {

/// add_output_options() for formats of regions.
void add_region_output_options(CLI::App& command, OutputOptions& options);

/// What is written, in arrays of its own.
struct RegionResult {
  io::PointSet points;
  std::vector<std::int32_t> triangles, region, hull;
  std::vector<Segment> segments;
  std::vector<std::array<double, 2>> holes;
  std::vector<Region> regions;
  std::string region_name = "region", crs;

  [[nodiscard]] io::RegionMesh view() const;
};

/// Appends the triangles inside, with their regions, and the constrained edges; points count from `first_point`.
void append_inside(RegionResult& result, const ConstrainedTriangulation& mesh, std::int32_t first_point = 0);

/// What is written of a mesh with segments; of all triangles also their hull.
[[nodiscard]] RegionResult region_result(const Graph& graph, const ConstrainedTriangulation& mesh, Domain domain);

/// As write_outputs().
void write_regions(const std::vector<Output>& outputs, const OutputOptions& options, const RegionResult& result,
                   ProgressLine& line);

}  // namespace cadt::cli
