// SPDX-License-Identifier: Apache-2.0
// cadt-bench compare
#include "apps/cadt/failure.hpp"
#include "apps/cadt/text.hpp"
#include "bench/commands.hpp"
#include "bench/compare.hpp"
#include "bench/output.hpp"

#include <cadt/io/generate.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace cadt::bench {
namespace {

struct Arguments {
  std::string points = "1M", device, json;
  std::uint64_t seed = 1;
  int repeat = 5;
  unsigned threads = 0;
  bool check = false;
  std::vector<std::string> distributions = {"uniform"}, who = {"host", "opencl", "cgal"};
};

const std::vector<std::string> all_distributions = {"uniform", "skewed",  "clusters", "two-clusters",
                                                    "grid",    "circles", "kuzmin"};

void check_distributions(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto& known = io::distributions();
    if (std::ranges::find(known, name, &io::Distribution::name) == known.end())
      throw cli::Failure(cli::exit_usage, "there is no point set '" + name + "' (see: cadt generate --list)");
  }
}

int run(Arguments arguments) {
  if (arguments.distributions == std::vector<std::string>{"all"}) arguments.distributions = all_distributions;
  check_distributions(arguments.distributions);
  if (arguments.check && !has_cgal())
    throw cli::Failure(cli::exit_usage, "--check: CGAL was not there when this was built (package libcgal-dev)");
  io::GenerateOptions options;
  options.n = cli::parse_count(arguments.points);
  options.seed = arguments.seed;
  const auto fighters = find_fighters(arguments.who, arguments.threads, arguments.device);
  std::vector<Comparison> all;
  bool equal = true;
  for (const std::string& distribution : arguments.distributions) {
    const std::vector<double> xy = io::generate(distribution, options).xy;
    for (const Fighter& fighter : fighters) {
      cli::say(distribution + ", " + fighter.name + " ...\n");
      all.push_back(compare(fighter, xy, arguments.repeat));
      all.back().distribution = distribution;
      if (!arguments.check) continue;
      const std::string difference = difference_from_cgal(fighter, xy);
      if (difference.empty()) continue;
      cli::say("WRONG: " + distribution + ", " + fighter.name + ": " + difference + '\n');
      equal = false;
    }
  }
  cli::print(comparison_table(all));
  if (arguments.check && equal) cli::print("All meshes equal CGAL's, triangle by triangle.\n");
  if (!arguments.json.empty()) write_file(std::filesystem::absolute(arguments.json), comparison_json(all));
  return equal ? cli::exit_done : cli::exit_verify;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("compare", "time cadt beside CGAL on the same points, and compare the meshes");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-n", arguments->points, "points of each set, 250000, 2M or 1e6 (default: 1M)")->type_name("N");
  command
      ->add_option("-d,--distribution", arguments->distributions,
                   "names as in 'cadt generate --list', with commas between, or all (default: uniform)")
      ->type_name("NAMES")
      ->delimiter(',');
  command->add_option("-w,--who", arguments->who, "of host, opencl, cuda, cgal (default: host,opencl,cgal)")
      ->type_name("NAMES")
      ->delimiter(',')
      ->check(CLI::IsMember({"host", "opencl", "cuda", "cgal"}).description(""));
  command->add_option("-r,--repeat", arguments->repeat, "timed runs of each, after a warm-up (default: 5)")
      ->type_name("R")
      ->check(CLI::PositiveNumber.description(""));
  command->add_option("--seed", arguments->seed, "seed of the points (default: 1)")->type_name("S");
  command->add_option("--threads", arguments->threads, "host threads; 0: all cores (default: 0)")->type_name("T");
  command->add_option("--device", arguments->device, "of OpenCL and CUDA this device: its number or a part of its name")
      ->type_name("DEVICE");
  command->add_option("--json", arguments->json, "also write the numbers to this file")->type_name("FILE");
  command->add_flag("--check", arguments->check,
                    "compare each mesh with CGAL's, triangle by triangle, after the timing");
  command->footer(
      "Example:\n"
      "  cadt-bench compare -d uniform,grid -n 1M -w host,opencl,cgal --check\n\n"
      "Exit codes: 0 done, 7 a mesh differs from CGAL's.\n");
  command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace cadt::bench
