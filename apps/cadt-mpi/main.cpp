// SPDX-License-Identifier: Apache-2.0
// The program `cadt-mpi`: one mesh by all processes that mpirun or srun has started.
#include "apps/cadt-mpi/tiles.hpp"
#include "apps/cadt/failure.hpp"
#include "apps/cadt/help.hpp"
#include "apps/cadt/interrupt.hpp"
#include "apps/cadt/tile_errors.hpp"

#include <cadt/version.hpp>

#include "tiles/mpi/run.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdlib>
#include <memory>
#include <string>

namespace {

using namespace cadt::cli;
namespace mpi = cadt::tiles::mpi;

class MpiHelp : public HelpFormatter {
 public:
  std::string make_usage(const CLI::App* /*app*/, std::string /*name*/) const override {
    return "\nUsage: mpirun -n RANKS cadt-mpi tiles [OPTIONS] IN... -o mesh.cadt\n";
  }
};

/// Leaves `action` empty for help and version.
void parse(int argc, char** argv, bool print_help, RankAction& action) {
  CLI::App app("cadt-mpi makes one Delaunay triangulation by all processes that an MPI launcher has started.",
               "cadt-mpi");
  app.set_version_flag("--version", "cadt-mpi " CADT_VERSION, "print the version and exit");
  app.set_help_flag("-h,--help", "print this help and exit");
  app.formatter(std::make_shared<MpiHelp>());
  add_mpi_tiles(app, action);
  app.footer(std::string(exit_codes_of_tiles));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    if (print_help) app.exit(e);
    return;
  } catch (const CLI::ParseError& e) {
    const auto chosen = app.get_subcommands();
    const bool no_command = chosen.empty() && argc > 1 && argv[1][0] != '-';
    const std::string what = no_command       ? explain_command(app, argv[1])
                             : chosen.empty() ? explain(e, app, "cadt-mpi")
                                              : explain(e, *chosen.front(), "cadt-mpi tiles");
    throw Failure(exit_usage, fmt::format("{}; see: cadt-mpi tiles --help", what));
  }
  if (!action) throw Failure(exit_usage, "a command is missing; see: cadt-mpi --help");
}

/// Slurm and MPI that do not know each other make one rank of each task, which would do the work of all.
void require_ranks_of_slurm(const mpi::Communicator& ranks) {
  const char* const tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  const bool by_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr;
  if (ranks.size() > 1 || by_mpirun || tasks == nullptr || std::strtoul(tasks, nullptr, 10) < 2) return;
  throw Failure(exit_usage,
                fmt::format("Slurm has started {} tasks, but each is the only rank of its own: this MPI needs "
                            "srun --mpi=pmix, or --mpi=pmi2 (srun --mpi=list), or mpirun",
                            tasks));
}

int parse_and_run(mpi::Communicator& ranks, int argc, char** argv) {
  RankAction action;
  ranks.agree([&] { parse(argc, argv, ranks.rank() == 0, action); });
  if (!action) return exit_done;
  require_ranks_of_slurm(ranks);
  install_interrupt_handlers();
  const InPhase phase(Phase::cooperative);
  return action(ranks);
}

/// In a catch block, on the rank that tells what has happened.
int report(const mpi::Communicator& ranks) {
  int code = exit_internal;
  try {
    with_tile_errors([] { throw; });
  } catch (const mpi::RankError& e) {
    say(fmt::format("cadt: error: {}\n", e.what()));
    code = exit_usage;
  } catch (...) {
    code = report_exception();
  }
  if (ranks.size() > 1)
    say(fmt::format("  This is rank {} of {}, on {}. All ranks stop.\n", ranks.rank(), ranks.size(), ranks.host()));
  return code;
}

}  // namespace

int main(int argc, char** argv) {
#if defined(SIGXFSZ)
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows over its limit is an error of the write, with the file's name
#endif
  mpi::Communicator ranks(argc, argv);
  mpi::Words code{exit_done};
  int teller = 0;
  try {
    code[0] = static_cast<std::uint64_t>(parse_and_run(ranks, argc, argv));
    ranks.agree([] { finish_stdout(); });
  } catch (const mpi::OtherRankFailed& e) {
    teller = e.rank();
  } catch (...) {
    teller = ranks.rank();
    code[0] = static_cast<std::uint64_t>(report(ranks));
    if (!ranks.has_settled()) ranks.abort(static_cast<int>(code[0]));
  }
  std::signal(SIGTERM, SIG_IGN);  // that of mpirun to the others when one has ended with an error tells nothing new
  ranks.broadcast(code, teller);
  return static_cast<int>(code[0]);
}
