// SPDX-License-Identifier: Apache-2.0
// How long a mesh in tiles takes from points in memory to triangles in memory, or to a directory, and in which phase.
#include <cadt/errors.hpp>
#include <cadt/io/generate.hpp>

#include "tiles/run.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace cadt;

void time_run(const std::string& backend, std::size_t points, std::uint64_t tile_points, unsigned workers,
              const std::string& output) {
  io::GenerateOptions generate;
  generate.n = points;
  const auto source = tiles::in_memory(io::generate("uniform", generate).xy);
  tiles::RunOptions options;
  options.tile_points = tile_points;
  Options device;
  device.backend = backend_from_string(backend);
  options.devices.assign(workers, device);
  if (output == "memory") {
    options.collect = [](tiles::NodeData&&) {};  // the next node's arrays take its place
  } else {
    options.output = output;
  }
  const auto begin = std::chrono::steady_clock::now();
  const tiles::RunResult result = tiles::run(*source, options);
  const double opened = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double all = result.sample_seconds + result.shuffle_seconds + result.nodes_seconds + result.links_seconds;
  double leaves = 0, joins = 0, download = 0, write = 0;
  for (std::uint32_t i = 0; i < result.plan.tree.size(); ++i) {
    const tiles::NodeTimes& times = result.nodes[i].times;
    (result.plan.tree.node(i).is_leaf() ? leaves : joins) += times.compute;
    download += times.download;
    write += times.write;
  }
  std::printf(
      "%s, %zu points, %zu tiles: %.3f s, %.1f million points/s (%.3f s with the opening of the devices)\n"
      "sample %.3f, shuffle %.3f, nodes %.3f, links %.3f s; of the nodes, added up: leaves %.3f, joins %.3f, "
      "download %.3f, write %.3f s\nhash %s\n",
      result.devices.front().c_str(), points, result.plan.tree.leaves().size(), all,
      static_cast<double>(points) / all / 1e6, opened, result.sample_seconds, result.shuffle_seconds,
      result.nodes_seconds, result.links_seconds, leaves, joins, download, write, result.hash.to_string().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fputs("usage: cadt-time-run BACKEND POINTS TILE_POINTS WORKERS_ON_THE_DEVICE memory|DIRECTORY\n", stderr);
    return 2;
  }
  try {
    time_run(argv[1], std::stoull(argv[2]), std::stoull(argv[3]), static_cast<unsigned>(std::stoul(argv[4])), argv[5]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
