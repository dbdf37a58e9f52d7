// SPDX-License-Identifier: Apache-2.0
// cadt triangulate, where there are segments.
#include "triangulate.hpp"

#include "failure.hpp"
#include "graph.hpp"
#include "interrupt.hpp"
#include "region_output.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <utility>

namespace cadt::cli {

int run_graph(const TriangulateOptions& options, std::vector<Output> outputs) {
  ProgressLine line(options.quiet);
  const Options chosen = library_options(options, line);
  const std::string name = name_of(options.input, options.segments);
  RunReport report;
  report.outputs = std::move(outputs);
  report.domain = options.segments.domain.empty() ? "hull" : options.segments.domain;
  report.crossing = options.segments.crossing.empty() ? "error" : options.segments.crossing;
  report.stabilize = options.stabilize;
  report.flip_threshold = chosen.tuning.flip_threshold;
  report.epsilon = chosen.tuning.quality_epsilon;

  tiles::Stopwatch watch;
  line.step(fmt::format("reading {}", name));
  Graph graph = read_graph(options.input, options.segments, options.quiet);
  if (!options.quiet) note_holes(graph, options.segments);
  round_to_floats(graph.points, options.input, options.quiet);
  const ConstraintOptions constraints = constraint_options(options.segments, graph);
  report.input = options.input.path;
  report.input_format = graph.points.format;
  report.heights = !graph.points.height.empty();
  report.segments = graph.segments.size();
  report.read_seconds = watch.lap();

  line.start(graph.points.size());
  const ConstrainedTriangulation mesh =
      triangulate_graph(graph.points.view(), graph.segments, name, constraints, chosen);
  check_interrupt();
  report.mesh = &mesh.mesh();
  report.constrained = &mesh;
  report.triangulate_seconds = watch.lap();
  line.clear();
  if (!options.quiet) note_other_heights(graph.points, graph.own_points, mesh.mesh(), options.segments.file);
  if (!options.quiet && constraints.domain == Domain::seeds)
    note_far_seeds(graph.points.view(), mesh, graph.holes, graph.regions, name);
  judge_dimension(mesh.mesh(), name, options);
  if (mesh.mesh().dimension() >= 2 && mesh.number_inside() == 0) {
    const std::string why = fmt::format("{}: no triangles: no region is inside by --domain {}; --domain hull keeps all",
                                        name, options.segments.domain);
    if (options.strict) throw Failure(exit_degenerate, why);
    if (!options.quiet) say(fmt::format("cadt: warning: {}, --strict makes this an error\n", why));
  }
  note_rounding(mesh, name, options.quiet);
  report.hash = mesh.hash().to_string();

  watch.lap();
  if (options.verify) {
    line.step("verifying");
    VerifyOptions verify_options;
    verify_options.threads = options.device.threads;
    report.verification = verify(graph.points.view(), graph.segments, mesh, constraints, verify_options);
    report.verify_seconds = watch.lap();
    line.clear();
    if (!report.verification->ok && !mesh.rounded_valid())
      throw Failure(exit_verify, name + ": crossings are too close to others for rounded coordinates: " +
                                     report.verification->summary() +
                                     "; no output was written. --crossing grid=G keeps them apart");
    require_verified(*report.verification);
  }

  watch.lap();
  if (!report.outputs.empty()) {
    const RegionResult result = region_result(graph, mesh, constraints.domain);
    write_regions(report.outputs, options.output, result, line);
    report.write_seconds = watch.lap();
  }
  print_reports(options, report);
  return exit_done;
}

}  // namespace cadt::cli
