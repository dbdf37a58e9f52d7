// SPDX-License-Identifier: Apache-2.0
// Large sets on a GPU: the time from points on the device to triangles and neighbours on the device, and the check of
// the mesh; or whole calls from host memory to host memory. One line a run. Needs nothing but the library.
#include <cadt/cadt.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/system/resident/device_memory.hpp"

namespace {

using namespace cadt;

struct Arguments {
  std::size_t points = 1'000'000, sets = 0, most_bytes = 0;
  std::string backend = "cuda", device, kind = "uniform", file, verify = "none";
  int runs = 10, warm_up = 3;
  unsigned block = 0;
  std::optional<Order> order;  ///< of the run's kind
  Strategy strategy = Strategy::automatic;
  Stabilize stabilize = Stabilize::off;
  StatisticsDetail statistics = StatisticsDetail::counters;
  bool phases = false, kernels = false, hash = false, floats = false, host_to_host = false;
};

[[noreturn]] void usage() {
  std::fputs(
      "usage: cadt-check-gpu [--points N] [--backend cuda|opencl|host] [--device D]\n"
      "                      [--kind uniform|circles|gaussian|lattice] [--file FILE] [--runs R] [--warm-up W] [--block "
      "B]\n"
      "                      [--order fast|canonical] [--verify none|host|device] [--phases] [--kernel-times] "
      "[--hash]\n"
      "                      [--strategy auto|locks|stars] [--stabilize off|defer|paper]\n"
      "                      [--statistics none|counters|timing] [--sets S] [--floats] [--most-bytes B]\n"
      "                      [--host-to-host]\n"
      "--sets: the points are those of S sets of the same size, in one call\n"
      "--floats: the points as floats; --most-bytes: Options::max_memory, a point\n"
      "--file: points as raw 64-bit numbers x0 y0 x1 y1 ... (cadt generate NAME -t f64)\n"
      "--host-to-host: from the caller's pageable memory to a new Triangulation, in the canonical order unless "
      "--order\n"
      "otherwise prints the median time (and the least and the most) from points on the device to a mesh on the "
      "device\n",
      stderr);
  std::exit(2);
}

template <class Value>
Value named(const std::string& name, std::initializer_list<Value> values) {
  for (const Value one : values)
    if (to_string(one) == name) return one;
  usage();
}

Arguments parse(int count, char** values) {
  Arguments a;
  if (const char* chosen = std::getenv("CADT_TEST_OPENCL_DEVICE"); chosen != nullptr) a.device = chosen;
  const std::vector<std::string> words(values + 1, values + count);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto value = [&] {
      if (++i == words.size()) usage();
      return words[i];
    };
    if (words[i] == "--points")
      a.points = std::stoul(value());
    else if (words[i] == "--sets")
      a.sets = std::stoul(value());
    else if (words[i] == "--backend")
      a.backend = value();
    else if (words[i] == "--device")
      a.device = value();
    else if (words[i] == "--kind")
      a.kind = value();
    else if (words[i] == "--file")
      a.file = value();
    else if (words[i] == "--runs")
      a.runs = std::stoi(value());
    else if (words[i] == "--warm-up")
      a.warm_up = std::stoi(value());
    else if (words[i] == "--block")
      a.block = static_cast<unsigned>(std::stoul(value()));
    else if (words[i] == "--order")
      a.order = value() == "canonical" ? Order::canonical : Order::fast;
    else if (words[i] == "--strategy")
      a.strategy = named(value(), {Strategy::automatic, Strategy::locks, Strategy::stars});
    else if (words[i] == "--stabilize")
      a.stabilize = named(value(), {Stabilize::off, Stabilize::defer, Stabilize::paper});
    else if (words[i] == "--statistics")
      a.statistics = named(value(), {StatisticsDetail::none, StatisticsDetail::counters, StatisticsDetail::timing});
    else if (words[i] == "--verify")
      a.verify = value();
    else if (words[i] == "--phases")
      a.phases = true;
    else if (words[i] == "--kernel-times")
      a.kernels = true;
    else if (words[i] == "--hash")
      a.hash = true;
    else if (words[i] == "--floats")
      a.floats = true;
    else if (words[i] == "--host-to-host")
      a.host_to_host = true;
    else if (words[i] == "--most-bytes")
      a.most_bytes = std::stoul(value());
    else
      usage();
  }
  return a;
}

