// SPDX-License-Identifier: Apache-2.0
// Experiments that only measure time.
#include "bench/experiments.hpp"

#include <algorithm>

namespace cadt::bench {
namespace {

using Contestants = std::vector<const Contestant*>;

/// Measures all contestants on the same points, one after the other, so that their ratios hold for one time and place.
void measure_all(Bench& bench, std::vector<Row>& rows, const SetId& set, const Contestants& who) {
  for (const Contestant* one : who) {
    Task task;
    task.set = set;
    task.who = one;
    rows.push_back(bench.measure(task));
  }
}

SetId uniform(std::size_t points) { return {"uniform", points, false}; }

}  // namespace

std::vector<Row> run_sizes(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, true);
  Contestants everybody = bench.everybody();
  // The host again with one thread: what parallelism gains, all else being equal.
  Contestant alone;
  const auto host = std::ranges::find(everybody, std::optional(Backend::host), &Contestant::backend);
  const bool with_alone = host != everybody.end() && (*host)->threads > 1;
  if (with_alone) {
    alone = **host;
    alone.threads = 1;
    everybody.insert(host + 1, &alone);
  }
  for (const std::size_t n : bench.plan().sizes) {
    Contestants who = everybody;
    if (n > bench.plan().one_thread_up_to) std::erase(who, &alone);
    measure_all(bench, rows, uniform(n), who);
  }
  return rows;
}

std::vector<Row> run_blocks(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  for (const std::size_t n : bench.plan().block_points) {
    for (const Contestant* who : bench.cadt_devices()) {
      for (const unsigned block : bench.plan().blocks) {
        Task task;
        task.set = uniform(n);
        task.who = who;
        task.block = block;
        rows.push_back(bench.measure(task));
      }
    }
  }
  return rows;
}

std::vector<Row> run_breakdown(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  for (const char* distribution : {"uniform", "circles"}) {
    for (const Contestant* who : bench.cadt()) {
      Task task;
      task.set = {distribution, bench.plan().breakdown_points, false};
      task.who = who;
      task.detail = StatisticsDetail::timing;
      rows.push_back(bench.measure(task));
    }
  }
  return rows;
}

std::vector<Row> run_distributions(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  Contestants who = bench.everybody();
  std::erase_if(who, [](const Contestant* one) { return !one->backend && one->who != "cgal"; });
  Contestants ours = bench.cadt();
  for (const std::size_t n : bench.plan().distribution_sizes) {
    for (const char* distribution : {"uniform", "circles", "gaussian", "kuzmin", "line", "grid"})
      measure_all(bench, rows, {distribution, n, false}, n <= bench.plan().others_up_to ? who : ours);
  }
  if (const std::string reason = bench.points().no_data(); !reason.empty()) {
    Row& row = rows.emplace_back();
    row.distribution = "real";
    row.skipped = reason;
  }
  const Plan& plan = bench.plan();
  for (const SetId& set : bench.points().real_sets(plan.real_points_least, plan.real_points_most))
    measure_all(bench, rows, set, who);
  return rows;
}

std::vector<Row> run_works(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, true);
  for (const std::size_t n : bench.plan().works) measure_all(bench, rows, uniform(n), bench.everybody());
  // The smallest bunny: 477 points in the paper, 453 in the archive of today.
  measure_all(bench, rows, {"bunny_res4", 453, true}, bench.everybody());
  return rows;
}

std::vector<Row> run_statistics(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  const std::size_t largest = bench.plan().statistics_points;
  for (const Contestant* who : bench.cadt()) {
    for (const auto detail : {StatisticsDetail::none, StatisticsDetail::counters, StatisticsDetail::timing}) {
      Task task;
      task.set = uniform(largest);
      task.who = who;
      task.detail = detail;
      task.runs = 3 * bench.plan().runs;  // the differences are small
      rows.push_back(bench.measure(task));
    }
  }
  for (const std::size_t n : bench.plan().sizes) {
    if (n >= largest) continue;
    for (const Contestant* who : bench.cadt()) {
      Task task;
      task.set = uniform(n);
      task.who = who;
      task.runs = 1;  // for its counters, not for its time
      rows.push_back(bench.measure(task));
    }
  }
  return rows;
}

std::vector<Row> run_devices(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  const std::vector<Contestant> all =
      bench.settings().all_devices ? every_device(bench.settings().choice) : std::vector<Contestant>();
  Contestants who = bench.cadt();
  if (bench.settings().all_devices) {
    who.clear();
    for (const Contestant& one : all) who.push_back(&one);
  }
  for (const std::size_t n : bench.plan().device_sizes) {
    for (const char* distribution : {"uniform", "circles", "grid"})
      measure_all(bench, rows, {distribution, n, false}, who);
  }
  return rows;
}

}  // namespace cadt::bench
