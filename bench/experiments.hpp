// SPDX-License-Identifier: Apache-2.0
// The tables and figures of the paper, and a few of our own.
#pragma once

#include "bench/bench.hpp"

#include <string_view>
#include <vector>

namespace cadt::bench {

struct Experiment {
  std::string_view name;   ///< and that of its files
  std::string_view shows;  ///< the paper's table or figure
  std::string_view what;
  std::vector<Row> (*run)(Bench&);
};

/// All, in the order in which they are done.
[[nodiscard]] const std::vector<Experiment>& experiments();

// experiments_time.cpp
[[nodiscard]] std::vector<Row> run_sizes(Bench& bench);
[[nodiscard]] std::vector<Row> run_blocks(Bench& bench);
[[nodiscard]] std::vector<Row> run_breakdown(Bench& bench);
[[nodiscard]] std::vector<Row> run_distributions(Bench& bench);
[[nodiscard]] std::vector<Row> run_works(Bench& bench);
[[nodiscard]] std::vector<Row> run_statistics(Bench& bench);
[[nodiscard]] std::vector<Row> run_devices(Bench& bench);
// experiments_kernels.cpp
[[nodiscard]] std::vector<Row> run_kernels(Bench& bench);
// experiments_flips.cpp
[[nodiscard]] std::vector<Row> run_flips(Bench& bench);
[[nodiscard]] std::vector<Row> run_thresholds(Bench& bench);
// experiments_pictures.cpp
[[nodiscard]] std::vector<Row> run_snapshots(Bench& bench);
[[nodiscard]] std::vector<Row> run_bunny(Bench& bench);

}  // namespace cadt::bench
