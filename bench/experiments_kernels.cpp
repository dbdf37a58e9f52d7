// SPDX-License-Identifier: Apache-2.0
// Bandwidth of the kernels of a run relative to that of the device's memory.
#include "bench/bandwidth.hpp"
#include "bench/experiments.hpp"
#include "bench/kernel_bytes.hpp"
#include "bench/profiler.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace cadt::bench {
namespace {

Options options_of(const Contestant& who) {
  Options options;
  options.backend = *who.backend;
  options.device = who.index;
  if (who.backend == Backend::host) options.threads = who.threads;
  return options;
}

Profile profile_of(const Bench& bench, const Task& task) {
  if (!bench.settings().profile) return {{}, "not asked for (--profile)"};
  if (task.who->backend != Backend::cuda) return {{}, "ncu knows CUDA's kernels only"};
  constexpr double most_seconds = 300;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  return profile({self, "once", "-n", std::to_string(task.set.points), "-d", task.set.name, "--backend", "cuda",
                  "--device", task.who->index, "--strategy", std::string(to_string(task.strategy))},
                 most_seconds);
}

/// A row a kernel.
void add_kernels(std::vector<Row>& rows, const Row& run, double bytes_a_second, const Profile& profiled) {
  double sum = 0;
  for (const KernelTime& kernel : run.kernels) sum += kernel.milliseconds;
  for (const KernelTime& kernel : run.kernels) {
    Row& row = rows.emplace_back(run);
    row.kernel.emplace();
    row.kernel->name = kernel.name;
    row.kernel->launches = kernel.launches;
    row.kernel->milliseconds = kernel.milliseconds;
    row.kernel->share = sum > 0 ? kernel.milliseconds / sum : 0;
    row.kernel->bytes = least_bytes(kernel.name, *run.statistics, *run.triangles);
    row.kernel->peak = 1e-9 * bytes_a_second;
    row.kernel->profiler = profiled.failure;
    const auto found = profiled.kernels.find(kernel.name);
    if (found == profiled.kernels.end()) continue;
    row.kernel->profiler = "ncu";
    row.kernel->issue_active = found->second.issue_active;
    row.kernel->dram_throughput = found->second.dram_throughput;
    row.kernel->dram_bytes = found->second.dram_bytes;
    row.kernel->operations = found->second.operations;
  }
}

}  // namespace

std::vector<Row> run_kernels(Bench& bench) {
  std::vector<Row> rows;
  bench.report_missing(rows, false);
  for (const Contestant* who : bench.cadt()) {
    double bandwidth = 0;
    std::string failure;
    try {
      bandwidth = copy_bandwidth(options_of(*who), bench.plan().copied_bytes);
    } catch (const Error& error) {
      failure = fmt::format("failed: {}", error.what());
    }
    for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
      Task task;
      task.set = {"uniform", bench.plan().kernel_points, false};
      task.who = who;
      task.strategy = strategy;
      task.kernel_times = true;
      Row run = bench.measure(task);
      if (run.skipped.empty()) run.skipped = failure;
      if (!run.skipped.empty()) {
        rows.push_back(std::move(run));
        continue;
      }
      add_kernels(rows, run, bandwidth, profile_of(bench, task));
    }
  }
  return rows;
}

}  // namespace cadt::bench
