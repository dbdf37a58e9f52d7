// SPDX-License-Identifier: Apache-2.0
// cadt-bench-cgal: cadt and CGAL on the same points, in one run, on one machine. A time is that of the whole call, from
// points in memory to triangles in memory.
#include "bench/measure.hpp"
#include "bench/report.hpp"

#include <cadt/io/generate.hpp>

#include <CLI/CLI.hpp>

#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

struct Arguments {
  std::size_t points = 1000000;
  std::uint64_t seed = 1;
  int repeat = 5;
  unsigned threads = 0;
  bool check = false;
  std::string device, json;
  std::vector<std::string> distributions = {"uniform"}, who = {"host", "opencl", "cgal"};
};

const std::vector<std::string> all_distributions = {"uniform", "skewed",  "clusters", "two-clusters",
                                                    "grid",    "circles", "kuzmin"};

int run(Arguments arguments) {
  using namespace cadt::bench;
  if (arguments.distributions == std::vector<std::string>{"all"}) arguments.distributions = all_distributions;
  const auto fighters = contestants(arguments.who, arguments.threads, arguments.device);
  std::vector<Measurement> all;
  bool equal = true;
  for (const std::string& distribution : arguments.distributions) {
    cadt::io::GenerateOptions options;
    options.n = arguments.points;
    options.seed = arguments.seed;
    const std::vector<double> xy = cadt::io::generate(distribution, options).xy;
    for (const Contestant& contestant : fighters) {
      std::cerr << distribution << ", " << contestant.name << " ...\n";
      all.push_back(measure(contestant, xy, arguments.repeat));
      all.back().distribution = distribution;
      if (!arguments.check) continue;
      const std::string difference = difference_from_cgal(contestant, xy);
      if (difference.empty()) continue;
      std::cerr << "WRONG: " << distribution << ", " << contestant.name << ": " << difference << '\n';
      equal = false;
    }
  }
  std::cout << table(all);
  if (arguments.check && equal) std::cout << "All meshes equal CGAL's, triangle by triangle.\n";
  if (!arguments.json.empty()) {
    std::ofstream out(arguments.json);
    out << json(all);
    if (!out.flush()) throw std::runtime_error("cannot write " + arguments.json);
  }
  return equal ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Times cadt beside CGAL on the same points: one warm-up, then the best of several whole calls.");
  app.add_option("-n", arguments.points, "points of each set")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("-d,--distribution", arguments.distributions, "names as in 'cadt generate --list', or all")
      ->delimiter(',');
  app.add_option("-w,--who", arguments.who, "host, opencl, cuda, cgal")->delimiter(',');
  app.add_option("-r,--repeat", arguments.repeat, "timed runs of each")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", arguments.seed, "seed of the points")->capture_default_str();
  app.add_option("--threads", arguments.threads, "host threads; 0: all cores")->capture_default_str();
  app.add_option("--device", arguments.device, "device of the back end, number or part of its name");
  app.add_option("--json", arguments.json, "also write the numbers to this file");
  app.add_flag("--check", arguments.check, "compare each mesh with CGAL's, once, outside the timing");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "cadt-bench-cgal: " << error.what() << '\n';
    return 1;
  }
}
