// SPDX-License-Identifier: Apache-2.0
// cadt locate: the triangle that contains a point, or its nearest points.
#include "commands.hpp"
#include "failure.hpp"
#include "numbers.hpp"
#include "query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

struct LocateCommand {
  QueryOptions query;
  bool barycentric = false, nearest = false;
  std::size_t k = 1;
};

std::string found(std::size_t missing, std::size_t all) { return fmt::format("{} of {}", all - missing, all); }

void write_nearest(QueryRun& run, const LocateCommand& command, const io::PointSet& queries, const Output& output) {
  const std::vector<std::int32_t> vertices =
      run.ask("searching", [&](MeshQueries& mesh) { return mesh.nearest_vertices(queries.view(), command.k); });
  const io::NamedArray columns[] = {
      {"point", std::span<const std::int32_t>(vertices), command.k == 1 ? std::size_t{0} : command.k}};
  run.write(output, [&] { io::write_arrays(output.path, columns, output.format); },
            {{"queries", std::to_string(queries.size())}, {"nearest", fmt::format("{} each", command.k)}});
}

void write_triangles(QueryRun& run, const LocateCommand& command, const io::PointSet& queries, const Output& output) {
  Located located;
  if (command.barycentric) {
    located = run.ask("locating", [&](MeshQueries& mesh) { return mesh.locate_barycentric(queries.view()); });
  } else {
    located.triangles = run.ask("locating", [&](MeshQueries& mesh) { return mesh.locate(queries.view()); });
  }
  std::vector<io::NamedArray> columns{{"triangle", std::span<const std::int32_t>(located.triangles), 0}};
  if (command.barycentric) columns.push_back({"barycentric", std::span<const double>(located.barycentric), 3});
  const auto outside = std::count(located.triangles.begin(), located.triangles.end(), -1);
  run.write(output, [&] { io::write_arrays(output.path, columns, output.format); },
            {{"inside", found(static_cast<std::size_t>(outside), queries.size())}});
}

int run(const LocateCommand& command) {
  if (command.nearest && command.barycentric) {
    throw Failure(exit_usage, "--barycentric is about triangles, --nearest about points: leave one of them out");
  }
  if (command.k != 1 && !command.nearest) throw Failure(exit_usage, "-k belongs to --nearest: add it, or leave -k out");
  const Output output = plan_query_output(command.query, io::array_write_formats(), "txt");
  if (command.barycentric && output.format == "npy") {
    throw Failure(exit_usage, "triangles and barycentric coordinates are two arrays: write an .npz or a .csv");
  }
  QueryRun run(command.query);
  const io::PointSet queries = run.read_queries();
  if (command.k > max_results() / queries.size()) {
    throw Failure(exit_usage, fmt::format("-k {}: {} results for {} queries, at most {}: take a smaller -k or fewer "
                                          "queries at a time",
                                          command.k, command.k * queries.size(), queries.size(), max_results()));
  }
  run.make_mesh();
  if (command.nearest) {
    write_nearest(run, command, queries, output);
  } else {
    write_triangles(run, command, queries, output);
  }
  return exit_done;
}

}  // namespace

void add_locate(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("locate", "find the triangle or the nearest points of each query");
  const auto options = std::make_shared<LocateCommand>();
  add_input_options(*command, options->query.input, "POINTS", "file with the points of the mesh");
  add_query_segments(*command, options->query);
  add_query_points(*command, options->query);
  command->add_flag("--barycentric", options->barycentric,
                    "also the barycentric coordinates, in the order of the triangle's corners; nan outside");
  command->add_flag("--nearest", options->nearest, "the index of the nearest point instead of the triangle");
  command->add_option("-k", options->k, "with --nearest: so many points, nearest first (default: 1)")
      ->type_name("K")
      ->transform(whole_number(1, 1000000));
  add_query_output(*command, options->query, io::array_write_formats(),
                   "file for the answers, a row a query; default: text on standard output");
  add_query_work(*command, options->query);
  command->footer(
      "Prints the index of a triangle for each query, counted from 0, in the order of the triangles that\n"
      "`cadt triangulate POINTS` writes; -1 outside of the convex hull. A query on an edge or vertex belongs to the\n"
      "lowest of its triangles. Exact, and the same on every device.\n\n"
      "Examples:\n"
      "  echo 0.5 0.5 | cadt locate points.xy -\n"
      "  cadt locate points.xy where.csv --barycentric -o answers.npz\n"
      "  cadt locate stations.csv cities.csv --columns lon,lat --nearest -k 3 -o nearest.csv\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
