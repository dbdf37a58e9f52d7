// SPDX-License-Identifier: Apache-2.0
// Stabilised flips: the effect of Algorithm 4 of the paper on flips, time and mesh.
#include "bench/experiments.hpp"

namespace cadt::bench {

std::vector<Row> run_flips(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  for (const SetId& set :
       {SetId{"uniform", bench.plan().flips_uniform, false}, SetId{"circles", bench.plan().flips_circles, false}}) {
    for (const Contestant* who : bench.cadt()) {
      Task task;
      task.set = set;
      task.who = who;
      Triangulation exact, mesh;
      rows.push_back(bench.measure(task, &exact));
      const bool known = rows.back().skipped.empty();
      for (const Stabilize mode : {Stabilize::defer, Stabilize::paper}) {
        task.stabilize = mode;
        Row row = bench.measure(task, &mesh);
        if (known && row.skipped.empty()) row.differing_triangles = count_differing(mesh, exact);
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

std::vector<Row> run_thresholds(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  for (const char* distribution : {"uniform", "circles"}) {
    for (const Contestant* who : bench.cadt_on_cards()) {
      Task task;
      task.set = {distribution, bench.plan().threshold_points, false};
      task.who = who;
      rows.push_back(bench.measure(task));
      for (unsigned r = 1; r <= bench.plan().largest_threshold; ++r) {
        for (const Stabilize mode : {Stabilize::defer, Stabilize::paper}) {
          task.stabilize = mode;
          task.threshold = r;
          rows.push_back(bench.measure(task));
        }
      }
    }
  }
  return rows;
}

}  // namespace cadt::bench
