// SPDX-License-Identifier: Apache-2.0
// Experiments that show meshes.
#include "bench/experiments.hpp"
#include "bench/interrupt.hpp"
#include "bench/output.hpp"

#include <cadt/io/picture.hpp>
#include <cadt/io/points_file.hpp>

#include <fmt/format.h>

#include <array>
#include <span>
#include <system_error>

namespace cadt::bench {
namespace {

struct Step {
  std::size_t points;
  std::vector<std::int32_t> triangles;
};

/// Otherwise steps of an earlier, longer run would stay.
void clear_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

void draw(const std::filesystem::path& folder, const std::string& name, const io::PointSet& points,
          const Triangulation& mesh) {
  write_file(folder / (name + ".tri"), triangles_text(mesh.triangles()));
  const Writing writing;
  io::write_png((folder / (name + ".png")).string(), points, mesh);
}

}  // namespace

std::vector<Row> run_snapshots(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  const Contestant* who = bench.fastest();
  if (who == nullptr) return rows;
  std::vector<Step> steps;
  Task task;
  task.set = {"uniform", bench.plan().snapshot_points, false};
  task.who = who;
  if (who->backend != Backend::host) task.block = 256;  // "16x16 threads"
  task.runs = 1;
  task.watch = [&steps](const Snapshot& snapshot) {
    steps.push_back({snapshot.points, {snapshot.triangles.begin(), snapshot.triangles.end()}});
  };
  const Row measured = bench.measure(task);
  if (!measured.skipped.empty()) {
    rows.push_back(measured);
    return rows;
  }

  const std::filesystem::path folder = bench.settings().out / "snapshots";
  clear_folder(folder);
  write_file(folder / "points.csv", points_text(bench.points().get(task.set)));
  for (std::size_t k = 0; k < steps.size(); ++k) {
    write_file(folder / fmt::format("step-{}.csv", k), triangles_text(steps[k].triangles));
    Row& row = rows.emplace_back();
    row.distribution = measured.distribution;
    row.points = steps[k].points;
    row.who = measured.who;
    row.backend = measured.backend;
    row.device = measured.device;
    row.threads = measured.threads;
    row.block = k;
    row.stabilize = measured.stabilize;
    row.detail = measured.detail;
    row.triangles = steps[k].triangles.size() / 3;
  }
  rows.back().hash = measured.hash;
  return rows;
}

std::vector<Row> run_bunny(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  const std::filesystem::path folder = bench.settings().out / "bunny";
  clear_folder(folder);
  constexpr std::array<std::pair<const char*, std::size_t>, 3> sets = {
      {{"bunny_res4", 453}, {"bunny_res3", 1889}, {"bunny_res2", 8171}}};
  for (const auto& [name, points] : sets) {
    for (const Contestant* who : bench.cadt()) {
      Task task;
      task.set = {name, points, true};
      task.who = who;
      Triangulation exact, paper;
      rows.push_back(bench.measure(task, &exact));
      task.stabilize = Stabilize::paper;
      Row row = bench.measure(task, &paper);
      const bool both = rows.back().skipped.empty() && row.skipped.empty();
      if (both) row.differing_triangles = count_differing(paper, exact);
      rows.push_back(std::move(row));
      if (!both || who != bench.fastest()) continue;
      io::PointSet set;
      const std::span<const double> xy = bench.points().get(task.set);
      set.xy.assign(xy.begin(), xy.end());
      std::filesystem::create_directories(folder);
      io::write_points((folder / fmt::format("{}.xy", name)).string(), set);
      draw(folder, fmt::format("{}-exact", name), set, exact);
      draw(folder, fmt::format("{}-paper", name), set, paper);
    }
  }
  return rows;
}

}  // namespace cadt::bench
