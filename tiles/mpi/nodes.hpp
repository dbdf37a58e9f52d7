// SPDX-License-Identifier: Apache-2.0
// The nodes of a rank, and what it tells the others meanwhile.
#pragma once

#include "tiles/mpi/communicator.hpp"
#include "tiles/schedule.hpp"

#include <cadt/stop_token.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace cadt::tiles::mpi {

struct Nodes {
  const std::vector<int>& owner;                                ///< of each node
  const std::vector<bool>& valid;                               ///< by node: is there already
  std::function<void(std::uint32_t nodes_done)> progress = {};  ///< on rank 0: nodes of all ranks, without valid ones
  cadt::stop_token interrupted = {};                            ///< ends all ranks
  cadt::stop_source& stop;  ///< of this rank's devices: requested when any rank has failed
};

/// Makes this rank's nodes: `job` without `done`, `awaited`, `computed` and `stop`, which are set here. Collective.
/// \throws what settle() says
void make_nodes(Communicator& ranks, std::vector<Triangulators>& devices, Job&& job, const Nodes& nodes);

}  // namespace cadt::tiles::mpi
