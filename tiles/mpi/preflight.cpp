// SPDX-License-Identifier: Apache-2.0
#include <cadt/io/errors.hpp>
#include <cadt/version.hpp>

#include "tiles/hash.hpp"
#include "tiles/machine.hpp"
#include "tiles/mpi/run.hpp"
#include "tiles/run_parts.hpp"

#include <array>
#include <numeric>

namespace cadt::tiles::mpi {
namespace {

Hash128 hash_of_program() {
  try {
    const MappedFile file("/proc/self/exe");
    return hash_bytes(file.bytes().data(), file.bytes().size());
  } catch (const io::FileError&) {  // a system without /proc
    constexpr std::string_view version = CADT_VERSION;
    return hash_bytes(version.data(), version.size(), format_version);
  }
}

}  // namespace

void require_same_program(Communicator& ranks, std::string_view task) {
  const Hash128 program = hash_of_program(), same = hash_bytes(task.data(), task.size());
  const std::array<std::uint64_t, 4> mine{program.high, program.low, same.high, same.low};
  const Exchanged all = ranks.all_gather(mine);
  const auto first = all.from(0);
  ranks.agree([&] {
    const std::string who = "rank " + std::to_string(ranks.rank()) + " on " + ranks.host();
    if (mine[0] != first[0] || mine[1] != first[1])
      throw RankError(ranks.rank(), who + " runs another build of the program (this is version " CADT_VERSION
                                          ") than rank 0: install the same on all machines");
    if (mine[2] != first[2] || mine[3] != first[3])
      throw RankError(ranks.rank(), who +
                                        " was given other input, output, tiles or --resume than rank 0: give all "
                                        "ranks the same; devices, threads, memory and scratch may differ");
  });
}

void require_same_input(Communicator& ranks, const PointSource& source) {
  const std::array<std::uint64_t, 1> mine{source.size()};
  const Exchanged all = ranks.all_gather(mine);
  const std::uint64_t first = all.from(0).front();
  ranks.agree([&] {
    if (mine[0] == first) return;
    throw RankError(ranks.rank(), "rank " + std::to_string(ranks.rank()) + " on " + ranks.host() + " reads " +
                                      std::to_string(mine[0]) + " points, and rank 0 " + std::to_string(first) +
                                      ": give all ranks the same files, to which nothing writes");
  });
}

std::uint64_t shuffle_memory(const Communicator& ranks, const PointSource& source, const RunOptions& options) {
  const auto sharing = static_cast<std::uint64_t>(ranks.local_size());
  return tiles::shuffle_memory(options, available_memory() / sharing, leaf_memory(source, options, 1));
}

void preflight(Communicator& ranks, const PointSource& source, const RunOptions& options) {
  ranks.agree([&] {
    require_tile_points(options);
    const std::uint64_t leaves = leaf_memory(source, options, 1) * static_cast<std::uint64_t>(ranks.local_size());
    const std::uint64_t available = available_memory();
    if (leaves > available)
      throw OutOfMemory("the tiles at work of the " + std::to_string(ranks.local_size()) + " ranks of " + ranks.host() +
                            " do not fit into memory; make them smaller with --tile-points, or start fewer ranks there",
                        leaves, available);
    if (ranks.rank() != 0 || options.output.empty()) return;
    if (const std::uint64_t output = output_bytes(source, options); output != 0) require_disk(options.output, output);
    if (!options.resume) check_new_directory(options.output);
  });
}

void require_scratch(Communicator& ranks, const std::string& scratch, std::uint64_t bytes) {
  const Words all = ranks.local_gather(std::span(&bytes, 1));
  ranks.agree([&] {
    if (bytes != 0) require_disk(scratch, std::accumulate(all.begin(), all.end(), std::uint64_t{0}));
  });
}

}  // namespace cadt::tiles::mpi
