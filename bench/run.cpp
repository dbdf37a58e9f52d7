// SPDX-License-Identifier: Apache-2.0
// cadt-bench EXPERIMENT... : the runner.
#include "apps/cadt/failure.hpp"
#include "apps/cadt/text.hpp"
#include "bench/commands.hpp"
#include "bench/experiments.hpp"
#include "bench/machine.hpp"
#include "bench/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace cadt::bench {
namespace {

namespace fs = std::filesystem;
using cli::exit_usage;
using cli::Failure;

struct Arguments {
  std::vector<std::string> experiments, who, backends;
  std::string out, scale, device, data, machine, points;
  double limit = 0;
  int warm_up = -1, runs = 0;
  bool list = false, all_devices = false, keep = false, profile = false;
};

std::string list_text() {
  std::vector<std::vector<std::string>> rows = {{"EXPERIMENT", "PAPER", "WHAT"}};
  for (const Experiment& e : experiments())
    rows.push_back({std::string(e.name), e.shows.empty() ? "-" : std::string(e.shows), std::string(e.what)});
  return cli::table(rows) + "\nall: every one of them\n";
}

/// In the order of the table, each once.
std::vector<const Experiment*> chosen(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Experiment& e : experiments()) known.emplace_back(e.name);
  if (names.empty())
    throw Failure(exit_usage,
                  fmt::format("name an experiment: all, {}; cadt-bench --list explains them", cli::join(known, ", ")));
  for (const std::string& name : names) {
    if (name != "all" && std::ranges::find(known, name) == known.end())
      throw Failure(exit_usage,
                    fmt::format("there is no experiment '{}'; there are: all, {}", name, cli::join(known, ", ")));
  }
  const bool all = std::ranges::find(names, "all") != names.end();
  std::vector<const Experiment*> result;
  for (const Experiment& e : experiments())
    if (all || std::ranges::find(names, e.name) != names.end()) result.push_back(&e);
  return result;
}

void check_words(const std::vector<std::string>& words, const std::vector<std::string>& known, const char* option) {
  for (const std::string& word : words) {
    if (std::ranges::find(known, word) == known.end())
      throw Failure(exit_usage,
                    fmt::format("{}: there is no '{}'; there are: {}", option, word, cli::join(known, ", ")));
  }
}

Scale scale_of(const std::string& word) {
  if (word.empty()) {
    const auto devices = list_devices();
    return std::ranges::any_of(devices, [](const DeviceInfo& d) { return d.usable && d.gpu; }) ? Scale::full
                                                                                               : Scale::small;
  }
  for (const Scale scale : {Scale::tiny, Scale::small, Scale::full})
    if (word == to_string(scale)) return scale;
  throw Failure(exit_usage, fmt::format("--scale: there is no '{}'; there are: small, full", word));
}

fs::path data_folder(const std::string& asked) {
  if (!asked.empty()) {
    if (!fs::is_directory(asked)) throw Failure(exit_usage, fmt::format("--data {}: is not a folder", asked));
    return asked;
  }
  const char* variable = std::getenv("CADT_DATA_DIR");
  return variable != nullptr && *variable != 0 ? variable : CADT_BENCH_DATA_DIR;
}

std::vector<Peer> peers_for(const std::vector<std::string>& who) {
  static const std::vector<std::string> names = {"cgal", "scipy", "cupy"};
  const auto asked = [&](const std::string& name) { return std::ranges::find(who, name) != who.end(); };
  // Querying all of them takes seconds: Python's modules are large.
  if (!who.empty() && std::ranges::none_of(names, asked)) return {};
  return find_peers(fs::read_symlink("/proc/self/exe").parent_path());
}

std::vector<PeerInfo> infos(const std::vector<Peer>& peers) {
  std::vector<PeerInfo> result;
  for (const Peer& peer : peers) result.push_back({peer.name, peer.version, peer.usable(), peer.reason});
  return result;
}

Settings settings_of(const Arguments& arguments) {
  Settings settings;
  settings.out = arguments.out;
  settings.data = data_folder(arguments.data);
  settings.plan = plan_of(scale_of(arguments.scale));
  if (arguments.limit > 0) settings.plan.limit_seconds = arguments.limit;
  if (arguments.warm_up >= 0) settings.plan.warm_up = arguments.warm_up;
  if (arguments.runs > 0) settings.plan.runs = arguments.runs;
  if (!arguments.points.empty()) settings.plan.kernel_points = cli::parse_count(arguments.points);
  settings.choice = {arguments.who, arguments.backends, arguments.device};
  settings.all_devices = arguments.all_devices;
  settings.profile = arguments.profile;
  return settings;
}

