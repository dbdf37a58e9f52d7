// SPDX-License-Identifier: Apache-2.0
// cadt render: a picture of a mesh, without a window.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "render_growth.hpp"
#include "text.hpp"

#include <cadt/io/generate.hpp>
#include <cadt/triangulation.hpp>

#include "viewer/draw/image_file.hpp"
#include "viewer/draw/renderer.hpp"
#include "viewer/gl/context.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace cadt::cli {
namespace {

using namespace viewer;

struct RenderCommand {
  InputOptions input;
  std::string output, size = "1600", colour, style = "filled", n = "10000", generate, camera;
  DeviceOptions device;
  int samples = 2;
  bool dark = false, quiet = false;
  GrowthOptions growth;
};

/// With the size, camera and style of the command.
int run_growth(const RenderCommand& command, const io::PointSet& points, ProgressLine& line) {
  GrowthView view;
  std::sscanf(command.size.c_str(), "%dx%d", &view.width, &view.height);
  view.quiet = command.quiet;
  view.style.dark = command.dark;
  view.style.samples = command.samples;
  view.style.fill = command.style != "wireframe";
  view.style.points_alone = command.style == "points";
  view.style.colour = ColourBy::level;
  for (std::size_t i = 0; i < names_of_colours().size(); ++i)
    if (names_of_colours()[i] == command.colour) view.style.colour = static_cast<ColourBy>(i);
  if (!command.camera.empty())
    view.aim = [&](Camera& camera) {
      double x = 0, y = 0, zoom = 1;
      std::sscanf(command.camera.c_str(), "%lf,%lf,%lf", &x, &y, &zoom);
      camera.look_at(x, y);
      camera.zoom(zoom, 0.5 * camera.width(), 0.5 * camera.height());
    };
  const gl::HeadlessContext context;
  const int code = render_growth(points, library_options(command.device), command.output, command.growth, view, line);
  line.clear();
  if (gl::errors_seen() != 0) throw Failure(exit_internal, "OpenGL reported errors");
  return code;
}

int run(const RenderCommand& command) {
  const bool grows = shows_growth(command.growth, command.output);
  if (grows || command.growth.timed) check_growth(command.growth, command.output);
  ProgressLine line(command.quiet);
  io::PointSet points;
  if (!command.generate.empty()) {
    io::GenerateOptions options;
    options.n = parse_count(command.n);
    points = io::generate(command.generate, options);
  } else {
    points = read_input(command.input);
  }
  if (grows) return run_growth(command, points, line);
  Options options = library_options(command.device);
  options.order = Order::fast;
  const Triangulation mesh = triangulate(points.view(), options);
  line.step("drawing");
  const gl::HeadlessContext context;
  Renderer renderer;
  MeshBuffers buffers = MeshBuffers::copy(points.xy, mesh.triangles());
  int width = 1600, height = 0;
  if (const auto x = command.size.find('x'); x != std::string::npos) {
    width = std::stoi(command.size.substr(0, x));
    height = std::stoi(command.size.substr(x + 1));
  } else {
    width = std::stoi(command.size);
    height = Camera::height_for(buffers.box, width, 4000);
  }
  Camera camera(buffers.box, width, height);
  if (!command.camera.empty()) {
    double x = 0, y = 0, zoom = 1;
    std::sscanf(command.camera.c_str(), "%lf,%lf,%lf", &x, &y, &zoom);
    camera.look_at(x, y);
    camera.zoom(zoom, 0.5 * width, 0.5 * height);
  }
  Style style;
  style.dark = command.dark;
  style.samples = command.samples;
  style.fill = command.style != "wireframe";
  style.points_alone = command.style == "points";
  style.colour = points.height.empty() ? ColourBy::area : ColourBy::height;
  for (std::size_t i = 0; i < names_of_colours().size(); ++i)
    if (names_of_colours()[i] == command.colour) style.colour = static_cast<ColourBy>(i);
  if (style.colour == ColourBy::height) {
    const std::vector<float> heights(points.height.begin(), points.height.end());
    renderer.set_values(heights);
  }
  renderer.update(buffers);
  renderer.fit_ramp(buffers, style.colour);
  Stroke hull{{}, 0xb3472f, 1.5f};
  const auto loop = mesh.hull();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto a = static_cast<std::size_t>(loop[i]), b = static_cast<std::size_t>(loop[(i + 1) % loop.size()]);
    hull.segments.push_back({points.xy[2 * a], points.xy[2 * a + 1], points.xy[2 * b], points.xy[2 * b + 1]});
  }
  renderer.draw(buffers, camera, style, std::span<const Stroke>(&hull, 1));
  write_png(command.output, renderer.read());
  line.clear();
  if (gl::errors_seen() != 0) throw Failure(exit_internal, "OpenGL reported errors");
  return exit_done;
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("render", "a picture of a mesh, drawn by OpenGL without a window");
  const auto options = std::make_shared<RenderCommand>();
  add_input_options(*command, options->input, "IN", "file with points");
  command->get_option("IN")->required(false);
  command->add_option("--generate", options->generate, "a point set of cadt generate in place of a file")->type_name("NAME");
  command->add_option("-n", options->n, "number of points of --generate (default: 10000)")->type_name("N");
  command->add_option("-o,--output", options->output, "file for the picture: .png; the growing mesh: .mp4, .webm, .gif, or a folder for frames")->type_name("FILE")->required();
  command->add_option("--size", options->size, "width, or widthxheight, in pixels (default: 1600)")->type_name("WxH");
  command->add_option("--colour,--color", options->colour, "what decides the colour: " + join(names_of_colours(), " "))->type_name("BY");
  command->add_option("--style", options->style, "filled, wireframe or points")->type_name("STYLE");
  command->add_option("--camera", options->camera, "x,y,magnification")->type_name("X,Y,M");
  command->add_option("--samples", options->samples, "along the side of a pixel (default: 2)")->type_name("S");
  command->add_flag("--dark", options->dark, "light on dark");
  add_growth_options(*command, options->growth);
  add_device_options(*command, options->device);
  command->add_flag("-q,--quiet", options->quiet, "nothing on standard error but errors");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
