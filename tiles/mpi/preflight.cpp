// SPDX-License-Identifier: Apache-2.0
#include <cadt/io/errors.hpp>
#include <cadt/version.hpp>

#include "tiles/hash.hpp"
#include "tiles/machine.hpp"
#include "tiles/mpi/run.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>

namespace cadt::tiles::mpi {
namespace {

/// What leaves of a rank take on the host while they are read, computed and written (as in tiles::preflight).
std::uint64_t leaf_memory(const PointSource& source, const RunOptions& options) {
  constexpr std::uint64_t read = 24, written = 24 + 48;
  const bool arrays = !options.output.empty() || options.collect;
  return std::min(source.size(), options.tile_points) * (2 * read + (arrays ? 2 * written : 0));
}

Hash128 hash_of_program() {
  try {
    const MappedFile file("/proc/self/exe");
    return hash_bytes(file.bytes().data(), file.bytes().size());
  } catch (const io::FileError&) {  // a system without /proc
    constexpr std::string_view version = CADT_VERSION;
    return hash_bytes(version.data(), version.size(), format_version);
  }
}

void require_disk(const std::string& path, std::uint64_t needed) {
  const std::uint64_t free = available_disk(path);
  if (needed <= free) return;
  throw io::FileError(
      path, 0,
      "the disk is too small: about " + human_bytes(needed) + " are needed, and " + human_bytes(free) + " are free");
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

std::uint64_t shuffle_memory(const Communicator& ranks, const PointSource& source, const RunOptions& options) {
  if (options.host_memory != 0) return options.host_memory;
  const auto sharing = static_cast<std::uint64_t>(ranks.local_size());
  const std::uint64_t available = available_memory() / sharing, leaf = leaf_memory(source, options);
  return available > leaf ? std::max<std::uint64_t>((available - leaf) / 2, 1) : 1;
}

void preflight(Communicator& ranks, const PointSource& source, const RunOptions& options) {
  ranks.agree([&] {
    if (options.tile_points > max_points())
      throw LimitError("a tile takes at most as many points as one triangulation: make --tile-points smaller",
                       static_cast<std::size_t>(options.tile_points), max_points());
    const std::uint64_t leaves = leaf_memory(source, options) * static_cast<std::uint64_t>(ranks.local_size());
    const std::uint64_t available = available_memory();
    if (leaves > available)
      throw OutOfMemory("the tiles at work of the " + std::to_string(ranks.local_size()) + " ranks of " + ranks.host() +
                            " do not fit into memory; make them smaller with --tile-points, or start fewer ranks there",
                        leaves, available);
    if (ranks.rank() != 0 || options.output.empty()) return;
    const std::uint64_t there = options.resume ? bytes_in_folder(options.output) : 0;
    const std::uint64_t written = directory_bytes(source.size());
    if (written > there) require_disk(options.output, written - there);
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
