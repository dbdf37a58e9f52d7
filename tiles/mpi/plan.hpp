// SPDX-License-Identifier: Apache-2.0
// The tree and the shuffle of several ranks, each of which reads a part of the input.
#pragma once

#include "tiles/manifest.hpp"
#include "tiles/mpi/communicator.hpp"
#include "tiles/run.hpp"
#include "tiles/shuffle.hpp"
#include "tiles/source.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace cadt::tiles::mpi {

/// The same plan as that of one process (tiles::make_plan), on all ranks. Collective. `progress`: a fraction.
/// \throws as tiles::make_plan, on all ranks
[[nodiscard]] Plan make_plan(Communicator& ranks, const PointSource& source, const RunOptions& options,
                             const std::function<void(double)>& progress);

struct Deal {
  const std::vector<int>& owner;    ///< of each node
  const std::vector<bool>& wanted;  ///< by node: leaves whose points are dealt
  const ShuffleOptions& options;    ///< of this rank; `wanted` are its own leaves
  unsigned threads = 1;             ///< of this rank
};
/// Brings the points of each leaf to its owner: in rounds, in each of which ranks read a part of the input each, which
/// are kept in the order of the input. So the input indices in a leaf ascend, whatever the number of ranks. Collective.
/// \throws as tiles::shuffle, on all ranks
[[nodiscard]] std::unique_ptr<LeafStore> shuffle(Communicator& ranks, const PointSource& source, const TileTree& tree,
                                                 const Deal& deal);

}  // namespace cadt::tiles::mpi
