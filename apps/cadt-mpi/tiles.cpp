// SPDX-License-Identifier: Apache-2.0
#include "apps/cadt-mpi/tiles.hpp"

#include "apps/cadt/failure.hpp"
#include "apps/cadt/interrupt.hpp"
#include "apps/cadt/progress.hpp"
#include "apps/cadt/system.hpp"
#include "apps/cadt/tiles_command.hpp"

#include <cadt/devices.hpp>

#include "tiles/mpi/run.hpp"
#include "tiles/mpi/share.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

namespace mpi = tiles::mpi;

/// How far all ranks are: on a terminal one line, else, as in the log of a job, a line for each phase and each tenth.
class RankProgress {
 public:
  explicit RankProgress(bool quiet) : lines_(!quiet && !errors_go_to_terminal()), line_(quiet) {}
  void start(std::size_t points) { line_.start(points); }
  void clear() { line_.clear(); }
  void operator()(const tiles::RunProgress& now) {
    const std::string nodes = now.nodes == 0 ? "" : fmt::format(" {}/{}", now.nodes_done, now.nodes);
    if (!lines_) {
      phase_ = std::string(now.phase) + nodes;
      line_.update({.phase = phase_, .fraction = now.fraction});
      return;
    }
    const int tenth = static_cast<int>(10 * now.fraction);
    if (phase_ == now.phase && tenth <= tenth_) return;
    phase_ = now.phase;
    tenth_ = tenth;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    say(fmt::format("cadt-mpi: {:.1f} s: {} {} %{}\n", seconds, phase_, 10 * tenth, nodes));
  }

 private:
  bool lines_;
  ProgressLine line_;
  std::string phase_;
  int tenth_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What must be equal on all ranks.
std::string task(const TilesCommand& c) {
  return fmt::format(
      "{}", fmt::join(std::vector<std::string>{fmt::format("{}", fmt::join(c.inputs, "\n")), c.generate, c.n,
                                               std::to_string(c.set.seed), c.read.format, c.read.columns,
                                               c.read.projection, c.output, c.tile_points, c.resume ? "resume" : ""},
                      "\n"));
}

tiles::RunOptions rank_options(mpi::Communicator& ranks, const TilesCommand& c) {
  tiles::RunOptions options;
  const unsigned cores = mpi::share_of_cores(ranks);
  ranks.agree([&] {
    check_tiles_options(c);
    if (std::find(c.inputs.begin(), c.inputs.end(), "-") != c.inputs.end())
      throw Failure(exit_usage, "standard input reaches one rank alone: give files that all of them can read");
    options = run_options(c);
    Options device = device_options(c);
    if (device.threads == 0) device.threads = cores;
    const std::vector<std::string> named = named_devices(c);
    const bool choose = named.empty() && device.device.empty() && device.backend != Backend::host;
    options.devices = {
        mpi::share_of_devices(device, ranks.local_rank(), named, choose ? list_devices() : std::vector<DeviceInfo>())};
  });
  return options;
}

int run(mpi::Communicator& ranks, const TilesCommand& c) {
  mpi::require_same_program(ranks, task(c));
  tiles::RunOptions options = rank_options(ranks, c);
  std::unique_ptr<tiles::PointSource> source;
  ranks.agree([&] { source = open_source(c); });
  mpi::require_same_input(ranks, *source);
  RankProgress progress(c.quiet);
  progress.start(source->size());
  options.progress = [&progress](const tiles::RunProgress& now) { progress(now); };
  tiles::RunResult result;
  try {
    result = mpi::run(ranks, *source, options);
  } catch (const Cancelled&) {
    progress.clear();
    say_how_to_resume(c);
    throw;
  }
  ranks.agree([&] {
    if (ranks.rank() != 0) return;
    progress.clear();
    write_tiles_reports(c, *source, options, result);
    print_tiles_summary(c, result);
    finish_stdout();
  });
  return exit_done;
}

}  // namespace

void add_mpi_tiles(CLI::App& app, RankAction& chosen) {
  CLI::App* command = app.add_subcommand("tiles", "as cadt tiles, to the same bytes, by all ranks together");
  const auto options = std::make_shared<TilesCommand>();
  add_tiles_options(*command, *options);
  command->get_option("--threads")
      ->description(
          "host threads of each rank; 0: the cores that it may use, divided among the ranks there (default: 0)");
  command->footer(
      "Each rank makes some tiles on one device: of --devices, or of all GPUs, that of its number on the machine, or "
      "the\n"
      "processor. --threads, --host-memory and --max-memory are of a rank. The output folder is one that all ranks "
      "see;\n"
      "--scratch may be a disk of the machine.\n\n"
      "Examples:\n"
      "  mpirun -n 8 cadt-mpi tiles country/*.npy -o country.cadt\n"
      "      one rank for each GPU of a machine that has eight\n"
      "  mpirun -n 4 --map-by ppr:1:node --bind-to none cadt-mpi tiles points.f64 -o mesh.cadt --backend host\n"
      "      one rank on each machine, with all of its cores\n"
      "  srun --mpi=pmix --ntasks-per-node=4 --gpus-per-node=4 cadt-mpi tiles country/*.npy -o country.cadt --resume\n"
      "      goes on after an interruption, also with another number of ranks\n\n" +
      std::string(exit_codes_of_tiles));
  command->callback(
      [options, &chosen] { chosen = [options](mpi::Communicator& ranks) { return run(ranks, *options); }; });
}

}  // namespace cadt::cli
