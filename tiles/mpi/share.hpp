// SPDX-License-Identifier: Apache-2.0
// What a rank may use of its machine: a share of the cores, and one GPU.
#pragma once

#include "tiles/mpi/communicator.hpp"

#include <cadt/devices.hpp>
#include <cadt/options.hpp>

#include <span>
#include <string>

namespace cadt::tiles::mpi {

/// A bit for each core that this process may use, in as many words for every process.
[[nodiscard]] Words allowed_cores();

/// This rank's threads: each core that the scheduler allows it (the binding of the MPI runtime), divided among the
/// ranks that are allowed the same core; at least 1. Collective.
[[nodiscard]] unsigned share_of_cores(Communicator& ranks);

/// The back end and device of a rank where `options` leave them open: of the GPUs of the back end (automatic: of the
/// first back end that has any, else the host) the one that is the local rank modulo their number; of its other devices
/// where there is no GPU. `named`: devices to choose from, as Options::device names them; empty: all.
[[nodiscard]] Options share_of_devices(Options options, int local_rank, std::span<const std::string> named,
                                       std::span<const DeviceInfo> devices);

}  // namespace cadt::tiles::mpi
