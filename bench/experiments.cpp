// SPDX-License-Identifier: Apache-2.0
#include "bench/experiments.hpp"

namespace cadt::bench {

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> all = {
      {"sizes", "Table 3", "time against the number of uniform points, of cadt, the sequential baseline and others",
       run_sizes},
      {"blocks", "Fig. 4, 5", "time and occupancy against the threads of a block, on each device", run_blocks},
      {"breakdown", "Fig. 6", "what the threads of the insertion spend their time on, and the phases", run_breakdown},
      {"distributions", "Fig. 7", "uniform points, perturbed circles and others, and real sets", run_distributions},
      {"snapshots", "Fig. 8", "the mesh of 2048 points while it grows", run_snapshots},
      {"flips", "Fig. 9, 10", "edges by how often they are flipped, with and without stabilised flipping", run_flips},
      {"thresholds", "Fig. 11", "time against R, the flips of an edge before it counts as unstable", run_thresholds},
      {"works", "Table 4", "the sizes that other works were measured with", run_works},
      {"bunny", "Fig. 12", "Stanford's bunny in three resolutions, exact and as in the paper", run_bunny},
      {"statistics", "", "what the statistics cost, and conflicts against the number of points", run_statistics},
      {"devices", "", "three distributions on each device (--all-devices: on all of every platform)", run_devices},
      {"kernels", "", "time and bandwidth of each kernel, beside a copy on the same device (--points)", run_kernels},
  };
  return all;
}

}  // namespace cadt::bench
