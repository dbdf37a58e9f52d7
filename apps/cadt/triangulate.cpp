// SPDX-License-Identifier: Apache-2.0
#include "triangulate.hpp"

#include "commands.hpp"
#include "failure.hpp"
#include "interrupt.hpp"
#include "large_picture.hpp"
#include "numbers.hpp"
#include "text.hpp"

#include <cadt/cadt.hpp>
#include <cadt/io/mesh_file.hpp>
#include <cadt/io/region_file.hpp>

#include <fmt/format.h>

#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

std::vector<Output> check_outputs(const TriangulateOptions& options) {
  const bool segments = has_segments(options.input, options.segments);
  const auto formats = segments ? io::region_write_formats() : io::mesh_write_formats();
  const std::vector<std::string> inputs{options.input.path, options.segments.file};
  auto outputs = plan_outputs(options.output.outputs, options.output.formats, formats, inputs);
  if (segments && options.stabilize != "off")
    throw Failure(exit_usage, "--stabilize is for points without segments: leave it out");
  if (options.timing && options.stats.empty())
    throw Failure(exit_usage, "--timing belongs to --stats: add it, or leave --timing out");
  if (options.kernel_times && options.stats.empty())
    throw Failure(exit_usage, "--kernel-times belongs to --stats: add it, or leave --kernel-times out");
  if (options.strategy == "stars" && options.stabilize != "off")
    throw Failure(exit_usage, "--stabilize is about flips, and --strategy stars has hardly any: leave one of them out");
  if (options.flip_threshold && options.stabilize == "off")
    throw Failure(exit_usage, "--flip-threshold belongs to --stabilize defer or paper: add one, or leave it out");
  if (options.epsilon && options.stabilize != "paper")
    throw Failure(exit_usage, "--epsilon belongs to --stabilize paper: add it, or leave --epsilon out");
  if (options.stabilize == "paper" && options.verify) {
    throw Failure(
        exit_usage,
        "--stabilize paper may leave illegal edges, so --verify would refuse its mesh: leave one of them out; "
        "the summary tells how many triangles differ from the exact mesh");
  }
  if (!options.stats_file()) return outputs;
  for (const Output& output : outputs) {
    if (output.path == options.stats || same_output(output.path, options.stats)) {
      throw Failure(exit_usage, fmt::format("--stats and -o both go to {}; give one of them another name",
                                            display_name(output.path, false)));
    }
  }
  if (options.stats != "-") {
    require_no_input(options.stats, inputs);
    require_writable(options.stats);
  }
  return outputs;
}

// The library names a point by its index only; here the file is known.
Triangulation triangulate_file(const io::PointSet& points, const std::string& name, bool as_floats,
                               const Options& options) {
  try {
    const InPhase phase(Phase::cooperative);
    if (as_floats) {
      const std::vector<float> xy(points.xy.begin(), points.xy.end());
      return triangulate(std::span<const float>(xy), options);
    }
    return triangulate(points.view(), options);
  } catch (const InputError& e) {
    throw Failure(exit_file, fmt::format("{}: point {} (counted from 0): {}", name, e.index(), e.what()));
  }
}

// Number of triangles in which a mesh of --stabilize paper differs from the exact one.
std::size_t differing_triangles(const io::PointSet& points, const std::string& name, bool as_floats, Options options,
                                const Triangulation& mesh) {
  options.tuning.stabilize = Stabilize::off;
  options.statistics = StatisticsDetail::none;
  options.tuning.kernel_times = false;
  options.progress = nullptr;
  return count_differing(mesh, triangulate_file(points, name, as_floats, options));
}

