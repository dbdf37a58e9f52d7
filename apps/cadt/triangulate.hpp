// SPDX-License-Identifier: Apache-2.0
// What `cadt triangulate` is asked for, shared by its two halves: points alone, and points with segments.
#pragma once

#include "device_options.hpp"
#include "graph.hpp"
#include "input.hpp"
#include "output_options.hpp"
#include "report.hpp"
#include "tiles/stopwatch.hpp"

#include <cadt/triangulation.hpp>

#include <optional>
#include <string>
#include <vector>

namespace cadt::cli {

struct TriangulateOptions {
  InputOptions input;
  SegmentOptions segments;
  OutputOptions output;
  DeviceOptions device;
  std::string order = "canonical", stats;
  std::string strategy = "auto";
  std::string stabilize = "off";
  std::optional<unsigned> flip_threshold;
  std::optional<double> epsilon;
  bool strict = false, verify = false, timing = false, kernel_times = false, quiet = false;

  // A bare --stats is the table for people.
  [[nodiscard]] bool stats_table() const { return stats == "table"; }
  [[nodiscard]] bool stats_file() const { return !stats.empty() && !stats_table(); }
};

/// The library's options with these set; `line` shows the progress.
[[nodiscard]] Options library_options(const TriangulateOptions& options, ProgressLine& line);

/// The work where there are segments. `outputs` are those of options.outputs.
int run_graph(const TriangulateOptions& options, std::vector<Output> outputs);

/// The end of both: statistics to a file, the summary, the table.
void print_reports(const TriangulateOptions& options, const RunReport& report);

/// Fewer than three points, or all on a line, are an answer, not an error, unless --strict says otherwise.
void judge_dimension(const Triangulation& mesh, const std::string& name, const TriangulateOptions& options);

/// Throws Failure if the mesh is wrong.
void require_verified(const VerifyReport& report);

}  // namespace cadt::cli
