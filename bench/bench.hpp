// SPDX-License-Identifier: Apache-2.0
// What the experiments share: the contestants, the points, opened devices, limits, and how a row comes about.
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
  Strategy strategy = Strategy::locks;  ///< what is repeated here is the paper's method
  bool kernel_times = false;
  int runs = 0;  ///< 0: as the plan has it
  std::function<void(const Snapshot&)> watch;
};

class Bench {
 public:
  Bench(Settings settings, std::vector<Contestant> contestants);

  [[nodiscard]] const Plan& plan() const noexcept { return settings_.plan; }
  [[nodiscard]] const Settings& settings() const noexcept { return settings_; }
  [[nodiscard]] PointStore& points() noexcept { return points_; }

  [[nodiscard]] std::vector<const Contestant*> everybody() const;
  /// The back ends of cadt that are there.
  [[nodiscard]] std::vector<const Contestant*> cadt() const;
  /// Those of them that are devices: the host has no blocks.
  [[nodiscard]] std::vector<const Contestant*> cadt_devices() const;
  /// Graphics cards if there are any, else all of them.
  [[nodiscard]] std::vector<const Contestant*> cadt_on_cards() const;
  /// The fastest of them: cuda, else a graphics card with opencl, else the host, else opencl; none: null.
  [[nodiscard]] const Contestant* fastest() const;
  /// Those who cannot take part, but for the programs that are not cadt: a row for each with the reason.
  void report_missing(std::vector<Row>& rows, bool with_peers) const;

  /// Times it. What goes wrong is in the row's `skipped`. \param mesh gets that of the last run; empty if there is none
  Row measure(const Task& task, Triangulation* mesh = nullptr);

  /// On the terminal's progress line: the name of the experiment.
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
  /// OpenCL compiles a kernel when it is first enqueued, and each mode has its own: a call on few of the points, so
  /// that this is in no time and in no prediction.
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