/// A number in [0, 1) from a counter: the same on every machine (S. Vigna's mixing function of SplitMix64).
double uniform(std::uint64_t i) {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

std::vector<double> make_points(const std::string& kind, std::size_t n) {
  std::vector<double> xy(2 * n);
  if (kind == "uniform") {
    for (std::size_t i = 0; i < 2 * n; ++i) xy[i] = uniform(i);
  } else if (kind == "circles") {  // the paper's perturbed circles: k = 8, r = 0.35 cells, eps = 1e-4 cells
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n) / 8)));
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t cell = i / 8;
      const double angle = 0.78539816339744831 * static_cast<double>(i % 8);
      xy[2 * i] = static_cast<double>(cell % columns) + 0.35 * std::cos(angle) + 1e-4 * (2 * uniform(2 * i) - 1);
      xy[2 * i + 1] =
          static_cast<double>(cell / columns) + 0.35 * std::sin(angle) + 1e-4 * (2 * uniform(2 * i + 1) - 1);
    }
  } else if (kind == "gaussian") {
    for (std::size_t i = 0; i < n; ++i) {
      const double radius = std::sqrt(-2 * std::log(1 - uniform(2 * i))),
                   angle = 6.2831853071795865 * uniform(2 * i + 1);
      xy[2 * i] = radius * std::cos(angle);
      xy[2 * i + 1] = radius * std::sin(angle);
    }
  } else if (kind == "lattice") {
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n))));
    for (std::size_t i = 0; i < n; ++i) {
      xy[2 * i] = static_cast<double>(i % columns);
      xy[2 * i + 1] = static_cast<double>(i / columns);
    }
  } else {
    usage();
  }
  return xy;
}

std::vector<double> read_points(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto bytes = static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0));
  std::vector<double> xy(bytes / (2 * sizeof(double)) * 2);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(xy.data()), static_cast<std::streamsize>(xy.size() * sizeof(double)));
  if (!file || xy.empty()) throw std::runtime_error("no points can be read from " + path);
  return xy;
}

int chosen_device(Backend backend, const std::string& name) {
  const bool number = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
  int any = -1;
  for (const DeviceInfo& info : list_devices()) {
    if (info.backend != backend || info.index < 0 || !info.usable) continue;
    const bool fits = number ? std::to_string(info.index) == name : info.name.find(name) != std::string::npos;
    if (name.empty() ? info.gpu : fits) return info.index;
    if (any < 0 && name.empty()) any = info.index;
  }
  return any;
}

double now() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Sets of the same size in one call. The meshes are checked on the host.
int run_sets(const Arguments& a, Triangulator& triangulator, test::DeviceMemory* memory, const DevicePoints& points,
             const std::vector<double>& xy) {
  std::vector<std::size_t> offsets(a.sets + 1);
  const std::size_t n = xy.size() / 2;
  for (std::size_t s = 0; s <= a.sets; ++s) offsets[s] = n / a.sets * s + n % a.sets * s / a.sets;
  DeviceTriangulationBatch batch;
  std::vector<double> times;
  for (int r = 0; r < a.warm_up + a.runs; ++r) {
    batch = DeviceTriangulationBatch();
    const double begin = now();
    batch = triangulator.triangulate_batch(points, offsets);
    if (memory != nullptr) memory->wait();
    if (r >= a.warm_up) times.push_back(now() - begin);
  }
  std::sort(times.begin(), times.end());
  const Statistics& s = batch.statistics();
  std::printf(
      "%s %zu in %zu sets %s '%s': %.3f ms (%.3f to %.3f), %zu triangles, %.1f bytes a point, %llu together, "
      "%llu proven, %llu wrapped",
      a.kind.c_str(), n, a.sets, a.backend.c_str(), s.device.c_str(), times[times.size() / 2], times.front(),
      times.back(), batch.triangle_offsets().back(), static_cast<double>(s.bytes_device_peak) / static_cast<double>(n),
      static_cast<unsigned long long>(s.batched_sets), static_cast<unsigned long long>(s.proven_stars),
      static_cast<unsigned long long>(s.wrapped_stars));
  if (a.phases) {
    std::printf("\n   ");
    for (const auto& [name, ms] : s.milliseconds) std::printf(" %s %.2f", name.c_str(), ms);
  }
  std::size_t wrong = 0, checked = 0;
  if (a.verify == "host" || a.hash) {
    const TriangulationBatch copy = batch.download();
    for (std::size_t set = 0; set < a.sets; ++set, ++checked) {
      const auto part = std::span(xy).subspan(2 * offsets[set], 2 * (offsets[set + 1] - offsets[set]));
      if (!verify(part, copy.triangulation(set)).ok) ++wrong;
    }
    std::printf(", %zu checked, %zu wrong", checked, wrong);
  }
  std::printf("\n");
  return wrong == 0 ? 0 : 1;
}

