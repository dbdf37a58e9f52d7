// SPDX-License-Identifier: Apache-2.0
// cadt voronoi: the Voronoi diagram, as arrays, polygons or a picture.
#include "commands.hpp"
#include "failure.hpp"
#include "query.hpp"
#include "rectangle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

struct VoronoiCommand {
  QueryOptions query;
  std::string box;
};

const std::vector<std::string> voronoi_formats{"npz", "geojson", "svg"};

/// The box of the points and a tenth of its longer side around it.
Box default_box(const io::PointSet& points) {
  Box box = rectangle_around(points);
  const double margin = 0.1 * std::max(box.max_x - box.min_x, box.max_y - box.min_y);
  box.min_x -= margin;
  box.min_y -= margin;
  box.max_x += margin;
  box.max_y += margin;
  if (!(box.min_x < box.max_x && box.min_y < box.max_y)) {
    throw Failure(exit_usage, "the points have no extent: say where the cells end with --box x0,y0,x1,y1");
  }
  return box;
}

void write_arrays(const Output& output, const io::PointSet& points, const VoronoiDiagram& diagram,
                  const std::optional<VoronoiPolygons>& polygons) {
  std::vector<io::NamedArray> arrays{
      {"points", std::span<const double>(points.xy), 2},
      {"vertices", std::span<const double>(diagram.vertices), 2},
      {"cell_begin", std::span<const std::uint32_t>(diagram.cell_begin), 0},
      {"cells", std::span<const std::int32_t>(diagram.cells), 0},
      {"ridge_points", std::span<const std::int32_t>(diagram.edge_points), 2},
      {"ridge_vertices", std::span<const std::int32_t>(diagram.edge_vertices), 2},
  };
  if (polygons) {
    arrays.push_back({"polygon_begin", std::span<const std::uint32_t>(polygons->begin), 0});
    arrays.push_back({"polygons", std::span<const double>(polygons->xy), 2});
  }
  io::write_arrays(output.path, arrays, output.format);
}

int run(const VoronoiCommand& command) {
  const Output output = plan_query_output(command.query, voronoi_formats, {});
  std::optional<Box> box = parse_rectangle("--box", command.box);
  QueryRun run(command.query);
  const bool arrays = output.format == "npz";
  if (!box && !arrays) box = default_box(run.points);
  run.make_mesh();
  VoronoiDiagram diagram;
  if (arrays) diagram = run.ask("Voronoi diagram", [](MeshQueries& mesh) { return mesh.voronoi(); });
  std::optional<VoronoiPolygons> polygons;
  if (box) {
    polygons = run.ask(
        "Voronoi cells", [&](MeshQueries& mesh) { return mesh.voronoi_polygons(*box); }, "--box");
  }

  std::vector<std::pair<std::string, std::string>> summary;
  if (arrays) {
    summary.emplace_back("edges", std::to_string(diagram.edge_points.size() / 2));
  }
  if (polygons) {
    summary.emplace_back("cells", fmt::format("{} within {},{},{},{}", io::number_of_cells(*polygons), box->min_x,
                                              box->min_y, box->max_x, box->max_y));
  }
  const auto write = [&] {
    if (arrays) {
      write_arrays(output, run.points, diagram, polygons);
    } else {
      io::write_voronoi(output.path, run.points.xy, *polygons, *box, output.format);
    }
  };
  run.write(output, write, summary);
  return exit_done;
}

}  // namespace

void add_voronoi(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("voronoi", "the Voronoi diagram: arrays, polygons, a picture");
  const auto options = std::make_shared<VoronoiCommand>();
  add_input_options(*command, options->query.input, "POINTS", "file with points");
  add_query_output(*command, options->query, voronoi_formats,
                   "file for the diagram: .npz (arrays), .geojson (polygons), .svg (a picture)");
  command->get_option("--output")->required();
  command
      ->add_option("--box", options->box,
                   "cells end at this rectangle (default: the box of the points and a tenth of its longer side around "
                   "it; .npz has polygons only if this is given)")
      ->type_name("X0,Y0,X1,Y1");
  add_query_work(*command, options->query);
  command->footer(
      "For Triangle's files (.v.node, .v.edge): cadt triangle -v FILE\n\n"
      "Examples:\n"
      "  cadt voronoi stations.csv --columns lon,lat --box -10,35,30,60 -o cells.geojson\n"
      "  cadt voronoi points.xy -o cells.svg\n"
      "  cadt voronoi points.npy -o diagram.npz\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
