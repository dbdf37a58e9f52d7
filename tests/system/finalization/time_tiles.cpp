// SPDX-License-Identifier: Apache-2.0
// Times of leaves and joins on large sets that are made on the device, and how many vertices stay open. One line a
// node, and the share of the kernels that finish.
#include <cadt/cadt.hpp>
#include <cadt/finalization.hpp>
#include <cadt/uniform_cells.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace cadt;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

struct Run {
  explicit Run(Triangulator& t, const UniformCells& c) : triangulator(t), cells(c) {}
  Triangulator& triangulator;
  const UniformCells& cells;
  NodeSums sums;
  std::uint32_t nodes = 0;
  double leaf_seconds = 0, join_seconds = 0, generate_seconds = 0, hash_seconds = 0;
  std::map<std::string, double> kernels;

  Open keep(FinishedNode node) {
    for (const KernelTime& k : node.statistics.kernels) kernels[k.name] += k.milliseconds;
    const auto begin = std::chrono::steady_clock::now();
    const Hash128 hash = node.part.hash();
    hash_seconds += seconds_since(begin);
    node.sums.hash.high += hash.high;
    node.sums.hash.low += hash.low;
    sums += node.sums;
    return std::move(node.open);
  }

  Open leaf(unsigned depth, std::uint64_t index) {
    const UniformCells::Part part = cells.part(depth, index);
    auto begin = std::chrono::steady_clock::now();
    const std::shared_ptr<void> xy = triangulator.allocate(part.count * 2 * sizeof(double));
    cells.generate(triangulator, part.first, part.count, {xy.get(), 2 * part.count});
    generate_seconds += seconds_since(begin);
    begin = std::chrono::steady_clock::now();
    FinishedNode node = finish_leaf(triangulator, DevicePoints{.x = xy.get(), .size = part.count},
                                    {.first = part.first}, part.box, nodes++);
    const double seconds = seconds_since(begin);
    leaf_seconds += seconds;
    if (nodes < 6)
      std::printf("leaf of %llu: %.1f ms, %zu open (%.2f sqrt n), %zu sides\n",
                  static_cast<unsigned long long>(part.count), seconds * 1e3, node.open.ids.size(),
                  static_cast<double>(node.open.ids.size()) / std::sqrt(static_cast<double>(part.count)),
                  node.open.sides.size());
    return keep(std::move(node));
  }

  Open build(unsigned depth, unsigned most, std::uint64_t index) {
    if (depth == most) return leaf(depth, index);
    std::vector<Open> children;
    children.push_back(build(depth + 1, most, 2 * index));
    children.push_back(build(depth + 1, most, 2 * index + 1));
    const auto begin = std::chrono::steady_clock::now();
    FinishedNode node = finish_join(triangulator, children, cells.part(depth, index).box, nodes++);
    const double seconds = seconds_since(begin);
    join_seconds += seconds;
    if (depth <= 1 || nodes < 6) std::printf("join of %zu: %.1f ms\n", node.part.number_of_points(), seconds * 1e3);
    return keep(std::move(node));
  }
};

int run(const std::string& backend, std::uint64_t points, std::uint64_t tile_points, bool kernels) {
  Options options;
  options.backend = backend_from_string(backend);
  options.order = Order::fast;
  options.tuning.kernel_times = kernels;
  Triangulator triangulator(options);
  const UniformCells cells(points);
  const auto depth = cells.depth_for(tile_points);
  if (!depth) return 2;
  {  // the first call builds kernels and takes memory
    Run first(triangulator, cells);
    (void)first.leaf(*depth, 0);
  }
  Run run(triangulator, cells);
  const auto begin = std::chrono::steady_clock::now();
  (void)run.build(0, *depth, 0);
  const double all = seconds_since(begin);
  require_complete(run.sums);
  std::printf(
      "%s, %llu points in %llu tiles: %.3f s, %.1f million points/s; generate %.3f, leaves %.3f, joins %.3f, "
      "hash %.3f s\n%llu triangles, %llu edges examined, hash %s\n",
      triangulator.device().name.c_str(), static_cast<unsigned long long>(points),
      static_cast<unsigned long long>(std::uint64_t{1} << *depth), all, static_cast<double>(points) / all / 1e6,
      run.generate_seconds, run.leaf_seconds, run.join_seconds, run.hash_seconds,
      static_cast<unsigned long long>(run.sums.triangles), static_cast<unsigned long long>(run.sums.certified_edges),
      hash_of(run.sums).to_string().c_str());
  for (const auto& [name, milliseconds] : run.kernels) std::printf("  %-28s %10.2f ms\n", name.c_str(), milliseconds);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: cadt-time-tiles BACKEND POINTS TILE_POINTS [--kernels]\n", stderr);
    return 2;
  }
  try {
    return run(argv[1], std::stoull(argv[2]), std::stoull(argv[3]), argc > 4);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
