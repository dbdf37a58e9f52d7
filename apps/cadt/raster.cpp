// SPDX-License-Identifier: Apache-2.0
// cadt raster: values between the points, at the centres of a grid's cells. With LAS, GIS or GeoTIFF words terrain.cpp
// has already left for python/cadt/terrain.
#include "commands.hpp"
#include "failure.hpp"
#include "query.hpp"
#include "rectangle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cadt::cli {
namespace {

struct RasterCommand {
  QueryOptions query;
  double resolution = 0;
  std::optional<double> max_edge, nodata;
  std::string bounds;
};

/// Cells of size `cell` that cover `length`. What is whole but for the rounding of decimals (2.1 / 0.3) is whole, as in
/// cells_along of python/cadt/_queries.py.
double cells_along(double length, double cell) {
  const double exact = length / cell;
  const double whole = std::round(exact);
  return whole >= 1 && std::fabs(exact - whole) <= std::min(1e-9 * whole, 1e-3) ? whole : std::ceil(exact);
}

Grid make_grid(const RasterCommand& command, const Box& box) {
  const double cell = command.resolution;
  const double columns = cells_along(box.max_x - box.min_x, cell), rows = cells_along(box.max_y - box.min_y, cell);
  if (!(columns >= 1 && rows >= 1)) {
    throw Failure(exit_usage, fmt::format("the points span {} x {}, which gives no cells of {}: say where with "
                                          "--bounds x0,y0,x1,y1",
                                          box.max_x - box.min_x, box.max_y - box.min_y, cell));
  }
  constexpr auto most_cells = static_cast<double>(max_results());
  if (!(columns * rows <= most_cells)) {
    throw Failure(exit_usage, fmt::format("--res {}: {} x {} cells, at most {:.0f} in all: take a larger --res, "
                                          "or tiles with --bounds",
                                          cell, columns, rows, most_cells));
  }
  Grid grid;
  grid.columns = static_cast<std::size_t>(columns);
  grid.rows = static_cast<std::size_t>(rows);
  grid.x0 = box.min_x;
  grid.y0 = box.min_y + rows * cell;  // the top: rows go down
  grid.dx = cell;
  grid.dy = -cell;
  return grid;
}

int run(const RasterCommand& command) {
  const QueryOptions& options = command.query;
  if (options.output.empty() || options.output == "-") {
    if (options.format.empty()) {
      throw Failure(exit_usage, "name the output with -o: dem.asc, dem.npy or dem.png; -o - -t asc is standard output");
    }
  }
  const Output output = plan_query_output(options, io::raster_write_formats(), {});
  if (command.nodata && output.format != "asc") {
    throw Failure(exit_usage, fmt::format("--nodata belongs to .asc files; in .{} cells without data are {}",
                                          output.format, output.format == "npy" ? "nan" : "blank"));
  }
  if (!(command.resolution > 0 && std::isfinite(command.resolution)))
    throw Failure(exit_usage, fmt::format("--res {}: a cell needs a finite size above 0", command.resolution));
  if (command.max_edge && !(*command.max_edge >= 0))
    throw Failure(exit_usage, fmt::format("--max-edge {}: a length is needed, 0 or more", *command.max_edge));
  const std::optional<Box> bounds = parse_rectangle("--bounds", command.bounds);
  QueryRun run(options);
  io::Values values = run.read_values();
  if (values.per_row != 1) {
    throw Failure(exit_file, fmt::format("{}: {} values a point, a raster has one a cell: leave the other columns out",
                                         options.values, values.per_row));
  }
  const Grid grid = make_grid(command, bounds ? *bounds : rectangle_around(run.points));
  run.make_mesh();
  const std::vector<double> at_vertices = run.values_of_vertices(std::move(values));
  const std::vector<double> cells = run.ask("filling the cells", [&](MeshQueries& mesh) {
    return mesh.rasterize(grid, at_vertices, method_of(options),
                          command.max_edge.value_or(std::numeric_limits<double>::infinity()));
  });
  const auto blank = std::count_if(cells.begin(), cells.end(), [](double v) { return std::isnan(v); });
  run.write(output, [&] { io::write_raster(output.path, grid, cells, command.nodata.value_or(-9999), output.format); },
            {{"cells", fmt::format("{} x {}", grid.columns, grid.rows)}, {"no data", std::to_string(blank)}});
  return exit_done;
}

}  // namespace

void add_raster(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("raster", "a grid of values between the points, such as a terrain model");
  const auto options = std::make_shared<RasterCommand>();
  add_input_options(*command, options->query.input, "POINTS", "file with the points of the mesh");
  add_query_segments(*command, options->query);
  add_value_options(*command, options->query);
  command->add_option("--res", options->resolution, "width and height of a cell, in the units of the points")
      ->type_name("R")
      ->required();
  command
      ->add_option("--max-edge", options->max_edge,
                   "no data in triangles with a longer edge: bays and holes in the points stay open")
      ->type_name("L");
  command
      ->add_option("--bounds", options->bounds,
                   "rectangle to cover; the lower left corner is that of a cell (default: the box of the points)")
      ->type_name("X0,Y0,X1,Y1");
  add_query_output(
      *command, options->query, io::raster_write_formats(),
      "file for the raster: .asc (ESRI ASCII grid), .npy (rows x columns), .png (a picture); the first row "
      "is the top one");
  command->get_option("--output")->required();
  command->add_option("--nodata", options->nodata, "value of cells without data in an .asc (default: -9999)")
      ->type_name("V");
  add_query_work(*command, options->query);
  command->footer(
      "A cell has the value at its centre, and no data if that lies outside of the convex hull.\n\n"
      "Examples:\n"
      "  cadt raster terrain.xyz --res 1 -o dem.asc\n"
      "  cadt raster survey.csv --columns easting,northing,depth --res 0.5 --max-edge 20 --method natural -o sea.npy\n"
      "  cadt raster terrain.xyz --segments banks.obj --res 1 -o dem.asc\n"
      "  cadt raster terrain.xyz --res 10 --bounds 500000,4100000,501000,4102000 -o tile.png\n\n"
      "LAS, LAZ, GIS files and GeoTIFF, with pip install \"cadt[terrain]\":\n"
      "  cadt raster scan.laz dem.tif --res 1 --class 2 --max-edge 50\n"
      "  cadt raster scan.laz dem.tif --help\n"
      "      its options: several files, --class, --align, --breaklines, --fill ...\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
