// SPDX-License-Identifier: Apache-2.0
// cadt and CGAL on the same points, in one process, without files.
#pragma once

#include <cadt/cadt.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace cadt::bench {

struct Fighter {
  std::string name;
  bool cgal = false;
  Options options;
};

struct Comparison {
  std::string distribution, contestant;
  std::size_t points = 0, triangles = 0;
  std::vector<double> seconds;         ///< of each run, ascending
  std::vector<double> device_seconds;  ///< the same without the copies; empty for CGAL
  Statistics statistics;               ///< of the last run; empty for CGAL
  [[nodiscard]] double best() const { return seconds.front(); }
};

/// Reports missing contestants on standard error. \throws BackendUnavailable for an unknown name
[[nodiscard]] std::vector<Fighter> find_fighters(const std::vector<std::string>& names, unsigned threads,
                                                 const std::string& device);
/// One warm-up, then `repeat` runs, each on a fresh copy of the points that is made before the clock starts.
[[nodiscard]] Comparison compare(const Fighter& fighter, const std::vector<double>& xy, int repeat);
/// Empty if the canonical set of triangles equals CGAL's, else what differs.
[[nodiscard]] std::string difference_from_cgal(const Fighter& fighter, const std::vector<double>& xy);
/// Whether this was built with CGAL.
[[nodiscard]] bool has_cgal() noexcept;

/// A line for each: best and median time, ratio to CGAL on the same points (above 1: faster than CGAL), and ratio to
/// the same contestant on uniform points, per point (above 1: slower than uniform).
[[nodiscard]] std::string comparison_table(const std::vector<Comparison>& all);
/// The same as JSON, with every time and the statistics.
[[nodiscard]] std::string comparison_json(const std::vector<Comparison>& all);

}  // namespace cadt::bench
