// SPDX-License-Identifier: Apache-2.0
// cadt view: meshes in a window.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "generated_set.hpp"
#include "graph.hpp"
#include "input.hpp"
#include "numbers.hpp"
#include "system.hpp"
#include "text.hpp"
#include "viewer_options.hpp"

#include <cadt/io/errors.hpp>

#include "viewer/window/app.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace cadt::cli {
namespace {

struct ViewCommand {
  std::vector<std::string> files;
  InputOptions input;
  SegmentOptions segments;
  std::string generate, n = "100000", colour, style = "filled", interop = "auto", size = "1280x800";
  std::uint64_t seed = 1;
  DeviceOptions device;
  double scale = 0;
  bool dark = false, log = false, lose_context = false;
};

viewer::Source generated(const ViewCommand& command) {
  require_point_set(command.generate);
  viewer::Source source;
  source.distribution = command.generate;
  source.generate.n = parse_count(command.n);
  source.generate.seed = command.seed;
  return source;
}

viewer::Constrained read_and_constrain(const InputOptions& input, const SegmentOptions& segments,
                                       const Options& options) {
  const Graph graph = read_graph(input, segments, true);
  try {
    ConstrainedTriangulation mesh =
        triangulate_constrained(graph.points.view(), graph.segments, constraint_options(segments, graph), options);
    io::PointSet points = points_of(graph, mesh);
    return {std::move(points), std::move(mesh)};
  } catch (const Error&) {
    throw io::FileError(input.path, 0, explain_graph_error(graph.points.view(), graph.segments));
  }
}

viewer::Source source_of(const ViewCommand& command, const std::string& file) {
  InputOptions input = command.input;
  input.path = file;
  viewer::Source source;
  source.path = file;
  source.read = read_options(input);
  if (has_segments(input, command.segments)) {
    source.constrain = [input, segments = command.segments](const Options& options) {
      return read_and_constrain(input, segments, options);
    };
  }
  return source;
}

int run(const ViewCommand& command) {
  viewer::ViewOptions options;
  for (const std::string& file : command.files) options.sources.push_back(source_of(command, file));
  if (!command.generate.empty()) {
    if (const SegmentOptions& s = command.segments; !(s.file + s.domain + s.crossing).empty())
      throw Failure(exit_usage,
                    "--segments, --domain and --crossing are for files, not for --generate: leave them out");
    options.sources.push_back(generated(command));
  }
  if (options.sources.empty())
    throw Failure(exit_usage, "name a file with points, or a point set: cadt view --generate uniform -n 1M");
  options.compute = library_options(command.device);
  for (const viewer::Interop interop :
       {viewer::Interop::automatic, viewer::Interop::cuda, viewer::Interop::opencl, viewer::Interop::copy})
    if (to_string(interop) == command.interop) options.interop = interop;
  options.colour = viewer::colour_from_string(command.colour);
  options.drawing = *viewer::drawing_from_string(command.style);
  int most_height = 0;
  parse_size(command.size, options.width, options.height, most_height);
  if (options.width < 320 || options.height < 240)
    throw Failure(exit_usage,
                  fmt::format("--size {}: a window has at least 320x240 pixels, for example 1280x800", command.size));
  options.scale = command.scale;
  options.dark = command.dark;
  options.log = command.log;
  options.lose_context = command.lose_context;
  options.free_memory = [] { return static_cast<std::size_t>(free_memory().value_or(0)); };
  viewer::App(std::move(options)).run();
  return exit_done;
}

}  // namespace

void add_view(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("view", "look at meshes in a window; ? shows its keys");
  const auto options = std::make_shared<ViewCommand>();
  command->add_option("FILE", options->files,
                      "files with points, or with points and segments; PgUp and PgDn go from one to the next");
  add_read_options(*command, options->input, true);
  add_segment_options(*command, options->segments);
  add_generated_set(*command, options->generate, options->n, options->seed);
  command
      ->add_option(
          "--colour,--color", options->colour,
          "what decides the colour: nothing, angle, area, order, height, degree or region (default: region where "
          "segments separate some, else height where there are heights, else area)")
      ->type_name("BY")
      ->check(CLI::IsMember({"nothing", "angle", "area", "order", "height", "degree", "region"}).description(""));
  command->add_option("--style", options->style, "filled, wireframe or points (default: filled)")
      ->type_name("STYLE")
      ->check(CLI::IsMember({"filled", "wireframe", "points"}).description(""));
  command
      ->add_option(
          "--interop", options->interop,
          "how the mesh gets to the display: cuda or opencl, which write it there, or copy through the host's memory "
          "(default: auto, the first that is possible)")
      ->type_name("HOW")
      ->check(CLI::IsMember({"auto", "cuda", "opencl", "copy"}).description(""));
  command->add_option("--size", options->size, "of the window, in pixels (default: 1280x800)")->type_name("WxH");
  command->add_option("--scale", options->scale, "size of text and lines (default: the system's)")
      ->type_name("FACTOR")
      ->check(number_within(0.5, 8));
  command->add_flag("--dark", options->dark, "light on dark");
  add_device_options(*command, options->device);
  add_memory_option(*command, options->device);
  command->add_flag("--log", options->log, "what happens, on standard output")->group("");
  command->add_flag("--lose-context", options->lose_context, "as if the driver was reset, once")->group("");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