int run(const Arguments& arguments) {
  if (arguments.list) {
    cli::print(list_text());
    return cli::exit_done;
  }
  const auto todo = chosen(arguments.experiments);
  if (arguments.out.empty()) throw Failure(exit_usage, "name the folder for the results with --out DIR");
  check_words(arguments.who, all_who(), "--who");
  check_words(arguments.backends, {"host", "opencl", "cuda"}, "--backend");
  const Settings settings = settings_of(arguments);

  const Stopwatch all;
  const std::vector<Peer> peers = peers_for(arguments.who);
  const std::string name = arguments.machine.empty() ? default_machine_name() : arguments.machine;
  // First of all, so that a folder that cannot be written is found before the work.
  write_file(settings.out / "machine.json", machine_json(name, infos(peers)));

  Bench bench(settings, find_contestants(settings.choice, peers));
  std::vector<std::vector<std::string>> summary = {{"EXPERIMENT", "ROWS", "SKIPPED", "SECONDS", "FILE"}};
  for (const Experiment* experiment : todo) {
    const std::string word(experiment->name);
    const fs::path file = settings.out / (word + ".csv");
    if (arguments.keep && fs::exists(file)) {
      summary.push_back({word, "-", "-", "kept", file.string()});
      continue;
    }
    const Stopwatch watch;
    bench.begin(word);
    std::vector<Row> rows = experiment->run(bench);
    for (Row& row : rows) row.experiment = word;
    // The CSV last: it is the one that says that the experiment is complete.
    write_file(settings.out / (word + ".json"), json(rows));
    write_file(file, csv(rows));
    bench.end();
    const auto skipped = std::ranges::count_if(rows, [](const Row& row) { return !row.skipped.empty(); });
    summary.push_back({word, std::to_string(rows.size()), std::to_string(skipped),
                       fmt::format("{:.1f}", watch.milliseconds() / 1000.0), file.string()});
  }
  cli::say(fmt::format("{}\n{} in {:.0f} s\n", cli::table(summary), name, all.milliseconds() / 1000.0));
  return cli::exit_done;
}

const char* const footer =
    "Examples:\n"
    "  cadt-bench --list\n"
    "      the experiments, each with the paper's table or figure\n\n"
    "  cadt-bench all --out build/evaluation/here\n"
    "      all of them, on what this machine has; 'full' needs a GPU and 128 GiB of memory\n\n"
    "  cadt-bench sizes flips --out out --who cgal,host,cuda --time-limit 60 --runs 9\n"
    "      Table 3 and Fig. 9, 10, of three contestants, each call up to a minute\n\n"
    "  cadt-bench all --out out --keep\n"
    "      goes on where an interrupted run stopped\n\n"
    "  cadt-bench kernels --points 10M --backend cuda --profile --out out\n"
    "      launches, time and bandwidth of each kernel, and what ncu counts, if it is on the path\n\n"
    "  cadt-bench compare -d uniform,grid -n 1M -w host,opencl,cgal --check\n"
    "      a table on the terminal, and each mesh compared with CGAL's\n\n"
    "A time is that of the whole call, from points in memory to triangles in memory. Before each measurement its time "
    "is\n"
    "predicted from the same contestant's last size; above the limit it is left out, and its row says so. Warm-ups "
    "and\n"
    "runs end when 3 s or a quarter of the limit are used up; the columns warmups and runs say how many there were.\n\n"
    "Exit codes: 0 done, 1 internal error, 2 wrong command line, 3 a file cannot be written, 130 interrupted.\n";

}  // namespace

void add_experiments(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<Arguments>();
  app.add_option("EXPERIMENT", arguments->experiments, "all, or names as --list has them");
  app.add_flag("--list", arguments->list, "explain the experiments and exit");
  app.add_option("-o,--out", arguments->out, "folder for machine.json and a CSV and a JSON file for each experiment")
      ->type_name("DIR");
  app.add_option("--scale", arguments->scale,
                 "small: minutes on a few cores; full: up to 134,217,728 points. Default: full if there is a usable "
                 "GPU, else small")
      ->type_name("small|full");
  app.add_option("--time-limit", arguments->limit,
                 "seconds of one call; what is predicted to take longer is left out (default: small 8, full 7)")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber.description(""));
  app.add_option("--warm-up", arguments->warm_up, "runs before the timed ones (default: 1)")
      ->type_name("W")
      ->check(CLI::NonNegativeNumber.description(""));
  app.add_option("--runs", arguments->runs, "timed runs (default: small 3, full 5)")
      ->type_name("R")
      ->check(CLI::PositiveNumber.description(""));
  app.add_option("--who", arguments->who,
                 "only these: sequential cgal scipy cupy host opencl cuda, with commas between")
      ->type_name("NAMES")
      ->delimiter(',');
  app.add_option("--backend", arguments->backends, "of cadt only these back ends: host, opencl, cuda")
      ->type_name("NAMES")
      ->delimiter(',');
  app.add_option("--device", arguments->device, "of OpenCL and CUDA this device: its number or a part of its name")
      ->type_name("DEVICE");
  app.add_flag("--all-devices", arguments->all_devices, "experiment 'devices': each usable device of each platform");
  app.add_option("--points", arguments->points,
                 "experiment 'kernels': its number of points, 250000, 2M or 1e6 (default: small 1048576, full 8388608)")
      ->type_name("N");
  app.add_flag("--profile", arguments->profile,
               "experiment 'kernels': what NVIDIA's ncu counts in CUDA's kernels as well; takes minutes");
  app.add_option("--data", arguments->data,
                 "folder that has real/, the real point sets (default: CADT_DATA_DIR, else ../shared/data)")
      ->type_name("DIR");
  app.add_flag("--keep", arguments->keep, "leave experiments whose CSV is there already");
  app.add_option("--machine", arguments->machine, "name of this machine in the report (default: its card or processor)")
      ->type_name("NAME");
  app.footer(footer);
  app.final_callback([arguments, &action] {
    if (!action) action = [arguments] { return run(*arguments); };
  });
}

void add_machine(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("machine", "print machine.json: what the measurements would be made on");
  command->callback([&action] {
    action = [] {
      cli::print(machine_json(default_machine_name(), infos(peers_for({}))));
      return cli::exit_done;
    };
  });
}

}  // namespace cadt::bench