/// Medians of the phases of all runs. Some names come twice.
class Phases {
 public:
  void add(const Statistics& statistics) {
    names_.clear();
    for (const auto& [name, ms] : statistics.milliseconds) {
      names_.push_back(name);
      runs_.resize(std::max(runs_.size(), names_.size()));
      runs_[names_.size() - 1].push_back(ms);
    }
  }
  void print() {
    std::printf("\n   ");
    for (std::size_t i = 0; i < names_.size(); ++i) {
      auto& list = runs_[i];
      std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2), list.end());
      std::printf(" %s %.2f", names_[i].c_str(), list[list.size() / 2]);
    }
  }

 private:
  std::vector<std::vector<double>> runs_;
  std::vector<std::string> names_;
};

/// Whole calls: points in pageable memory of the host, a new Triangulation. The one before is destroyed outside of the
/// time. The first call is named as well: it makes what later ones reuse.
int run_from_host(const Arguments& a, const Options& options, PointsView points) {
  const double before = now();
  Triangulator triangulator(options);
  const double opened = now();
  Triangulation mesh;
  std::vector<double> times;
  Phases phases;
  double first = 0;
  for (int r = 0; r < a.warm_up + a.runs; ++r) {
    mesh = Triangulation();
    const double begin = now();
    mesh = triangulator.triangulate(points);
    const double took = now() - begin;
    if (r == 0) first = took;
    if (r < a.warm_up) continue;
    times.push_back(took);
    phases.add(mesh.statistics());
  }
  std::sort(times.begin(), times.end());
  std::printf("%s %zu %s '%s' host to host: %.3f ms (%.3f to %.3f), opened in %.1f, first call %.1f, %zu triangles",
              (a.file.empty() ? a.kind : a.file).c_str(), points.size(), a.backend.c_str(),
              mesh.statistics().device.c_str(), times[times.size() / 2], times.front(), times.back(), opened - before,
              first, mesh.number_of_triangles());
  if (a.phases) phases.print();
  if (a.hash) std::printf(", %s", mesh.hash().to_string().c_str());
  bool ok = true;
  if (a.verify != "none") {
    const VerifyReport report = verify(points, mesh);
    ok = report.ok;
    std::printf(", %s", report.summary().c_str());
  }
  std::printf("\n");
  return ok ? 0 : 1;
}

