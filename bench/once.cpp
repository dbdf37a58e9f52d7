// SPDX-License-Identifier: Apache-2.0
// cadt-bench once: for profilers.
#include "apps/cadt/failure.hpp"
#include "apps/cadt/text.hpp"
#include "bench/commands.hpp"

#include <cadt/cadt.hpp>
#include <cadt/io/generate.hpp>

#include <memory>

namespace cadt::bench {
namespace {

struct Arguments {
  std::string points = "1M", distribution = "uniform", backend = "auto", device, strategy = "auto";
};

int run(const Arguments& arguments) {
  io::GenerateOptions generate;
  generate.n = cli::parse_count(arguments.points);
  Options options;
  options.backend = backend_from_string(arguments.backend);
  options.device = arguments.device;
  options.order = Order::fast;
  for (const Strategy strategy : {Strategy::automatic, Strategy::locks, Strategy::stars})
    if (arguments.strategy == to_string(strategy)) options.tuning.strategy = strategy;
  const std::vector<double> xy = io::generate(arguments.distribution, generate).xy;
  cli::print(triangulate(PointsView(xy), options).hash().to_string() + '\n');
  return cli::exit_done;
}

}  // namespace

void add_once(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("once", "triangulate once, for profilers: prints the hash of the mesh");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-n", arguments->points, "points, 250000, 2M or 1e6 (default: 1M)")->type_name("N");
  command
      ->add_option("-d,--distribution", arguments->distribution, "a name of 'cadt generate --list' (default: uniform)")
      ->type_name("NAME");
  command->add_option("--backend", arguments->backend, "auto, host, opencl or cuda (default: auto)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "host", "opencl", "cuda"}).description(""));
  command->add_option("--device", arguments->device, "its number or a part of its name")->type_name("DEVICE");
  command->add_option("--strategy", arguments->strategy, "auto, locks or stars (default: auto)")
      ->type_name("HOW")
      ->check(CLI::IsMember({"auto", "locks", "stars"}).description(""));
  command->footer(
      "Example:\n"
      "  ncu --kernel-name cadt_prove_stars --set full cadt-bench once -n 10M --backend cuda\n");
  command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace cadt::bench
