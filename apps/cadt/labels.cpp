// SPDX-License-Identifier: Apache-2.0
// cadt labels: an image of labels as a mesh, each triangle with its label.
#include "commands.hpp"
#include "device_options.hpp"
#include "failure.hpp"
#include "graph.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "region_output.hpp"

#include <cadt/io/label_image_file.hpp>
#include <cadt/label_image.hpp>

#include <fmt/format.h>

#include <memory>
#include <set>

namespace cadt::cli {
namespace {

struct LabelsCommand {
  std::string image;
  OutputOptions output;
  DeviceOptions device;
  bool quiet = false;
};

int run(const LabelsCommand& command) {
  const auto outputs =
      plan_outputs(command.output.outputs, command.output.formats, io::region_write_formats(), {command.image});
  ProgressLine line(command.quiet);
  const std::string name = display_name(command.image, true);
  line.step(fmt::format("reading {}", name));
  const io::LabelImage image = io::read_label_image(command.image);
  const LabelSegments boundary = label_segments(image.labels, image.width, image.height);

  Options options = library_options(command.device);
  options.statistics = StatisticsDetail::none;
  options.stop = interrupt_token();
  options.progress = [&line](const Progress& progress) { line.update(progress); };
  line.start(boundary.xy.size() / 2);
  const ConstrainedTriangulation mesh =
      triangulate_graph(PointsView(std::span<const double>(boundary.xy)), boundary.segments, name, {}, options);
  RegionResult result;
  append_inside(result, mesh);
  result.points.xy = boundary.xy;
  result.region = triangle_labels(boundary.xy, result.triangles, image.labels, image.width, image.height);
  result.region_name = "label";
  write_regions(outputs, command.output, result, line);

  const std::set<std::int32_t> labels(image.labels.begin(), image.labels.end());
  const std::string summary = fmt::format(
      "pixels      {} x {}\nlabels      {}\nregions     {}\npoints      {}\nsegments    {}\ntriangles   {}\n",
      image.width, image.height, labels.size(), mesh.number_of_regions(), boundary.xy.size() / 2,
      boundary.segments.size(), mesh.mesh().number_of_triangles());
  print_summary(summary, outputs.empty(), command.quiet);
  return exit_done;
}

}  // namespace

void add_labels(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("labels", "mesh an image of labels: microstructures, cells, land cover");
  const auto options = std::make_shared<LabelsCommand>();
  command->add_option("IMAGE", options->image, "PNG file with labels; '-' is standard input")->required();
  add_region_output_options(*command, options->output);
  add_device_options(*command, options->device);
  command->add_flag("-q,--quiet", options->quiet, "nothing on standard error but errors");
  command->footer(
      "The label of a pixel is its grey value, its index in the palette, or its colour as 0xRRGGBB. The boundaries "
      "between\n"
      "labels become edges, and each triangle gets the label of the pixels that it lies in: as attribute 'label' in "
      ".ply,\n"
      ".vtu and .geojson, as column in .ele. Coordinates are in pixels, with y up from the lower left corner.\n\n"
      "Example:\n"
      "  cadt labels grains.png -o grains.vtu -o mesh.svg\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
