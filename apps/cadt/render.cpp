// SPDX-License-Identifier: Apache-2.0
// cadt render: a picture of a mesh, without a window.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "graph.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "numbers.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "region_output.hpp"
#include "render_growth.hpp"
#include "text.hpp"
#include "viewer_options.hpp"

#include <cadt/io/region_file.hpp>
#include <cadt/triangulation.hpp>

#include "viewer/draw/image_file.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/still/still.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace cadt::cli {
namespace {

struct RenderCommand {
  SubjectOptions subject;
  StyleOptions style;
  std::string output, format, size, camera;
  DeviceOptions device;
  GrowthOptions growth;
  std::optional<int> samples;
  bool quiet = false;

  [[nodiscard]] viewer::Style pixel_style() const {
    viewer::Style all = style_of(style);
    all.samples = samples.value_or(2);
    return all;
  }
};

/// Shapes in a file of them are all alike; what only pixels have is refused there.
void check_vector_options(const RenderCommand& command, const std::string& format) {
  const std::pair<const char*, bool> given[] = {
      {"--camera", !command.camera.empty()},        {"--colour", !command.style.colour.empty()},
      {"--style", command.style.style != "filled"}, {"--dark", command.style.dark},
      {"--no-hull", command.style.no_hull},         {"--samples", command.samples.has_value()}};
  for (const auto& [name, is_given] : given) {
    if (is_given)
      throw Failure(exit_usage, fmt::format("{} is for pictures of pixels, not for .{}: write a .png, or leave it out",
                                            name, format));
  }
}

/// The mesh while it grows, with the size, camera and style of the command.
int run_growth(const RenderCommand& command) {
  if (!command.format.empty())
    throw Failure(exit_usage,
                  "-t: a picture of growth is named by its output: FILE.png, .mp4, .webm, .gif, or a folder");
  if (has_segments(command.subject))
    throw Failure(exit_usage,
                  "a mesh with segments is not shown as it grows: leave --growth, --fps and --seconds out and write a "
                  "picture, or give the points alone");
  if (command.style.no_hull)
    throw Failure(exit_usage, "--no-hull: the hull of a growing mesh is not emphasised; leave it out");
  check_growth(command.growth, command.output, {command.subject.input.path, command.subject.segments.file});
  GrowthView view;
  parse_size(command.size, view.width, view.height, view.most_height);
  view.quiet = command.quiet;
  view.style = command.pixel_style();
  view.seen = parse_camera(command.camera);
  ProgressLine line(command.quiet);
  const io::PointSet points = read_subject(command.subject, line);
  view.style.colour = colour_of(command.style, points, MeshKind::growing).value_or(viewer::ColourBy::level);
  const viewer::gl::HeadlessContext context;
  int code = exit_done;
  try {
    code = render_growth(points, library_options(command.device), command.output, command.growth, view, line);
  } catch (const InputError& e) {
    refuse_points(command.subject, e);
  }
  line.clear();
  if (viewer::gl::errors_seen() != 0)
    throw Failure(exit_internal, "OpenGL reported errors; CADT_GL_DEBUG=1 prints them. Please report them");
  return code;
}

/// The file that is written. It may be none of those that are read.
Output plan_picture(const RenderCommand& command) {
  const Output output =
      plan_outputs({command.output}, command.format.empty() ? std::vector<std::string>{} : std::vector{command.format},
                   {"png", "svg", "pdf"}, {command.subject.input.path, command.subject.segments.file})
          .front();
  if (output.format != "png") check_vector_options(command, output.format);
  return output;
}

int draw(const RenderCommand& command, const Output& output, const io::RegionMesh& mesh,
         const viewer::StillOptions& still, ProgressLine& line) {
  check_interrupt();
  if (still.view) {
    const viewer::Extent box = viewer::box_of(mesh.xy);
    viewer::Camera camera(
        box, still.width,
        still.height != 0 ? still.height : viewer::Camera::height_for(box, still.width, still.most_height));
    aim_camera(camera, *still.view);
  }
  line.step("drawing");
  const auto start = std::chrono::steady_clock::now();
  {
    const InPhase phase(writing_phase(output.path));
    if (output.format == "png") {
      viewer::write_png(output.path, viewer::draw_still(mesh, still));
    } else {
      io::WriteOptions write;
      write.format = output.format;
      write.width = still.width;
      write.height = still.height;
      write.max_height = still.most_height;
      io::write_region_mesh(output.path, mesh, write);
    }
    if (output.path == "-") finish_stdout();
  }
  line.clear();
  check_interrupt_after({display_name(output.path, false)});
  if (!command.quiet) {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    say(fmt::format("{} triangles of {} points drawn in {:.2f} s: {}\n", mesh.triangles.size() / 3, mesh.xy.size() / 2,
                    seconds.count(), display_name(output.path, false)));
  }
  return exit_done;
}

int run(const RenderCommand& command) {
  if (shows_growth(command.growth, command.output) || command.growth.timed) return run_growth(command);
  const bool segments = has_segments(command.subject);
  const Output output = plan_picture(command);
  viewer::StillOptions still;
  parse_size(command.size, still.width, still.height, still.most_height);
  still.view = parse_camera(command.camera);
  still.style = command.pixel_style();
  Options options = library_options(command.device);
  options.order = segments ? Order::canonical : Order::fast;  // regions are numbered in the order of triangles
  options.statistics = StatisticsDetail::none;
  options.stop = interrupt_token();

  ProgressLine line(command.quiet);
  options.progress = [&line](const Progress& progress) { line.update(progress); };
  if (segments) {
    const std::string name = name_of(command.subject);
    line.step(fmt::format("reading {}", name));
    const Graph graph = read_graph(command.subject.input, command.subject.segments, command.quiet);
    if (!command.quiet) note_holes(graph, command.subject.segments);
    still.colour = colour_of(command.style, graph.points, MeshKind::segments);
    const ConstraintOptions constraints = constraint_options(command.subject.segments, graph);
    line.start(graph.points.size());
    const ConstrainedTriangulation mesh =
        triangulate_graph(graph.points.view(), graph.segments, name, constraints, options);
    note_rounding(mesh, name, command.quiet);
    return draw(command, output, region_result(graph, mesh, constraints.domain).view(), still, line);
  }
  const io::PointSet points = read_subject(command.subject, line);
  still.colour = colour_of(command.style, points, MeshKind::points);
  line.start(points.size());
  const Triangulation mesh = triangulate_subject(command.subject, points, options);
  return draw(command, output, {points.xy, points.height, mesh.triangles(), {}, {}, {}, mesh.hull()}, still, line);
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("render", "a picture of a mesh, drawn by OpenGL without a window");
  const auto options = std::make_shared<RenderCommand>();
  add_subject_options(*command, options->subject);
  command
      ->add_option(
          "-o,--output", options->output,
          "file for the picture: .png, .svg, .pdf; '-' is standard output (with -t). Of the growing mesh: .mp4, "
          ".webm, .gif, or a folder for the frames")
      ->type_name("FILE")
      ->required();
  command->add_option("-t,--to", options->format, "format: png svg pdf; default: from the suffix")->type_name("FORMAT");
  command
      ->add_option("--size", options->size,
                   "pixels, 16 to 16384: the width, the height follows from the points; or width and height, 3840x2160 "
                   "(default: 1600, and a height of 4000 at most)")
      ->type_name("W[xH]");
  add_style_options(*command, options->style);
  command
      ->add_option(
          "--camera", options->camera,
          "what is in the middle, and how many times larger than the whole mesh it is drawn: 500100.5,4100200,20")
      ->type_name("X,Y,M");
  command
      ->add_option("--samples", options->samples,
                   "samples along the side of a pixel, 1 to 4 (default: 2): 4 is smoother")
      ->type_name("S")
      ->transform(whole_number(1, 4));
  add_growth_options(*command, options->growth);
  add_device_options(*command, options->device);
  command->add_flag("-q,--quiet", options->quiet, "nothing on standard error but errors");
  command->footer(
      "A GPU draws if OpenGL finds one without a window (EGL), else the CPU. Triangles smaller than a pixel are "
      "averaged,\n"
      "so a hundred million points look right from afar, too. SVG and PDF take small meshes.\n\n"
      "Examples:\n"
      "  cadt render terrain.xyz -o terrain.png --size 3840x2160\n"
      "  cadt render points.xy -o angles.png --colour angle --camera 0.5,0.5,40\n"
      "  cadt render --generate clusters -n 1M -o clusters.png --dark\n"
      "  cadt render land.geojson --domain even_odd -o land.png\n"
      "      what the polygons enclose, with their outlines\n"
      "  cadt render points.xy --growth 4 -o growth.png\n"
      "      four snapshots of the mesh as it grows\n"
      "  cadt render points.xy -o growth.mp4 --seconds 12\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
