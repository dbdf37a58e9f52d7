// SPDX-License-Identifier: Apache-2.0
// What ranks tell each other of nodes when all are done.
#pragma once

#include "tiles/mpi/communicator.hpp"
#include "tiles/run.hpp"

#include <cadt/finalization.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cadt::tiles::mpi {

/// Appends the report of a node, of its statistics the phases alone.
void append(Words& words, std::uint32_t node, const NodeReport& report);
/// All reports that are in the words.
void read_reports(std::span<const std::uint64_t> words, std::vector<NodeReport>& reports);

[[nodiscard]] Words pack(const NodeSums& sums);
[[nodiscard]] NodeSums unpack_sums(std::span<const std::uint64_t> words);

/// The text of each rank. Collective.
[[nodiscard]] std::vector<std::string> gather_texts(Communicator& ranks, const std::string& text);

}  // namespace cadt::tiles::mpi
