// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "failure.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "numbers.hpp"
#include "outputs.hpp"
#include "text.hpp"

#include <cadt/io/generate.hpp>
#include <cadt/triangulation.hpp>

#include <fmt/format.h>

#include <memory>
#include <string>

namespace cadt::cli {
namespace {

struct GenerateCommand {
  std::string name, n = "10000", output, format;
  io::GenerateOptions options;
  bool list = false, quiet = false;
};

std::string list_text() {
  std::vector<std::vector<std::string>> rows;
  for (const auto& entry : io::distributions())
    rows.push_back({std::string(entry.name), std::string(entry.description)});
  return table(rows);
}

int run(const GenerateCommand& command) {
  if (command.list) {
    print(list_text());
    return exit_done;
  }
  if (command.name.empty()) throw Failure(exit_usage, "name a point set (see: cadt generate --list)");
  require_point_set(command.name);
  if (command.output.empty()) throw Failure(exit_usage, "name the output with -o; -o - -t xy is standard output");
  io::GenerateOptions options = command.options;
  options.n = parse_count(command.n);
  if (options.n > max_points()) {
    throw Failure(exit_usage, fmt::format("-n {}: a triangulation takes at most {} points", command.n, max_points()));
  }
  std::vector<std::string> formats;
  if (!command.format.empty()) formats.push_back(command.format);
  const Output output = plan_outputs({command.output}, formats, io::point_write_formats(), {}).front();

  const io::PointSet points = io::generate(command.name, options);
  {
    const InPhase phase(writing_phase(output.path));
    io::write_points(output.path, points, output.format);
    if (output.path == "-") finish_stdout();
  }
  const std::string name = display_name(output.path, false);
  check_interrupt_after({name});
  if (!command.quiet) say(fmt::format("{} points ({}) written to {}\n", points.size(), command.name, name));
  return exit_done;
}

}  // namespace

void add_generate(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("generate", "make point sets for tests, benchmarks and first steps");
  const auto options = std::make_shared<GenerateCommand>();
  command->add_option("NAME", options->name, "name of the point set (see --list)");
  command->add_flag("--list", options->list, "print all names, each with what it is");
  command->add_option("-n", options->n, "number of points, 250000, 2M or 1e6 (default: 10000); some sets round it")
      ->type_name("N");
  command->add_option("--seed", options->options.seed, "equal seeds give equal points (default: 1)")
      ->type_name("S")
      ->transform(whole_number());
  command->add_option("-o,--output", options->output, "file for the points; '-' is standard output (with -t)")
      ->type_name("FILE");
  command
      ->add_option("-t,--to", options->format,
                   "format: " + join(io::point_write_formats(), " ") + "; default: from the suffix")
      ->type_name("FORMAT");
  command->add_option("--k", options->options.k, "circles: points on each circle (default: 8)")
      ->type_name("K")
      ->transform(whole_number(3, 1000000));
  command->add_option("--radius", options->options.radius, "circles: in cells of the grid of centres (default: 0.35)")
      ->type_name("R")
      ->check(number_within(0, 1e6));
  command
      ->add_option("--epsilon", options->options.epsilon,
                   "circles: largest offset of a coordinate, in cells; 0 keeps them cocircular (default: 1e-4)")
      ->type_name("E")
      ->check(number_within(0, 1e6));
  command->add_flag("-q,--quiet", options->quiet, "nothing on standard error but errors");
  command->footer(
      "Examples:\n"
      "  cadt generate uniform -n 1M --seed 7 -o points.npy\n"
      "  cadt generate circles -n 20000 --k 12 --epsilon 0 -o circles.xy\n"
      "  cadt generate terrain -n 50000 -o - -t xyz | cadt triangulate - -f xyz -o terrain.png\n");
  command->callback([options, command, &chosen] {
    for (const char* const option : {"--k", "--radius", "--epsilon"})
      if (command->count(option) != 0 && options->name != "circles")
        throw Failure(exit_usage, fmt::format("{} belongs to the set circles: leave it out", option));
    chosen = [options] { return run(*options); };
  });
}

}  // namespace cadt::cli
