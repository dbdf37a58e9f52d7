// SPDX-License-Identifier: Apache-2.0
// Shared by the experiments: contestants, points, opened devices, limits, and how a row is measured.
#pragma once

#include "apps/cadt/progress.hpp"
#include "bench/contestants.hpp"
#include "bench/measure.hpp"
#include "bench/plan.hpp"
#include "bench/points.hpp"
#include "bench/row.hpp"

#include <cadt/cadt.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace cadt::bench {

struct Settings {
  std::filesystem::path out, data;
  Plan plan;
  Choice choice;
  bool all_devices = false;
  bool profile = false;  ///< with ncu too
};

/// One measurement. The options of cadt mean nothing to the other contestants.
struct Task {
  SetId set;
  const Contestant* who = nullptr;
  unsigned block = 0;  ///< 0: the library chooses
  Stabilize stabilize = Stabilize::off;
  unsigned threshold = 3;  // R and epsilon of the paper's figures 9 and 10
  double epsilon = 1e-4;
  StatisticsDetail detail = StatisticsDetail::counters;
  Strategy strategy = Strategy::locks;  ///< the paper's method is measured
  bool kernel_times = false;
  int runs = 0;  ///< 0: as in the plan
  std::function<void(const Snapshot&)> watch;
};

class Bench {
 public:
  Bench(Settings settings, std::vector<Contestant> contestants);

  [[nodiscard]] const Plan& plan() const noexcept { return settings_.plan; }
  [[nodiscard]] const Settings& settings() const noexcept { return settings_; }
  [[nodiscard]] PointStore& points() noexcept { return points_; }

  [[nodiscard]] std::vector<const Contestant*> everybody() const;
  /// The available back ends of cadt.
  [[nodiscard]] std::vector<const Contestant*> cadt() const;
  /// Those of them that are devices: the host has no blocks.
  [[nodiscard]] std::vector<const Contestant*> cadt_devices() const;
  /// GPUs if there are any, else all of them.
  [[nodiscard]] std::vector<const Contestant*> cadt_on_cards() const;
  /// The fastest of them: cuda, else a GPU with opencl, else the host, else opencl; null if there is none.
  [[nodiscard]] const Contestant* fastest() const;
  /// Adds a row with the reason for each contestant that cannot take part; `with_peers`: also for other programs.
  void report_missing(std::vector<Row>& rows, bool with_peers) const;

  /// Times a task. A failure is stored in the row's `skipped`. \param mesh receives the mesh of the last run; empty if
  /// there is none
  Row measure(const Task& task, Triangulation* mesh = nullptr);

  /// Sets the name of the experiment on the progress line.
  void begin(std::string experiment) { experiment_ = std::move(experiment); }
  void end() noexcept { progress_.clear(); }

 private:
  using Key = std::tuple<std::string, std::string, unsigned, unsigned, bool>;

  void time(const Task& task, std::optional<double> predicted, Row& row, Triangulation* mesh);
  void time_cadt(const Task& task, std::optional<double> predicted, Row& row, Triangulation* mesh);
  void time_sequential(const Task& task, std::optional<double> predicted, Row& row);
  void time_peer(const Task& task, std::optional<double> predicted, Row& row);
  [[nodiscard]] Repeats repeats(const Task& task, std::optional<double> predicted,
                                const std::function<double()>& call) const;
  Triangulator& opened(const Task& task);
  /// OpenCL compiles a kernel when it is first enqueued, and each mode has kernels of its own: a call on a few of the
  /// points, so that no time and no prediction includes this.
  void use_once(const Task& task, Triangulator& triangulator, std::span<const double> xy);

  Settings settings_;
  std::vector<Contestant> contestants_;
  PointStore points_;
  Predictor predictor_;
  std::map<Key, std::unique_ptr<Triangulator>> opened_;
  std::set<std::tuple<const Triangulator*, Stabilize, StatisticsDetail, Strategy>> used_;
  cli::ProgressLine progress_;
  std::string experiment_;
};

}  // namespace cadt::bench