int run(const Arguments& a) {
  std::vector<double> xy = a.file.empty() ? make_points(a.kind, a.points) : read_points(a.file);
  const std::vector<float> single(xy.begin(), a.floats ? xy.end() : xy.begin());
  if (a.floats) xy.assign(single.begin(), single.end());
  const std::size_t n = xy.size() / 2;
  Options options;
  options.backend = backend_from_string(a.backend);
  options.order = a.order.value_or(a.host_to_host ? Order::canonical : Order::fast);
  options.tuning.work_group_size = a.block;
  options.tuning.strategy = a.strategy;
  options.tuning.stabilize = a.stabilize;
  options.statistics = a.statistics;
  options.tuning.kernel_times = a.kernels;
  std::unique_ptr<test::DeviceMemory> memory;
  options.max_memory = a.most_bytes * n;
  if (a.host_to_host) {
    options.device = options.backend == Backend::opencl ? a.device : std::string();
    return a.floats ? run_from_host(a, options, std::span<const float>(single))
                    : run_from_host(a, options, std::span<const double>(xy));
  }
  const void* points = a.floats ? static_cast<const void*>(single.data()) : xy.data();
  if (options.backend != Backend::host) {
    const int device = chosen_device(options.backend, options.backend == Backend::opencl ? a.device : std::string());
    if (device < 0) {
      std::fprintf(stderr, "cadt-check-gpu: no usable %s device\n", a.backend.c_str());
      return 2;
    }
    memory = options.backend == Backend::cuda ? test::cuda_memory(device) : test::opencl_memory(device);
    points = a.floats ? memory->upload(std::span<const float>(single)) : memory->upload(std::span<const double>(xy));
    options.queue = memory->queue();
  }
  const DevicePoints input{.x = points, .size = n, .scalar = a.floats ? Scalar::float32 : Scalar::float64};
  Triangulator triangulator(options);
  if (a.sets != 0) return run_sets(a, triangulator, memory.get(), input, xy);
  DeviceTriangulation mesh;
  std::vector<double> times;
  Phases phases;
  for (int r = 0; r < a.warm_up + a.runs; ++r) {
    mesh = DeviceTriangulation();
    const double begin = now();
    mesh = triangulator.triangulate(input);
    if (memory) memory->wait();
    if (r < a.warm_up) continue;
    times.push_back(now() - begin);
    phases.add(mesh.statistics());
  }
  std::sort(times.begin(), times.end());
  const Statistics& s = mesh.statistics();
  std::printf("%s %zu %s '%s': %.3f ms (%.3f to %.3f), %zu triangles, %.1f bytes a point",
              (a.file.empty() ? a.kind : a.file).c_str(), n, a.backend.c_str(), s.device.c_str(),
              times[times.size() / 2], times.front(), times.back(), mesh.number_of_triangles(),
              static_cast<double>(s.bytes_device_peak) / static_cast<double>(n));
  if (a.phases) {
    phases.print();
    const auto all = static_cast<double>(n);
    std::printf(
        " | a point: steps %.2f flips %.2f failed locks %.3f | deferred %llu + %llu, launches %llu, sweeps %llu, "
        "repairs %llu",
        static_cast<double>(s.walk_steps) / all, static_cast<double>(s.flips) / all,
        static_cast<double>(s.lock_failures) / all, static_cast<unsigned long long>(s.deferred_points),
        static_cast<unsigned long long>(s.deferred_edges), static_cast<unsigned long long>(s.launches),
        static_cast<unsigned long long>(s.legality_sweeps), static_cast<unsigned long long>(s.sweep_repairs));
    std::printf(", tiles %llu, unproven %llu, wrapped %llu, refined %llu, exact %llu + %llu",
                static_cast<unsigned long long>(s.tiles), static_cast<unsigned long long>(s.distinct - s.proven_stars),
                static_cast<unsigned long long>(s.wrapped_stars), static_cast<unsigned long long>(s.refined_points),
                static_cast<unsigned long long>(s.exact_orientations),
                static_cast<unsigned long long>(s.exact_incircles));
    for (const auto& [name, share] : s.thread_time) std::printf(" %s %.3f", name.c_str(), share);
    std::printf(", flips:");
    for (const std::uint64_t edges : s.flips_per_edge) std::printf(" %llu", static_cast<unsigned long long>(edges));
    std::printf(", stabilised %llu illegal %llu invalid %llu, occupancy",
                static_cast<unsigned long long>(s.stabilized_edges), static_cast<unsigned long long>(s.illegal_edges),
                static_cast<unsigned long long>(s.invalid_restarts));
    for (const unsigned block : {32U, 64U, 128U, 256U, 512U, 1024U})
      std::printf(" %u: %.3f", block, triangulator.occupancy(block).value_or(-1));
  }
  for (const KernelTime& kernel : s.kernels)
    std::printf("\n    %s %llu x, %.3f ms", kernel.name.c_str(), static_cast<unsigned long long>(kernel.launches),
                kernel.milliseconds);
  bool ok = true;
  if (a.verify == "device") {
    const double begin = now();
    const VerifyReport report = triangulator.verify(input, mesh);
    ok = report.ok;
    std::printf(", verified on the device in %.1f ms: %s (signs: %llu by the filter, %llu exact, %llu on the host)",
                now() - begin, report.summary().c_str(), static_cast<unsigned long long>(report.signs_filtered),
                static_cast<unsigned long long>(report.signs_exact),
                static_cast<unsigned long long>(report.signs_on_host));
  }
  if (a.hash || a.verify == "host") {
    const Triangulation copy = mesh.download();
    if (a.hash) std::printf(", %s", copy.hash().to_string().c_str());
    if (a.verify == "host") {
      const VerifyReport report = verify(xy, copy);
      ok = report.ok;
      std::printf(", %s", report.summary().c_str());
    }
  }
  std::printf("\n");
  return ok ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  try {
    return run(parse(count, values));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cadt-check-gpu: %s\n", error.what());
    return 1;
  }
}
