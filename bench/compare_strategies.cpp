// SPDX-License-Identifier: Apache-2.0
// The cost of Strategy::automatic relative to the better of the two others, on point sets of cadt generate: all three
// take turns in one process, on the same points on the device. One line a set; the ratio should be at most 1.10.
#include <cadt/cadt.hpp>
#include <cadt/io/generate.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "tests/system/resident/device_memory.hpp"

namespace {

using namespace cadt;

constexpr std::array strategies = {Strategy::automatic, Strategy::locks, Strategy::stars};
constexpr double promised = 1.10;
constexpr std::size_t most_kernels = 6;        // of a line
constexpr const char* cocircular = "12-gons";  // circles with k = 12, without an offset

struct Arguments {
  std::vector<std::size_t> points = {8192, 100'000, 1'000'000};
  std::vector<std::string> sets;
  std::string backend = "cuda";
  int device = 0, rounds = 15, warm_up = 2;
  bool phases = false, canonical = false;
};

double now() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

Options options_of(const Arguments& a, test::DeviceMemory& memory, Strategy strategy) {
  Options options;
  options.backend = backend_from_string(a.backend);
  if (options.backend != Backend::host) options.queue = memory.queue();
  options.order = a.canonical ? Order::canonical : Order::fast;
  options.tuning.strategy = strategy;
  return options;
}

/// The ratio of one set.
double compare(const Arguments& a, test::DeviceMemory& memory, const std::string& name, const std::vector<double>& xy) {
  const DevicePoints input{.x = memory.upload(std::span<const double>(xy)), .size = xy.size() / 2};
  std::vector<std::unique_ptr<Triangulator>> triangulators;
  for (const Strategy strategy : strategies)
    triangulators.push_back(std::make_unique<Triangulator>(options_of(a, memory, strategy)));
  std::array<std::vector<double>, strategies.size()> times;
  std::array<Statistics, strategies.size()> last;
  for (int round = -a.warm_up; round < a.rounds; ++round) {
    for (std::size_t turn = 0; turn < strategies.size(); ++turn) {
      // each of them first, and after each of the others
      const std::size_t s = (turn + static_cast<std::size_t>(round + a.warm_up)) % strategies.size();
      const double begin = now();
      const DeviceTriangulation mesh = triangulators[s]->triangulate(input);
      memory.wait();
      if (round >= 0) times[s].push_back(now() - begin);
      last[s] = mesh.statistics();
    }
  }
  const double ratio = median(times[0]) / std::min(median(times[1]), median(times[2]));
  std::printf("%-14s %9zu  auto %9.3f  locks %9.3f  stars %9.3f  ratio %5.2f%s\n", name.c_str(), input.size,
              median(times[0]), median(times[1]), median(times[2]), ratio, ratio > promised ? "  <" : "");
  for (std::size_t s = 0; a.phases && s < strategies.size(); ++s) {
    std::printf("    %-5s", std::string(to_string(strategies[s])).c_str());
    for (const auto& [phase, ms] : last[s].milliseconds) std::printf(" %s %.2f", phase.c_str(), ms);
    std::printf(" | unproven %llu, wrapped %llu, launches %llu, repairs %llu\n          ",
                static_cast<unsigned long long>(last[s].distinct - last[s].proven_stars),
                static_cast<unsigned long long>(last[s].wrapped_stars),
                static_cast<unsigned long long>(last[s].launches),
                static_cast<unsigned long long>(last[s].sweep_repairs));
    triangulators[s].reset();
    Options options = options_of(a, memory, strategies[s]);
    options.tuning.kernel_times = true;
    Triangulator timed(options);
    for (int run = 0; run < 2; ++run) last[s] = timed.triangulate(input).statistics();
    double others = 0;
    for (std::size_t k = 0; k < last[s].kernels.size(); ++k) {
      const KernelTime& kernel = last[s].kernels[k];
      if (k < most_kernels)
        std::printf(" %s %.3f (%llu)", kernel.name.c_str(), kernel.milliseconds,
                    static_cast<unsigned long long>(kernel.launches));
      else
        others += kernel.milliseconds;
    }
    std::printf(" others %.3f\n", others);
  }
  std::fflush(stdout);
  return ratio;
}

std::vector<double> make_points(const std::string& name, std::size_t n) {
  io::GenerateOptions options;
  options.n = n;
  if (name != cocircular) return io::generate(name, options).xy;
  options.k = 12;
  options.epsilon = 0;
  return io::generate("circles", options).xy;
}

int run(const Arguments& a) {
  std::vector<std::string> names = a.sets;
  if (names.empty()) {
    for (const io::Distribution& distribution : io::distributions()) names.emplace_back(distribution.name);
    names.emplace_back(cocircular);
  }
  double worst = 0;
  for (const std::size_t points : a.points) {
    for (const std::string& name : names) {
      const std::unique_ptr<test::DeviceMemory> memory =
          test::device_memory(backend_from_string(a.backend), a.device);  // with the uploads of one set
      if (!memory) throw BackendUnavailable(a.backend, "it is not compiled in");
      worst = std::max(worst, compare(a, *memory, name, make_points(name, points)));
    }
  }
  std::printf("the largest ratio: %.2f\n", worst);
  return worst > promised ? 1 : 0;
}

}  // namespace

int main(int count, char** values) {
  Arguments a;
  CLI::App app("Times auto, locks and stars in turn on the same points on a device.", "cadt-compare-strategies");
  app.add_option("-n,--points", a.points, "points of each set, with commas between")->delimiter(',');
  app.add_option("-d,--sets", a.sets,
                 "names as in 'cadt generate --list', or 12-gons, with commas between (default: all)")
      ->delimiter(',');
  app.add_option("--backend", a.backend, "cuda, opencl or host (default: cuda)");
  app.add_option("--device", a.device, "its number within the back end (default: 0)");
  app.add_option("-r,--rounds", a.rounds, "timed rounds (default: 15)")->check(CLI::PositiveNumber);
  app.add_option("--warm-up", a.warm_up, "rounds before (default: 2)")->check(CLI::NonNegativeNumber);
  app.add_flag("--phases", a.phases, "the phases of the last runs, and the longest kernels");
  app.add_flag("--canonical", a.canonical, "in the canonical order");
  app.footer("Exit codes: 0 no ratio is above 1.10, 1 some are.");
  CLI11_PARSE(app, count, values);
  try {
    return run(a);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cadt-compare-strategies: %s\n", error.what());
    return 2;
  }
}