int run(const TriangulateOptions& options) {
  RunReport report;
  report.outputs = check_outputs(options);
  if (has_segments(options.input, options.segments)) return run_graph(options, std::move(report.outputs));
  ProgressLine line(options.quiet);
  const Options chosen = library_options(options, line);
  const std::string name = display_name(options.input.path, true);

  tiles::Stopwatch watch;
  line.step(fmt::format("reading {}", name));
  io::PointSet points = read_input(options.input);
  round_to_floats(points, options.input, options.quiet);
  report.input = options.input.path;
  report.input_format = points.format;
  report.heights = !points.height.empty();
  report.read_seconds = watch.lap();

  line.start(points.size());
  const Triangulation mesh = triangulate_file(points, name, options.input.floats, chosen);
  check_interrupt();
  report.mesh = &mesh;
  report.triangulate_seconds = watch.lap();
  line.clear();
  judge_dimension(mesh, name, options);
  report.hash = mesh.hash().to_string();

  report.stabilize = options.stabilize;
  report.flip_threshold = chosen.tuning.flip_threshold;
  report.epsilon = chosen.tuning.quality_epsilon;
  if (chosen.tuning.stabilize == Stabilize::paper) {
    line.step("comparing with the exact mesh");
    report.differing = differing_triangles(points, name, options.input.floats, chosen, mesh);
    line.clear();
  }

  watch.lap();
  if (options.verify) {
    line.step("verifying");
    VerifyOptions verify_options;
    verify_options.threads = options.device.threads;
    report.verification = verify(points.view(), mesh, verify_options);
    report.verify_seconds = watch.lap();
    line.clear();
    require_verified(*report.verification);
  }

  watch.lap();
  write_outputs(report.outputs, options.output, line, [&](const std::string& path, const io::WriteOptions& how) {
    if (how.format == "png" && is_large_picture(points, mesh)) {
      write_large_picture(path, points, mesh, how);
    } else {
      io::write_mesh(path, points, mesh, how);
    }
  });
  report.write_seconds = report.outputs.empty() ? 0 : watch.lap();
  print_reports(options, report);
  return exit_done;
}

void add_mesh_options(CLI::App& command, TriangulateOptions& o) {
  add_output_options(command, o.output, join(io::mesh_write_formats(), " ") + ", with segments poly edge geojson, too",
                     ".node .ele .neigh");
  command
      .add_option("--order", o.order,
                  "order of the triangles: canonical (equal files from every device and run) or fast")
      ->type_name("ORDER")
      ->check(CLI::IsMember({"canonical", "fast"}).description(""));
}

void add_work_options(CLI::App& command, TriangulateOptions& o) {
  add_device_options(command, o.device);
  add_memory_option(command, o.device);
  command
      .add_option("--strategy", o.strategy,
                  "how the mesh is computed; the result is the same: locks (parallel insertion in one mesh), stars "
                  "(local stars "
                  "without locks, the residual vertices by insertion) or auto (default: the faster one)")
      ->type_name("HOW")
      ->check(CLI::IsMember({"auto", "locks", "stars"}).description(""));
  command
      .add_option(
          "--stabilize", o.stabilize,
          "edges that are flipped again and again: off (default, no limit), defer (left to the legality sweep, the "
          "same mesh) or paper (flipped only if quality improves: some edges stay illegal)")
      ->type_name("MODE")
      ->check(CLI::IsMember({"off", "defer", "paper"}).description(""));
  command.add_option("--flip-threshold", o.flip_threshold, "flips of an edge before --stabilize applies (default: 3)")
      ->type_name("R")
      ->transform(whole_number(0, 1000));
  command
      .add_option("--epsilon", o.epsilon,
                  "improvement that --stabilize paper requires: degrees of the smallest angle, or relative "
                  "incircle determinant (default: 1e-4)")
      ->type_name("E")
      ->check(number_within(0));
  command.add_flag("--strict", o.strict,
                   "exit 4 if there are no triangles (fewer than three points, or all on one line)");
  command.add_flag("--verify", o.verify, "check the mesh exactly before anything is written; exit 7 if it fails");
  command
      .add_flag("--stats{table}", o.stats,
                "all counters and times: as a table on standard error, with =FILE.json as JSON "
                "in a file, with =- as JSON on standard output")
      ->type_name("FILE");
  command.add_flag("--timing", o.timing, "with --stats: also how the threads spend their time; makes them slower");
  command.add_flag("--kernel-times", o.kernel_times, "with --stats: also the time of each kernel");
  command.add_flag("-q,--quiet", o.quiet, "nothing on standard error but errors and what was asked for");
}

}  // namespace

