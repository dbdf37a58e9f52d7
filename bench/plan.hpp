// SPDX-License-Identifier: Apache-2.0
// How large the experiments are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::bench {

/// tiny: seconds, for the tests of the program. small: minutes on a few cores. full: the sizes of the paper, on a GPU.
enum class Scale { tiny, small, full };
[[nodiscard]] std::string_view to_string(Scale scale) noexcept;

struct Plan {
  int warm_up, runs;
  double limit_seconds;  ///< of one call: one that is predicted to take longer is left out
  /// Time for the repetitions of a measurement, in milliseconds. One call may take all of the limit, for a table needs
  /// a number; its repetitions may not.
  [[nodiscard]] double budget() const { return 1000.0 * std::max(3.0, 0.25 * limit_seconds); }
  std::vector<std::size_t> sizes;         ///< Table 3
  std::size_t one_thread_up_to;           ///< the host is also measured with one thread
  std::vector<std::size_t> block_points;  ///< Fig. 4, 5
  std::vector<unsigned> blocks;
  std::size_t breakdown_points;                     ///< Fig. 6
  std::vector<std::size_t> distribution_sizes;      ///< Fig. 7
  std::size_t others_up_to;                         ///< CGAL is on them too
  std::size_t real_points_least, real_points_most;  ///< which real sets are taken
  std::size_t snapshot_points;                      ///< Fig. 8
  std::size_t flips_uniform, flips_circles;         ///< Fig. 9, 10
  std::size_t threshold_points;                     ///< Fig. 11
  unsigned largest_threshold;
  std::vector<std::size_t> works;         ///< Table 4
  std::size_t statistics_points;          ///< cost of the statistics
  std::vector<std::size_t> device_sizes;  ///< all devices
  std::size_t kernel_points;              ///< time and bandwidth of the kernels
  std::size_t copied_bytes;               ///< of the copy that they are compared with: more than the caches hold
};

[[nodiscard]] Plan plan_of(Scale scale);

}  // namespace cadt::bench
