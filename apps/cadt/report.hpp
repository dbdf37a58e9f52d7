// SPDX-License-Identifier: Apache-2.0
// Report of a run: as a summary, as a table and as JSON. docs/cli.md documents the keys: changing one changes the
// interface and requires a new `schema` number.
#pragma once

#include "outputs.hpp"

#include <cadt/constrained.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/verify.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace cadt::cli {

struct RunReport {
  std::string input;  ///< path, "-" for standard input
  std::string input_format;
  bool heights = false;
  const Triangulation* mesh = nullptr;
  const ConstrainedTriangulation* constrained = nullptr;  ///< where there are segments, that of `mesh`
  std::size_t segments = 0;
  std::string domain, crossing;
  std::string hash;
  std::optional<VerifyReport> verification;
  std::string stabilize;  ///< off, defer, paper
  unsigned flip_threshold = 0;
  double epsilon = 0;
  std::optional<std::size_t> differing;  ///< triangles that are not in the exact mesh; --stabilize paper only
  std::vector<Output> outputs;
  double read_seconds = 0, triangulate_seconds = 0, verify_seconds = 0, write_seconds = 0;
};

/// Points, duplicates, triangles, hull, time, back end, hash: one "key value" a line.
[[nodiscard]] std::string summary_text(const RunReport& report);
/// All counters and phases, one a line.
[[nodiscard]] std::string statistics_text(const RunReport& report);
[[nodiscard]] std::string statistics_json(const RunReport& report);

}  // namespace cadt::cli
