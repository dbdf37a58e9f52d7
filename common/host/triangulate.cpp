// SPDX-License-Identifier: Apache-2.0
// The whole run: order the points, build the mesh, collect the result.
#include <string>
#include <utility>

#include "common/host/build_mesh.hpp"
#include "common/host/collect.hpp"
#include "common/host/registry.hpp"
#include "common/host/run.hpp"
#include "common/host/spatial_order.hpp"
#include "common/host/triangulation_data.hpp"

namespace cadt {
namespace {

/// Device bytes of the phase that needs most, but for crowded cells: the insertion on the host (93 a point), else the
/// collection (124). docs/performance.md has the plan.
std::size_t bytes_needed(std::size_t n, bool host) {
  constexpr std::size_t fixed = std::size_t{1} << 16;  // counters, partial results
  return fixed + n * (host ? 97 : 124);
}

}  // namespace

Triangulation triangulate(PointsView points, const Options& options) {
  if (points.size() > max_points()) {
    throw LimitError("at most " + std::to_string(max_points()) + " points can be triangulated in one call, not " +
                         std::to_string(points.size()) + ": split the input",
                     points.size(), max_points());
  }
  auto data = std::make_unique<Triangulation::Data>();
  data->points = points.size();
  Statistics& statistics = data->statistics;
  statistics.points = points.size();

  const auto device = open_device(options);
  statistics.backend = to_string(device->info().backend);
  statistics.device = device->info().name;
  statistics.threads = device->threads();
  if (points.size() == 0) return Triangulation(std::move(data));

  Run run(*device, options, statistics);
  run.memory.require(bytes_needed(points.size(), device->info().backend == Backend::host));
  run.check("sort", 0);
  SpatialOrder order = sort_points(run, points);
  statistics.distinct = order.distinct;
  statistics.wide_arithmetic = order.wide;
  const DeviceMesh mesh = build_mesh(run, order);
  order.points.release();
  if (mesh.flat) {
    data->dimension = order.distinct >= 2 ? 1 : 0;
  } else {
    data->dimension = 2;
    run.check("collect", 0.9);
    collect_mesh(run, mesh, order.labels, *data);
    run.end_phase("collect");
  }
  data->duplicates = std::move(order.duplicates);
  statistics.launches = run.launcher.launches();
  statistics.bytes_device_peak = run.memory.peak();
  run.check("collect", 1);
  return Triangulation(std::move(data));
}

}  // namespace cadt
