// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "failure.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "mesh_directory.hpp"
#include "numbers.hpp"
#include "text.hpp"

#include <cadt/io/mesh_file.hpp>
#include <cadt/verify.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

namespace cadt::cli {
namespace {

struct VerifyCommand {
  InputOptions input;
  std::string mesh, format, backend, device;
  int base = -1;
  unsigned threads = 0;
  bool canonical = false, quiet = false;
  [[nodiscard]] bool on_device() const { return !backend.empty() || !device.empty(); }
};

VerifyReport verify_chosen(const VerifyCommand& command, const io::PointSet& points, const MeshView& mesh,
                           const VerifyOptions& options) {
  if (!command.on_device()) return verify(points.view(), mesh, options);
  Options device;
  device.backend = command.backend.empty() ? Backend::automatic : backend_from_string(command.backend);
  device.device = command.device;
  device.threads = command.threads;
  device.stop = interrupt_token();
  const InPhase phase(Phase::cooperative);
  return verify_on_device(points.view(), mesh, device, options);
}

void check_standard_input(const VerifyCommand& command) {
  if (command.mesh != "-") return;
  if (command.input.path == "-") throw Failure(exit_usage, "only one of POINTS and MESH can be standard input");
  if (command.format.empty()) {
    throw Failure(exit_usage, "standard input has no suffix; name the format of the mesh, for example: -t off");
  }
}

const char* advice(const VerifyReport& report) {
  const auto of_segments = [](const Check& check) {
    constexpr std::array names = {"delaunay", "boundary", "euler", "hull"};
    return check.passed || std::ranges::find(names, check.name) != names.end();
  };
  return std::ranges::all_of(report.checks, of_segments)
             ? "a mesh with segments, or of a domain, is not that of its points alone: check it with `cadt triangulate "
               "IN --verify`"
             : "if many checks fail, see whether both files belong together, and --base, --columns and --project";
}

int run(const VerifyCommand& command) {
  if (is_mesh_directory(command.input.path)) {
    if (!command.mesh.empty() || command.on_device())
      throw Failure(exit_usage,
                    "a mesh in tiles has its points with it, and is checked on the host: give its directory alone");
    return verify_directory(command.input.path, command.threads, command.quiet);
  }
  if (command.mesh.empty()) throw Failure(exit_usage, "MESH is required: the file with the triangles of POINTS");
  check_standard_input(command);
  const io::ReadOptions read = read_options(command.input);  // what is wrong with POINTS comes first
  require_format(command.mesh, command.format, io::mesh_read_formats(), "-t");
  io::PointSet points = io::read_points(command.input.path, read);  // more than can be triangulated can be verified
  round_to_floats(points, command.input, command.quiet);
  const io::MeshFile mesh = io::read_mesh(command.mesh, points.size(), lower(command.format), command.base);
  MeshView view;
  view.triangles = mesh.triangles;
  view.neighbors = mesh.neighbors;
  VerifyOptions options;
  options.threads = command.threads;
  options.canonical_ties = command.canonical;
  const VerifyReport report = verify_chosen(command, points, view, options);

  if (!command.quiet) {
    std::string text;
    for (const Check& check : report.checks) text += check_line(check);
    text += fmt::format("{} points, {} triangles, {} edges examined, {} on the hull, {} cocircular", report.points,
                        report.triangles_examined, report.edges_examined, report.hull_vertices, report.ties);
    if (report.ties > 0) text += fmt::format(" ({} not decided as cadt does)", report.unusual_ties);
    if (command.on_device()) {
      text +=
          fmt::format("\nsigns: {} by the filter, {} by exact sums on the device, {} by exact predicates of the host",
                      report.signs_filtered, report.signs_exact, report.signs_on_host);
    }
    print(text + '\n');
  }
  if (report.ok) return exit_done;
  throw Failure(exit_verify, fmt::format("{}: not the Delaunay triangulation of {}: {}; {}", command.mesh,
                                         display_name(command.input.path, true), report.summary(), advice(report)));
}

}  // namespace

void add_verify(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("verify", "check a mesh from any program against its points, exactly");
  const auto options = std::make_shared<VerifyCommand>();
  add_input_options(*command, options->input, "POINTS", "file with the points; or the directory of cadt tiles, alone");
  add_floats_option(*command, options->input);
  command->add_option("MESH", options->mesh,
                      "file with the triangles, counterclockwise, as indices of the points; '-' is "
                      "standard input (with -t)");
  command
      ->add_option("-t,--to", options->format,
                   "format of the mesh: " + join(io::mesh_read_formats(), " ") + "; default: from the suffix")
      ->type_name("FORMAT")
      ->check(CLI::IsMember(io::mesh_read_formats(), CLI::ignore_case).description(""));
  command->add_option("--base", options->base, "first index of an .ele file: 0 or 1 (default: recognised)")
      ->type_name("0|1")
      ->check(CLI::IsMember({0, 1}).description(""));
  command->add_flag("--canonical", options->canonical,
                    "cocircular points must be decided as cadt and CGAL decide them");
  command->add_option("--threads", options->threads, "threads; 0 takes all cores (default: 0)")
      ->type_name("N")
      ->transform(whole_number(0, 4096));
  command
      ->add_option(
          "--backend", options->backend,
          "check on a device: auto, host, opencl or cuda (default: the verifier of the host, which runs none of "
          "the kernels)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "host", "opencl", "cuda"}).description(""));
  command
      ->add_option("--device", options->device,
                   "check on this device of the back end, its number or a part of its name (see: cadt devices)")
      ->type_name("DEVICE");
  command->add_flag("-q,--quiet", options->quiet, "no lines on standard output, only the exit code");
  command->footer(
      "Prints one line for each check: counts, index range, neighbours, orientation, vertices, boundary, Euler's "
      "formula,\n"
      "hull, empty circles (exact), ties. Exit code 7 if one of them fails.\n\n"
      "The verifier of the host and that of a device share no predicate with what triangulates points, and segments "
      "that do\n"
      "not cross, nor with one another, but for the few signs that a device cannot find, which it leaves to the host.\n"
      "Only the first is free of the device's compiler and driver: to check what a device has made by other means, use "
      "the\n"
      "host or another device.\n\n"
      "A mesh with segments is not Delaunay at them: check it with `cadt triangulate IN --verify`.\n\n"
      "A mesh in tiles is checked node by node: also that its files are what was written, that edges between nodes "
      "are\n"
      "legal, and that each input point is there once.\n\n"
      "Examples:\n"
      "  cadt verify mesh.cadt\n"
      "  triangle -en points.node && cadt verify points.1.node points.1.ele\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
