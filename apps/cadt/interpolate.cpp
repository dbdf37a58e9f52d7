// SPDX-License-Identifier: Apache-2.0
// cadt interpolate: values between the points, at given places.
#include "commands.hpp"
#include "failure.hpp"
#include "query.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cadt::cli {
namespace {

std::vector<std::string> interpolate_formats() {
  std::vector<std::string> all = io::array_write_formats();
  all.push_back("xyz");
  return all;
}

int run(const QueryOptions& options) {
  const Output output = plan_query_output(options, interpolate_formats(), "txt");
  QueryRun run(options);
  io::Values values = run.read_values();
  if (output.format == "xyz" && values.per_row != 1) {
    throw Failure(exit_usage, fmt::format("{}: {} values a point, and .xyz has room for one: write a .csv, .txt, .npy "
                                          "or .npz",
                                          options.values, values.per_row));
  }
  io::PointSet queries = run.read_queries();
  run.make_mesh();
  const std::size_t per_row = values.per_row;
  const std::vector<double> at_vertices = run.values_of_vertices(std::move(values));
  const Outside outside = options.outside == "nearest" ? Outside::nearest : Outside::nan;
  const std::vector<double> found = run.ask("interpolating", [&](MeshQueries& mesh) {
    return mesh.interpolate(at_vertices, queries.view(), method_of(options), outside);
  });
  std::size_t without = 0;
  for (std::size_t i = 0; i < found.size(); i += per_row) without += std::isnan(found[i]) ? 1 : 0;

  const io::NamedArray columns[] = {{"value", std::span<const double>(found), per_row == 1 ? std::size_t{0} : per_row}};
  const auto write = [&] {
    if (output.format == "xyz") {
      queries.height = found;
      io::write_points(output.path, queries, "xyz");
    } else {
      io::write_arrays(output.path, columns, output.format);
    }
  };
  run.write(output, write,
            {{"queries", std::to_string(queries.size())}, {"without", fmt::format("{} (outside: nan)", without)}});
  return exit_done;
}

}  // namespace

void add_interpolate(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("interpolate", "values between the points: linear, nearest, natural neighbours");
  const auto options = std::make_shared<QueryOptions>();
  add_input_options(*command, options->input, "POINTS", "file with the points of the mesh");
  add_query_segments(*command, *options);
  add_query_points(*command, *options);
  add_value_options(*command, *options);
  command
      ->add_option("--outside", options->outside,
                   "outside of the convex hull: nan (default) or nearest (the nearest point's value)")
      ->type_name("nan|nearest")
      ->check(CLI::IsMember({"nan", "nearest"}).description(""));
  add_query_output(
      *command, *options, interpolate_formats(),
      "file for the values, a row a query; .xyz has the query's x and y before the value; default: text on "
      "standard output");
  add_query_work(*command, *options);
  command->footer(
      "A file of values may have several columns: all of them are interpolated at once.\n\n"
      "Examples:\n"
      "  cadt interpolate terrain.xyz path.xy --method natural -o path.xyz\n"
      "      the heights along a path\n"
      "  cadt interpolate terrain.xyz path.xy --segments banks.obj -o path.xyz\n"
      "      the same with breaklines, whose points have heights as well\n"
      "  cadt interpolate stations.csv grid.npy --columns lon,lat --values temperature.txt -o field.npy\n"
      "      values from a file of their own\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
