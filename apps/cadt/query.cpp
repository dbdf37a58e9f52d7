// SPDX-License-Identifier: Apache-2.0
#include "query.hpp"

#include "failure.hpp"
#include "interrupt.hpp"
#include "text.hpp"

#include <fmt/format.h>

namespace cadt::cli {

void add_query_segments(CLI::App& command, QueryOptions& o) {
  o.takes_segments = true;
  add_segments_option(command, o.segments);
  add_crossing_option(command, o.segments);
}

void add_query_points(CLI::App& command, QueryOptions& o) {
  command
      .add_option("QUERIES", o.queries,
                  "file with the points to ask for, of any format of POINTS; '-' is standard input, as text unless "
                  "--query-format says otherwise")
      ->required();
  command.add_option("--query-format", o.query_format, "format of QUERIES; default: from the suffix")
      ->type_name("FORMAT")
      ->check(CLI::IsMember(io::point_read_formats(), CLI::ignore_case).description(""));
  command.add_option("--query-columns", o.query_columns, "columns of QUERIES, as --columns for POINTS")
      ->type_name("X,Y");
}

void add_value_options(CLI::App& command, QueryOptions& o) {
  command
      .add_option("--values", o.values,
                  "values at the points: z, their third coordinate (default; --columns names it), or a file with a row "
                  "for each point, in their order: " +
                      join(io::value_read_formats(), " "))
      ->type_name("z|FILE");
  command
      .add_option("--method", o.method,
                  "between the points: linear (in the triangle; default), nearest (the nearest point's) or natural "
                  "(natural neighbours: smooth)")
      ->type_name("METHOD")
      ->check(CLI::IsMember({"linear", "nearest", "natural"}).description(""));
}

void add_query_output(CLI::App& command, QueryOptions& o, const std::vector<std::string>& formats,
                      const std::string& what) {
  command.add_option("-o,--output", o.output, what)->type_name("FILE");
  command.add_option("-t,--to", o.format, "format of the output: " + join(formats, " ") + "; default: from the suffix")
      ->type_name("FORMAT");
}

void add_query_work(CLI::App& command, QueryOptions& o) {
  add_device_options(command, o.device);
  add_memory_option(command, o.device);
  command.add_flag("-q,--quiet", o.quiet, "nothing on standard error but errors");
}

Output plan_query_output(const QueryOptions& o, const std::vector<std::string>& formats, const std::string& fallback) {
  std::vector<std::string> format;
  if (!o.format.empty()) {
    format = {o.format};
  } else if (o.output == "-" && !fallback.empty()) {
    format = {fallback};
  }
  if (o.input.path == "-" && o.queries == "-") {
    throw Failure(exit_usage, "only one of POINTS and QUERIES can be standard input");
  }
  if (o.values == "-") throw Failure(exit_usage, "--values takes z or a file, not standard input");
  require_columns(o.query_columns, "--query-columns");
  const std::string values = o.values == "z" ? std::string() : o.values;
  return plan_outputs({o.output}, format, formats, {o.input.path, o.queries, values, o.segments.file}).front();
}

Interpolation method_of(const QueryOptions& o) {
  return o.method == "nearest"   ? Interpolation::nearest
         : o.method == "natural" ? Interpolation::natural
                                 : Interpolation::linear;
}

QueryRun::QueryRun(const QueryOptions& options)
    : line(options.quiet),
      options_(options),
      name_(name_of(options.input, options.segments)),
      library_(library_options(options.device)) {
  const bool segments = options.takes_segments && has_segments(options.input, options.segments);
  library_.statistics = StatisticsDetail::none;
  library_.stop = interrupt_token();
  library_.progress = [this](const Progress& progress) { line.update(progress); };
  line.step(fmt::format("reading {}", name_));
  if (segments) {
    graph_ = read_graph(options.input, options.segments, options.quiet);
    points = std::move(graph_->points);
  } else {
    points = read_input(options.input);
  }
}

void QueryRun::make_mesh() {
  line.start(points.size());
  if (graph_) {
    constrained_ =
        triangulate_graph(points.view(), graph_->segments, name_, constraint_options(options_.segments), library_);
    check_interrupt();
    if (options_.values == "z" && !options_.quiet)
      note_other_heights(points, graph_->own_points, constrained_->mesh(), options_.segments.file);
    if (!constrained_->rounded_valid())
      throw Failure(exit_file,
                    name_ +
                        ": crossings are too close to others for rounded coordinates, so that some triangles "
                        "are turned over or flat; --crossing grid=G keeps them apart");
  } else {
    mesh_ = guarded("triangulating", {}, [&] { return triangulate(points.view(), library_); });
  }
  library_.progress = nullptr;
  queries_.emplace(guarded("preparing", {}, [&] {
    return constrained_ ? MeshQueries(points.view(), *constrained_, library_)
                        : MeshQueries(points.view(), mesh_, library_);
  }));
  line.clear();
  if (mesh().dimension() < 2 && !options_.quiet) {
    say(
        fmt::format("cadt: warning: {}: no triangles: the points are fewer than three, or all on one line; check "
                    "--columns and --project if you expected some\n",
                    name_));
  }
}

io::Values QueryRun::read_values() const {
  if (options_.values == "z") {
    if (points.height.empty()) {
      const char* const why = graph_
                                  ? "the points and those of the segments need a third coordinate each"
                                  : "the points have no third coordinate; name three columns with --columns x,y,depth";
      throw Failure(exit_file, fmt::format("{}: no values: {}, or a file with a row for each point with --values FILE",
                                           name_, why));
    }
    return {points.height, 1};
  }
  io::Values values = io::read_values(options_.values);
  if (values.rows() != points.size()) {
    throw Failure(exit_file, fmt::format("{}: {} rows of values for the {} points of {}; there must be a row for each "
                                         "point, in the same order",
                                         options_.values, values.rows(), points.size(), name_));
  }
  return values;
}

std::vector<double> QueryRun::values_of_vertices(io::Values values) const {
  if (!constrained_) return std::move(values.values);
  return values_at_crossings(points.view(), values.values, values.per_row, *constrained_);
}

io::PointSet QueryRun::read_queries() {
  line.step(fmt::format("reading {}", display_name(options_.queries, true)));
  require_format(options_.queries, options_.query_format, io::point_read_formats(), "--query-format");
  io::ReadOptions read;
  read.format = options_.queries == "-" && options_.query_format.empty() ? "txt" : lower(options_.query_format);
  read.columns = options_.query_columns;
  return io::read_points(options_.queries, read);
}

// The readers let finite coordinates through only, so this is about all of them, or about what an option says.
void QueryRun::refuse(const InputError& error, const std::string& about) const {
  if (!about.empty()) throw Failure(exit_usage, fmt::format("{}: {}", about, error.what()));
  throw Failure(exit_file, fmt::format("{}: {}", name_, error.what()));
}

void QueryRun::write(const Output& output, const std::function<void()>& writer,
                     const std::vector<std::pair<std::string, std::string>>& summary) {
  const std::string name = display_name(output.path, false);
  {
    const InPhase phase(writing_phase(output.path));
    if (output.path != "-") line.step(fmt::format("writing {}", name));
    writer();
    if (output.path == "-") finish_stdout();
  }
  line.clear();
  check_interrupt_after({name});
  if (options_.quiet || output.path == "-") return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const DeviceInfo& device = queries_->device();
  std::string text = key_line("points", std::to_string(points.size()));
  text += key_line("triangles", std::to_string(mesh().number_of_triangles()));
  for (const auto& [key, value] : summary) text += key_line(key, value);
  text += key_line("time", fmt::format("{:.3f} s", seconds));
  text += key_line("back end", fmt::format("{}, {}", to_string(device.backend), device.name));
  say(text + key_line("written", name));
}

}  // namespace cadt::cli
