// SPDX-License-Identifier: Apache-2.0
// What the commands that ask a mesh share: options, the mesh of a point file, values, the end of a run.
#pragma once

#include "device_options.hpp"
#include "failure.hpp"
#include "graph.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "progress.hpp"

#include <cadt/io/query_files.hpp>
#include <cadt/queries.hpp>

#include <CLI/CLI.hpp>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cadt::cli {

struct QueryOptions {
  InputOptions input;
  SegmentOptions segments;
  bool takes_segments = false;  ///< set by add_query_segments
  std::string queries, query_format, query_columns;
  std::string values = "z", method = "linear", outside = "nan";
  std::string output = "-", format;
  DeviceOptions device;
  bool quiet = false;
};

/// Each adds its options to a command.
void add_query_segments(CLI::App& command, QueryOptions& options);
void add_query_points(CLI::App& command, QueryOptions& options);
void add_value_options(CLI::App& command, QueryOptions& options);
void add_query_output(CLI::App& command, QueryOptions& options, const std::vector<std::string>& formats,
                      const std::string& what);
void add_query_work(CLI::App& command, QueryOptions& options);

/// The output, `fallback` being the format of standard output. It may be none of the files that are read.
[[nodiscard]] Output plan_query_output(const QueryOptions& options, const std::vector<std::string>& formats,
                                       const std::string& fallback);

[[nodiscard]] Interpolation method_of(const QueryOptions& options);

/// The mesh of a point file, with segments where they are given, ready to be asked.
class QueryRun {
 public:
  explicit QueryRun(const QueryOptions& options);
  QueryRun(const QueryRun&) = delete;
  QueryRun& operator=(const QueryRun&) = delete;

  /// Triangulates and prepares. Says so if there are no triangles.
  void make_mesh();
  /// Numbers at the points: their third coordinate or a file. Throws Failure if there are not as many as points.
  [[nodiscard]] io::Values read_values() const;
  /// The same at all vertices, also at crossings that have become some. \pre make_mesh()
  [[nodiscard]] std::vector<double> values_of_vertices(io::Values values) const;
  [[nodiscard]] io::PointSet read_queries();

  /// Asks the mesh. What it refuses is an error of the option `about`, or of the files if that is empty.
  template <class Question>
  auto ask(const std::string& what, Question question, const std::string& about = {}) {
    auto answer = guarded(what, about, [&] { return question(*queries_); });
    line.clear();
    return answer;
  }
  /// Writes the output, then the summary to standard error if that is not what the user reads.
  void write(const Output& output, const std::function<void()>& writer,
             const std::vector<std::pair<std::string, std::string>>& summary);

  io::PointSet points;
  ProgressLine line;

 private:
  template <class Work>
  auto guarded(const std::string& what, const std::string& about, Work work) {
    line.step(what);
    try {
      const InPhase phase(Phase::cooperative);
      auto result = work();
      check_interrupt();
      return result;
    } catch (const InputError& e) {
      refuse(e, about);
    } catch (const NotDelaunay&) {
      throw Failure(
          exit_usage,
          "with segments not all triangles are Delaunay, and nearest points and natural neighbours need that: "
          "leave the segments out, or ask for triangles and linear values");
    }
  }
  [[noreturn]] void refuse(const InputError& error, const std::string& about) const;

  [[nodiscard]] const Triangulation& mesh() const { return constrained_ ? constrained_->mesh() : mesh_; }

  const QueryOptions& options_;
  const std::string name_;  ///< of the files, for messages
  Options library_;
  std::optional<Graph> graph_;  ///< without its points
  Triangulation mesh_;
  std::optional<ConstrainedTriangulation> constrained_;
  std::optional<MeshQueries> queries_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace cadt::cli
