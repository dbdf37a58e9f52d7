// SPDX-License-Identifier: Apache-2.0
// Times of whole calls.
#pragma once

#include <cadt/cadt.hpp>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace cadt::bench {

/// Who computes: a configuration of cadt, or CGAL.
struct Contestant {
  std::string name;
  bool cgal = false;
  Options options;
};

/// Seconds of each repetition, ascending. The warm-up is not among them.
struct Times {
  std::vector<double> seconds;
  [[nodiscard]] double best() const { return seconds.front(); }
  [[nodiscard]] double median() const { return seconds[seconds.size() / 2]; }
};

struct Measurement {
  std::string distribution, contestant;
  std::size_t points = 0, triangles = 0;
  Times times;
  Statistics statistics;  ///< of the last run; empty for CGAL
};

/// Host (all threads, or as many as asked for), OpenCL if it is there, CGAL. Names what is not there on standard error.
[[nodiscard]] std::vector<Contestant> contestants(const std::vector<std::string>& names, unsigned threads,
                                                  const std::string& device);

/// One warm-up, then `repeat` runs, each on a fresh copy of the points that is made before the clock starts.
[[nodiscard]] Measurement measure(const Contestant& contestant, const std::vector<double>& xy, int repeat);

/// Empty if the canonical set of triangles equals CGAL's, else what differs.
[[nodiscard]] std::string difference_from_cgal(const Contestant& contestant, const std::vector<double>& xy);

}  // namespace cadt::bench
