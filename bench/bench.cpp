// SPDX-License-Identifier: Apache-2.0
#include "bench/bench.hpp"

#include "bench/machine.hpp"
#include "bench/sequential.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

namespace cadt::bench {
namespace {

constexpr double second = 1000.0;

/// Key of a contestant, for the predictions.
std::string key_of(const Contestant& who) { return fmt::format("{} {} {}", who.who, who.index, who.threads); }

std::string kind_of(const Task& task) {
  return fmt::format("{} {} {} {} {} {}", task.set.name, task.block, to_string(task.stabilize), to_string(task.detail),
                     to_string(task.strategy), task.kernel_times);
}

/// Host memory of a run with its result, in bytes a point. A generous estimate: a process that the system kills for its
/// memory loses the results too.
std::size_t bytes_a_point(const Contestant& who) {
  constexpr std::size_t result = 60;  // triangles, neighbours, and the temporaries of the hull
  if (who.backend) return result + (who.gpu ? 0 : 130);
  if (who.who == "scipy") return 1200;
  if (who.who == "cupy") return 150;
  return 200;
}

void check_memory(const Contestant& who, std::size_t points) {
  const std::uint64_t needed = std::uint64_t{points} * bytes_a_point(who), available = memory_available();
  if (needed <= available) return;
  constexpr double gib = 1024.0 * 1024.0 * 1024.0;
  throw Skip(fmt::format("out of memory: needs about {:.1f} GiB, {:.1f} GiB are free",
                         static_cast<double>(needed) / gib, static_cast<double>(available) / gib));
}

std::vector<std::pair<std::string, double>> median_phases(const std::vector<Statistics>& runs) {
  std::vector<std::pair<std::string, double>> result;
  for (const auto& [phase, ignored] : runs.back().milliseconds) {
    std::vector<double> times;
    for (const Statistics& run : runs)
      for (const auto& [name, time] : run.milliseconds)
        if (name == phase) times.push_back(time);
    result.emplace_back(phase, median(times));
  }
  return result;
}

std::vector<KernelTime> median_kernels(const std::vector<Statistics>& runs) {
  std::vector<KernelTime> result = runs.back().kernels;
  for (KernelTime& kernel : result) {
    std::vector<double> times;
    for (const Statistics& run : runs)
      for (const KernelTime& one : run.kernels)
        if (one.name == kernel.name) times.push_back(one.milliseconds);
    kernel.milliseconds = median(times);
  }
  std::ranges::stable_sort(result, std::ranges::greater{}, &KernelTime::milliseconds);
  return result;
}

void set_times(Row& row, const Repeats& repeats) {
  row.warmups = repeats.warmups;
  row.runs = repeats.milliseconds.size();
  row.median_ms = median(repeats.milliseconds);
  row.min_ms = std::ranges::min(repeats.milliseconds);
  row.max_ms = std::ranges::max(repeats.milliseconds);
}

Row row_of(const Task& task) {
  const Contestant& who = *task.who;
  Row row;
  row.distribution = task.set.name;
  if (task.set.points > 0) row.points = task.set.points;
  row.who = who.who;
  row.device = who.device;
  if (who.threads > 0) row.threads = who.threads;
  if (!who.backend) return row;
  row.backend = to_string(*who.backend);
  if (task.block > 0) row.block = task.block;
  row.stabilize = to_string(task.stabilize);
  if (task.stabilize != Stabilize::off) row.threshold = task.threshold;
  if (task.stabilize == Stabilize::paper) row.epsilon = task.epsilon;
  row.detail = to_string(task.detail);
  row.strategy = to_string(task.strategy);
  return row;
}

}  // namespace

Bench::Bench(Settings settings, std::vector<Contestant> contestants)
    : settings_(std::move(settings)), contestants_(std::move(contestants)), points_(settings_.data), progress_(false) {}

std::vector<const Contestant*> Bench::everybody() const {
  std::vector<const Contestant*> result;
  for (const Contestant& who : contestants_)
    if (who.present()) result.push_back(&who);
  return result;
}

std::vector<const Contestant*> Bench::cadt() const {
  std::vector<const Contestant*> result = everybody();
  std::erase_if(result, [](const Contestant* who) { return !who->backend; });
  return result;
}

std::vector<const Contestant*> Bench::cadt_devices() const {
  std::vector<const Contestant*> result = cadt();
  std::erase_if(result, [](const Contestant* who) { return who->backend == Backend::host; });
  return result;
}

std::vector<const Contestant*> Bench::cadt_on_cards() const {
  const std::vector<const Contestant*> all = cadt();
  std::vector<const Contestant*> cards = all;
  std::erase_if(cards, [](const Contestant* who) { return !who->gpu; });
  return cards.empty() ? all : cards;
}

const Contestant* Bench::fastest() const {
  const auto rank = [](const Contestant* who) {
    if (who->backend == Backend::cuda) return 0;
    return who->gpu ? 1 : who->backend == Backend::host ? 2 : 3;
  };
  const std::vector<const Contestant*> all = cadt();
  const auto best = std::ranges::min_element(all, {}, rank);
  return best == all.end() ? nullptr : *best;
}

void Bench::report_missing(std::vector<Row>& rows, bool with_peers) const {
  for (const Contestant& who : contestants_) {
    if (who.present() || (!who.backend && !with_peers)) continue;
    Row row;
    row.who = who.who;
    if (who.backend) row.backend = who.who;
    row.skipped = who.missing;
    rows.push_back(std::move(row));
  }
}

Row Bench::measure(const Task& task, Triangulation* mesh) {
  if (mesh) *mesh = Triangulation();
  Row row = row_of(task);
  const Contestant& who = *task.who;
  progress_.step(fmt::format("{}  {} points {}  {}{}", experiment_, task.set.points, task.set.name, who.who,
                             task.block > 0 ? fmt::format(" {}", task.block) : ""));
  try {
    if (!who.present()) throw Skip(who.missing);
    const std::string key = key_of(who), kind = kind_of(task);
    const auto predicted = predictor_.predict(key, kind, task.set.points);
    const double limit = settings_.plan.limit_seconds;
    if (predicted && *predicted > limit * second) {
      predictor_.give_up(key, kind, task.set.points);
      throw Skip(fmt::format("predicted {:.3g} s, limit {:.3g} s", *predicted / second, limit));
    }
    if (const auto fewer = predictor_.given_up(key, kind, task.set.points))
      throw Skip(fmt::format("{} points take too long already", *fewer));
    row.points = points_.get(task.set).size() / 2;
    check_memory(who, *row.points);
    time(task, predicted, row, mesh);
    if (const auto best = row.median_ms ? row.median_ms : row.device_ms)
      predictor_.learn(key, kind, *row.points, *best, task.block == 0);
  } catch (const OutOfMemory& error) {
    row.skipped = fmt::format("out of memory: {}", error.what());
  } catch (const std::bad_alloc&) {
    row.skipped = "out of memory";
  } catch (const Skip& reason) {
    row.skipped = reason.what();
  } catch (const std::exception& error) {
    row.skipped = fmt::format("failed: {}", error.what());
    // A device that has failed once may fail again; opened anew it may recover.
    std::erase_if(opened_, [&](const auto& entry) { return std::get<0>(entry.first) == who.who; });
    used_.clear();
  }
  return row;
}

void Bench::time(const Task& task, std::optional<double> predicted, Row& row, Triangulation* mesh) {
  if (task.who->backend) {
    time_cadt(task, predicted, row, mesh);
  } else if (task.who->peer) {
    time_peer(task, predicted, row);
  } else {
    time_sequential(task, predicted, row);
  }
}

Repeats Bench::repeats(const Task& task, std::optional<double> predicted, const std::function<double()>& call) const {
  const Plan& plan = settings_.plan;
  const int runs = task.runs > 0 ? task.runs : plan.runs;
  const int warm_up = runs == 1 ? 0 : plan.warm_up;
  return repeat(static_cast<std::size_t>(warm_up), static_cast<std::size_t>(runs), plan.budget(), predicted, call);
}

Triangulator& Bench::opened(const Task& task) {
  const Contestant& who = *task.who;
  auto& found = opened_[{who.who, who.index, who.threads, task.block, task.kernel_times}];
  if (!found) {
    Options options;
    options.backend = *who.backend;
    options.device = who.index;
    if (who.backend == Backend::host) options.threads = who.threads;
    options.order = Order::fast;
    options.tuning.work_group_size = task.block;
    options.tuning.kernel_times = task.kernel_times;
    found = std::make_unique<Triangulator>(options);
  }
  return *found;
}

void Bench::use_once(const Task& task, Triangulator& triangulator, std::span<const double> xy) {
  if (!used_.insert({&triangulator, task.stabilize, task.detail, task.strategy}).second) return;
  constexpr std::size_t few = 2000;
  triangulator.options().tuning.watch = nullptr;
  static_cast<void>(triangulator.triangulate(PointsView(xy.first(std::min(xy.size(), 2 * few)))));
}

void Bench::time_cadt(const Task& task, std::optional<double> predicted, Row& row, Triangulation* mesh) {
  Triangulator& triangulator = opened(task);
  if (task.block > 0) {
    row.occupancy = triangulator.occupancy(task.block);
    if (row.occupancy && *row.occupancy <= 0.0) throw Skip(fmt::format("does not start with {} threads", task.block));
  }
  Options& options = triangulator.options();
  options.tuning.strategy = task.strategy;
  options.tuning.stabilize = task.stabilize;
  options.tuning.flip_threshold = task.threshold;
  options.tuning.quality_epsilon = task.epsilon;
  options.statistics = task.detail;
  const std::span<const double> xy = points_.get(task.set);
  const PointsView view(xy);
  use_once(task, triangulator, xy);

  std::optional<Triangulation> result;
  std::vector<Statistics> statistics;
  // Releases the memory even if a call throws: the next contestant may use the same GPU.
  struct Release {
    Triangulator& of;
    ~Release() { of.release_memory(); }
  } const release{triangulator};
  options.tuning.watch = task.watch;
  const Repeats all = repeats(task, predicted, [&] {
    result.reset();
    const Stopwatch watch;
    result.emplace(triangulator.triangulate(view));
    const double taken = watch.milliseconds();
    statistics.push_back(result->statistics());
    return taken;
  });
  set_times(row, all);
  statistics.erase(statistics.begin(), statistics.end() - static_cast<std::ptrdiff_t>(all.milliseconds.size()));
  std::vector<double> device;
  for (const Statistics& run : statistics)
    if (const auto taken = on_device(run)) device.push_back(*taken);
  if (!device.empty()) row.device_ms = median(device);
  row.phases = median_phases(statistics);
  row.kernels = median_kernels(statistics);
  row.statistics = statistics.back();
  row.triangles = result->number_of_triangles();
  row.hash = result->hash().to_string();
  if (mesh) *mesh = std::move(*result);
}

void Bench::time_sequential(const Task& task, std::optional<double> predicted, Row& row) {
  const std::span<const double> xy = points_.get(task.set);
  set_times(row, repeats(task, predicted, [&] {
              const Stopwatch watch;
              const SequentialMesh mesh = sequential_delaunay(xy);
              const double taken = watch.milliseconds();
              row.triangles = mesh.triangles.size();
              return taken;
            }));
}

void Bench::time_peer(const Task& task, std::optional<double> predicted, Row& row) {
  const Plan& plan = settings_.plan;
  // The program cannot know in advance what a call takes; the prediction can.
  const double calls = predicted ? plan.budget() / *predicted : 1e9;
  const int runs = static_cast<int>(std::clamp(calls, 1.0, static_cast<double>(plan.runs)));
  const int warm_up = calls >= 2.0 ? plan.warm_up : 0;
  const PeerResult result =
      run_peer(*task.who->peer, points_.file(task.set).string(), warm_up, runs, plan.budget() / second);
  if (result.too_slow) predictor_.give_up(key_of(*task.who), kind_of(task), task.set.points);
  if (!result.error.empty()) throw Skip(result.error);
  row.triangles = result.triangles;
  Repeats all;
  all.warmups = result.warmups;
  all.milliseconds = result.milliseconds;
  set_times(row, all);
  if (result.timing != "device") return;
  // Without the transfers to and from the GPU this is not the time of a whole call.
  row.device_ms = std::exchange(row.median_ms, std::nullopt);
  row.min_ms.reset();
  row.max_ms.reset();
}

}  // namespace cadt::bench
