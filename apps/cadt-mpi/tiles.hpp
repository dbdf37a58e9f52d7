// SPDX-License-Identifier: Apache-2.0
// The command `tiles` of cadt-mpi.
#pragma once

#include "tiles/mpi/communicator.hpp"

#include <CLI/CLI.hpp>

#include <functional>

namespace cadt::cli {

/// Work that all ranks do together; returns the exit code.
using RankAction = std::function<int(tiles::mpi::Communicator&)>;

void add_mpi_tiles(CLI::App& app, RankAction& chosen);

}  // namespace cadt::cli
