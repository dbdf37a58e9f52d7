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
  Run(Triangulator& t, Triangulator& j, const UniformCells& c) : triangulator(t), joiner(j), cells(c) {}
  Triangulator &triangulator, &joiner;
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

  /// The leaves of a part, or what joins of `levels` levels of halving leave of them.
  void build(unsigned depth, unsigned most, std::uint64_t index, unsigned levels, std::vector<Open>& to) {
    if (depth == most) return to.push_back(leaf(depth, index));
    std::vector<Open> children, &into = depth % levels == 0 ? children : to;
    build(depth + 1, most, 2 * index, levels, into);
    build(depth + 1, most, 2 * index + 1, levels, into);
    if (depth % levels == 0) to.push_back(join(children, cells.part(depth, index).box));
  }

  Open join(const std::vector<Open>& children, const TileBox& box) {
    const auto begin = std::chrono::steady_clock::now();
    FinishedNode node = finish_join(joiner, children, box, nodes++);
    const double seconds = seconds_since(begin);
    join_seconds += seconds;
    double device = 0;
    for (const auto& [name, milliseconds] : node.statistics.milliseconds) device += milliseconds;
    std::printf("join of %zu: %.1f ms, by phases %.1f ms\n", node.part.number_of_points(), seconds * 1e3, device);
    return keep(std::move(node));
  }
};

int run(const std::string& backend, std::uint64_t points, std::uint64_t tile_points, unsigned levels, bool host_joins,
        bool kernels) {
  Options options;
  options.backend = backend_from_string(backend);
  options.order = Order::fast;
  options.tuning.kernel_times = kernels;
  Triangulator triangulator(options);
  Options on_host = options;
  on_host.backend = Backend::host;
  Triangulator host(on_host);
  const UniformCells cells(points);
  const auto depth = cells.depth_for(tile_points);
  if (!depth) return 2;
  {  // the first call builds kernels and takes memory
    Run first(triangulator, triangulator, cells);
    (void)first.leaf(*depth, 0);
  }
  Run run(triangulator, host_joins ? host : triangulator, cells);
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Open> root;
  run.build(0, *depth, 0, levels, root);
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
  if (argc < 6) {
    std::fputs("usage: cadt-time-tiles BACKEND POINTS TILE_POINTS LEVELS_OF_A_JOIN device|host [--kernels]\n", stderr);
    return 2;
  }
  try {
    return run(argv[1], std::stoull(argv[2]), std::stoull(argv[3]), static_cast<unsigned>(std::stoul(argv[4])),
               argv[5] == std::string("host"), argc > 6);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