Options library_options(const TriangulateOptions& options, ProgressLine& line) {
  Options result = library_options(options.device);
  result.order = options.order == "fast" ? Order::fast : Order::canonical;
  result.tuning.strategy = options.strategy == "locks"   ? Strategy::locks
                           : options.strategy == "stars" ? Strategy::stars
                                                         : Strategy::automatic;
  result.tuning.stabilize = options.stabilize == "paper"   ? Stabilize::paper
                            : options.stabilize == "defer" ? Stabilize::defer
                                                           : Stabilize::off;
  result.tuning.flip_threshold = options.flip_threshold.value_or(result.tuning.flip_threshold);
  result.tuning.quality_epsilon = options.epsilon.value_or(result.tuning.quality_epsilon);
  if (options.stats.empty()) result.statistics = StatisticsDetail::none;  // nobody will see them
  if (options.timing) result.statistics = StatisticsDetail::timing;
  result.tuning.kernel_times = options.kernel_times;
  result.stop = interrupt_token();
  result.progress = [&line](const Progress& progress) { line.update(progress); };
  return result;
}

void judge_dimension(const Triangulation& mesh, const std::string& name, const TriangulateOptions& options) {
  if (mesh.dimension() >= 2) return;
  const std::size_t distinct = mesh.number_of_points() - mesh.duplicates().size();
  // Of files of segments there is nothing to choose.
  const bool choice = !has_segments(options.input, options.segments);
  const std::string why = distinct < 3 ? fmt::format("{} distinct {}, at least three are needed", distinct,
                                                     distinct == 1 ? "point" : "points")
                                       : fmt::format("all {} distinct points lie on one line", distinct);
  if (options.strict) {
    throw Failure(exit_degenerate, fmt::format("{}: no triangles: {}; {}leave out --strict to get an empty mesh", name,
                                               why, choice ? "check --columns and --project, or " : ""));
  }
  if (!options.quiet) {
    say(fmt::format("cadt: warning: {}: no triangles: {}; the mesh is empty. {}--strict makes this an error.\n", name,
                    why, choice ? "Check --columns and --project if you expected some; " : ""));
  }
}

void require_verified(const VerifyReport& report) {
  if (report.ok) return;
  throw Failure(exit_verify,
                fmt::format("the mesh is wrong: {}; no output was written. This is a defect of cadt: please "
                            "report it with the command line and the input",
                            report.summary()));
}

void print_reports(const TriangulateOptions& options, const RunReport& report) {
  if (options.stats_file()) write_text(options.stats, statistics_json(report));
  print_summary(summary_text(report), report.outputs.empty() && options.stats != "-", options.quiet);
  if (options.stats_table()) say("\n" + statistics_text(report));
}

void add_triangulate(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("triangulate", "triangulate points, with segments if there are; write meshes and pictures");
  const auto options = std::make_shared<TriangulateOptions>();
  add_input_options(*command, options->input, "IN", "file with points, or with points and segments", true);
  add_floats_option(*command, options->input);
  add_segment_options(*command, options->segments);
  add_mesh_options(*command, *options);
  add_work_options(*command, *options);
  command->footer(
      "Without -o the summary goes to standard output, with -o to standard error.\n\n"
      "Examples:\n"
      "  cadt triangulate points.xyz -o mesh.vtu -o mesh.png\n"
      "      a mesh for ParaView with the heights of the points, and a picture of it\n"
      "  cadt triangulate survey.csv --columns lon,lat,depth -o sea.ply --verify\n"
      "      a table with a header; the mesh is checked before it is written\n"
      "  zcat points.txt.gz | cadt triangulate - -f txt -o - -t off > mesh.off\n"
      "      from a pipe to standard output\n"
      "  cadt triangulate land.geojson --domain even_odd -o land.png -o land.ply\n"
      "      what the polygons enclose\n"
      "  cadt triangulate terrain.xyz --segments breaklines.obj -o terrain.vtu\n"
      "      a terrain with breaklines as edges\n\n" +
      std::string(exit_codes_help));
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
