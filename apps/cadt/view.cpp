// SPDX-License-Identifier: Apache-2.0
// cadt view: meshes in a window.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "input.hpp"
#include "system.hpp"
#include "text.hpp"

#include <cadt/io/generate.hpp>

#include "viewer/window/app.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>

namespace cadt::cli {
namespace {

struct ViewCommand {
  std::vector<std::string> files;
  InputOptions input;
  std::string generate, n = "100000", colour, style = "filled", interop = "auto", size = "1280x800";
  std::uint64_t seed = 1;
  DeviceOptions device;
  double scale = 0;
  bool dark = false, log = false, lose_context = false;
};

std::array<int, 2> parse_size(const std::string& text) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 320 || height < 240 ||
      width > 16384 || height > 16384)
    throw Failure(exit_usage, fmt::format("--size {}: write width x height in pixels, for example 1280x800", text));
  return {width, height};
}

viewer::Source generated(const ViewCommand& command) {
  const auto& all = io::distributions();
  if (std::none_of(all.begin(), all.end(), [&](const auto& d) { return d.name == command.generate; }))
    throw Failure(exit_usage, fmt::format("there is no point set '{}' (see: cadt generate --list)", command.generate));
  viewer::Source source;
  source.distribution = command.generate;
  source.generate.n = parse_count(command.n);
  source.generate.seed = command.seed;
  return source;
}

int run(const ViewCommand& command) {
  viewer::ViewOptions options;
  for (const std::string& file : command.files) {
    if (file == "-" && command.input.format.empty())
      throw Failure(exit_usage, "standard input has no suffix; name its format, for example: -f xy");
    viewer::Source source;
    source.path = file;
    source.read.format = lower(command.input.format);
    source.read.columns = command.input.columns;
    source.read.projection = command.input.projection == "yz"   ? io::Projection::yz
                             : command.input.projection == "zx" ? io::Projection::zx
                                                                : io::Projection::xy;
    options.sources.push_back(std::move(source));
  }
  if (!command.generate.empty()) options.sources.push_back(generated(command));
  if (options.sources.empty())
    throw Failure(exit_usage, "name a file with points, or a point set: cadt view --generate uniform -n 1M");
  options.compute = library_options(command.device);
  for (const viewer::Interop interop :
       {viewer::Interop::automatic, viewer::Interop::cuda, viewer::Interop::opencl, viewer::Interop::copy})
    if (to_string(interop) == command.interop) options.interop = interop;
  if (!command.colour.empty()) {
    const auto& names = viewer::names_of_colours();
    options.colour =
        static_cast<viewer::ColourBy>(std::find(names.begin(), names.end(), command.colour) - names.begin());
  }
  options.drawing = *viewer::drawing_from_string(command.style);
  const auto [width, height] = parse_size(command.size);
  options.width = width;
  options.height = height;
  options.scale = command.scale;
  options.dark = command.dark;
  options.log = command.log;
  options.lose_context = command.lose_context;
  options.free_memory = [] { return static_cast<std::size_t>(free_memory().value_or(0)); };
  try {
    viewer::App(std::move(options)).run();
  } catch (const viewer::DisplayError& e) {
    throw Failure(exit_device, e.what());
  }
  return exit_done;
}

}  // namespace

void add_view(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("view", "look at meshes in a window; ? shows its keys");
  const auto options = std::make_shared<ViewCommand>();
  command->add_option("FILE", options->files, "files with points; PgUp and PgDn go from one to the next");
  add_read_options(*command, options->input);
  command->add_option("--generate", options->generate, "a point set in place of a file (see: cadt generate --list)")
      ->type_name("NAME");
  command->add_option("-n", options->n, "number of its points, 250000, 2M or 1e6 (default: 100000)")->type_name("N");
  command->add_option("--seed", options->seed, "equal seeds give equal points (default: 1)")->type_name("S");
  command
      ->add_option(
          "--colour,--color", options->colour,
          "what decides the colour: nothing, angle, area, order, height or degree (default: height where there are "
          "heights, else area)")
      ->type_name("BY")
      ->check(CLI::IsMember({"nothing", "angle", "area", "order", "height", "degree"}).description(""));
  command->add_option("--style", options->style, "filled, wireframe or points (default: filled)")
      ->type_name("STYLE")
      ->check(CLI::IsMember({"filled", "wireframe", "points"}).description(""));
  command
      ->add_option(
          "--interop", options->interop,
          "how the mesh gets to the display: cuda or opencl, which write it there, or copy through the host's memory "
          "(default: auto, the first that is possible)")
      ->type_name("WAY")
      ->check(CLI::IsMember({"auto", "cuda", "opencl", "copy"}).description(""));
  command->add_option("--size", options->size, "of the window, in pixels (default: 1280x800)")->type_name("WxH");
  command->add_option("--scale", options->scale, "size of text and lines (default: the system's)")
      ->type_name("FACTOR")
      ->check(CLI::Range(0.5, 8.0).description(""));
  command->add_flag("--dark", options->dark, "light on dark");
  add_device_options(*command, options->device);
  add_memory_option(*command, options->device);
  command->add_flag("--log", options->log, "what happens, on standard output")->group("");
  command->add_flag("--lose-context", options->lose_context, "as if the driver was reset, once")->group("");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
