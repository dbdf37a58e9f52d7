// SPDX-License-Identifier: Apache-2.0
// Uploads a mesh of the host to the device and verifies it there.
#include <algorithm>
#include <utility>

#include "common/driver/registry.hpp"
#include "common/platform/parallel.hpp"
#include "common/points/device_points.hpp"
#include "common/points/import.hpp"
#include "common/verify/device/verify_on_device.hpp"
#include "common/verify/host/mesh.hpp"

namespace cadt {

using namespace verifier;

VerifyReport verify_on_device(Device& device, PointsView points, const MeshView& mesh, const Options& run_options,
                              const VerifyOptions& options) {
  // With nothing to examine, or no triangles, there is no work for a device; without double precision there is none
  // that it can do.
  if (!size_error(points, mesh).empty() || mesh.triangles.empty() || points.size() == 0 || takes_floats_only(device))
    return verify(points, mesh, options);
  verifier::Mesh known;
  known.points = points;
  known.count = mesh.triangles.size() / 3;
  known.triangles = mesh.triangles;
  known.neighbors = mesh.neighbors;
  known.edge_flags = mesh.edge_flags;
  known.threads = platform::threads_or_all(options.threads);
  if (mesh.neighbors.empty()) {
    Check check;
    std::uint64_t examined = 0;
    check_range(known, check);
    if (check.passed) derive_neighbors(known, check, examined);
    if (!check.passed) return verify(points, mesh, options);
    known.neighbors = known.derived;
  }
  Statistics statistics;
  Memory memory(device, false);
  memory.begin(run_options.max_memory, false);
  Context ctx(device, memory, run_options, statistics);
  ctx.check("verify", 0);
  const Allocation device_points = import_points(ctx, points);
  const Allocation triangles = ctx.memory.import(known.triangles.data(), known.triangles.size_bytes());
  const Allocation neighbors = ctx.memory.import(known.neighbors.data(), known.neighbors.size_bytes());
  Allocation flags;
  if (!known.edge_flags.empty()) flags = ctx.memory.import(known.edge_flags.data(), known.edge_flags.size_bytes());
  const auto count = static_cast<std::uint32_t>(known.count);
  const VerifyInput input{{device_points, triangles, neighbors, flags, count, count, 0},
                          points.size(),
                          mesh.hull,
                          mesh.duplicates,
                          mesh.has_duplicates};
  return verify_on_device(ctx, input, options, std::move(known));
}

VerifyReport verify_on_device(PointsView points, const MeshView& mesh, const Options& device,
                              const VerifyOptions& options) {
  return verify_on_device(*open_device(device), points, mesh, device, options);
}

VerifyReport verify_on_device(PointsView points, const Triangulation& mesh, const Options& device,
                              const VerifyOptions& options) {
  VerifyReport report = verify_on_device(points, view_of(mesh), device, options);
  check_own_result(points, mesh, report);
  return report;
}

}  // namespace cadt
