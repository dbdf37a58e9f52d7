// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/measure.hpp"

#include <string>
#include <vector>

namespace cadt::bench {

/// A line for each measurement: best and median time, ratio to CGAL on the same points (above 1: faster than CGAL), and
/// ratio to the same contestant on uniform points, per point (above 1: slower than uniform).
[[nodiscard]] std::string table(const std::vector<Measurement>& all);

/// The same as JSON, with every time and the statistics.
[[nodiscard]] std::string json(const std::vector<Measurement>& all);

}  // namespace cadt::bench
