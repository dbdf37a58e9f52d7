// SPDX-License-Identifier: Apache-2.0
#include "apps/cadt-mpi/tiles.hpp"

#include "apps/cadt/device_options.hpp"
#include "apps/cadt/failure.hpp"
#include "apps/cadt/input.hpp"
#include "apps/cadt/interrupt.hpp"
#include "apps/cadt/text.hpp"

#include "tiles/mpi/run.hpp"
#include "tiles/mpi/share.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

namespace mpi = tiles::mpi;

struct MpiOptions {
  std::vector<std::string> inputs;
  InputOptions input;
  std::string output, generate, count, tile_points, scratch, host_memory, stats;
  std::uint64_t seed = 1;
  std::vector<std::string> devices;
  DeviceOptions device;
  bool resume = false, quiet = false;
};

std::unique_ptr<tiles::PointSource> open_source(const MpiOptions& o) {
  if (o.generate.empty() == o.inputs.empty())
    throw Failure(exit_usage, "give files with points, or --generate NAME -n N, and not both");
  if (!o.generate.empty()) {
    io::GenerateOptions generate;
    generate.n = parse_count(o.count);
    generate.seed = o.seed;
    return tiles::generated(o.generate, generate);
  }
  io::ReadOptions read;
  read.format = lower(o.input.format);
  read.columns = o.input.columns;
  read.projection = o.input.projection == "yz"   ? io::Projection::yz
                    : o.input.projection == "zx" ? io::Projection::zx
                                                 : io::Projection::xy;
  return tiles::open_files(o.inputs, read);
}

/// Lines on standard error, since what MPI starts has no terminal: one for each phase and each tenth of it.
class ProgressLines {
 public:
  explicit ProgressLines(bool quiet) : quiet_(quiet) {}
  void operator()(const tiles::RunProgress& now) {
    const int tenth = static_cast<int>(10 * now.fraction);
    if (quiet_ || (phase_ == now.phase && tenth <= tenth_)) return;
    phase_ = now.phase;
    tenth_ = tenth;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::string line = fmt::format("cadt-mpi: {:8.1f} s  {:<8} {:3} %", seconds, phase_, 10 * tenth);
    if (now.nodes != 0) line += fmt::format("  {} of {} nodes", now.nodes_done, now.nodes);
    say(line + '\n');
  }

 private:
  bool quiet_;
  std::string phase_;
  int tenth_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

tiles::RunOptions run_options(mpi::Communicator& ranks, const MpiOptions& o) {
  tiles::RunOptions options;
  const unsigned share = mpi::share_of_cores(ranks);
  ranks.agree([&] {
    if (!o.tile_points.empty()) options.tile_points = parse_count(o.tile_points);
    if (options.tile_points < tiles::least_tile_points)
      throw Failure(exit_usage, fmt::format("--tile-points is at least {}", tiles::least_tile_points));
    options.output = o.output;
    options.resume = o.resume;
    options.scratch = o.scratch;
    if (!o.host_memory.empty()) options.host_memory = parse_bytes(o.host_memory);
    options.stop = interrupt_token();
    Options device = library_options(o.device);
    if (device.threads == 0) device.threads = share;
    const bool open = o.devices.empty() && device.device.empty() && device.backend != Backend::host;
    options.devices = {mpi::share_of_devices(device, ranks.local_rank(), o.devices,
                                             open ? list_devices() : std::vector<DeviceInfo>())};
  });
  return options;
}

int run_tiles(mpi::Communicator& ranks, const MpiOptions& o) {
  mpi::require_same_program(ranks, fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", fmt::join(o.inputs, "|"), o.output,
                                               o.generate, o.count, o.seed, o.tile_points, o.resume, o.input.format,
                                               o.input.columns, o.input.projection));
  tiles::RunOptions options = run_options(ranks, o);
  std::unique_ptr<tiles::PointSource> source;
  ranks.agree([&] { source = open_source(o); });
  ProgressLines lines(o.quiet);
  options.progress = [&](const tiles::RunProgress& now) { lines(now); };
  const tiles::RunResult result = mpi::run(ranks, *source, options);
  ranks.agree([&] {
    if (ranks.rank() != 0) return;
    print(fmt::format("points      {}\nduplicates  {}\ntriangles   {}\nhull        {}\nnodes       {}\nhash        {}\n",
                      result.whole.points, result.whole.points - result.whole.distinct, result.whole.triangles,
                      result.whole.hull_edges, result.nodes.size(), result.hash.to_string()));
  });
  return exit_done;
}

}  // namespace

void add_mpi_tiles(CLI::App& app, RankAction& chosen) {
  CLI::App* command = app.add_subcommand("tiles", "triangulate points in tiles, by all ranks");
  const auto o = std::make_shared<MpiOptions>();
  command->add_option("IN", o->inputs, "files with points, one after the other")->type_name("IN");
  add_read_options(*command, o->input);
  command->add_option("-o,--output", o->output, "folder of the mesh, seen by all ranks")->type_name("DIR");
  command->add_option("--generate", o->generate, "generated points (see: cadt generate --help)")->type_name("NAME");
  command->add_option("-n", o->count, "number of generated points")->type_name("N");
  command->add_option("--seed", o->seed, "of generated points")->type_name("S");
  command->add_option("--tile-points", o->tile_points, "points of a tile at most")->type_name("N");
  command->add_option("--devices", o->devices, "devices of a machine, which its ranks take in turn")->delimiter(',');
  add_device_options(*command, o->device);
  add_memory_option(*command, o->device);
  command->add_option("--scratch", o->scratch, "folder for points that memory does not take")->type_name("DIR");
  command->add_option("--host-memory", o->host_memory, "memory for the points of a rank")->type_name("SIZE");
  command->add_flag("--resume", o->resume, "continue what is in the output folder");
  command->add_flag("-q,--quiet", o->quiet, "nothing on standard error but errors");
  command->callback([o, &chosen] { chosen = [o](mpi::Communicator& ranks) { return run_tiles(ranks, *o); }; });
}

}  // namespace cadt::cli
