// SPDX-License-Identifier: Apache-2.0
// One mesh by the ranks of MPI: each has a device, makes some of the leaves and the joins above them, and passes what
// is open to the rank of the next join (docs/scale.md).
#pragma once

#include "tiles/mpi/communicator.hpp"
#include "tiles/run.hpp"
#include "tiles/source.hpp"

#include <cadt/errors.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace cadt::tiles::mpi {

/// Ranks that do not fit together.
class RankError : public Error {
 public:
  RankError(int rank, const std::string& message) : Error(message), rank_(rank) {}
  [[nodiscard]] int rank() const noexcept { return rank_; }

 private:
  int rank_;
};

/// Whether all ranks run the same program, by the hash of its file, and have the same `task`: a text of what must be
/// equal. To be called first. Collective. \throws RankError on the first rank that differs from rank 0, OtherRankFailed
/// on the others
void require_same_program(Communicator& ranks, std::string_view task);

/// Whether all ranks have found equally many points. Collective. \throws as require_same_program
void require_same_input(Communicator& ranks, const PointSource& source);

/// Makes the mesh: the same files, byte by byte, as tiles::run, for any number of ranks. Collective: all ranks give the
/// same source, tile size, first index, output and resume; their one device, scratch and memory are their own. The
/// output must be in a folder that all ranks see; `host_memory` is of a rank (0: its share of half of what its machine
/// has available). `progress` is called on rank 0 alone, `consumer` and `collect` for the nodes that the rank makes.
/// RunResult is complete on all ranks, but for counters of nodes that others made; NodeReport::device is the rank.
///
/// If a rank fails, all stop: what settle() says is thrown, and the directory can be resumed. \throws as tiles::run,
/// and OtherRankFailed
RunResult run(Communicator& ranks, const PointSource& source, const RunOptions& options);

/// What tiles::preflight checks, for the ranks of a machine together. Collective. \throws as that, on all ranks
void preflight(Communicator& ranks, const PointSource& source, const RunOptions& options);
/// Bytes that the points of this rank's leaves may take.
[[nodiscard]] std::uint64_t shuffle_memory(const Communicator& ranks, const PointSource& source,
                                           const RunOptions& options);
/// Collective. \throws io::FileError if `bytes` of the ranks of a machine do not fit into their scratch folders
void require_scratch(Communicator& ranks, const std::string& scratch, std::uint64_t bytes);

}  // namespace cadt::tiles::mpi
