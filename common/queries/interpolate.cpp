// SPDX-License-Identifier: Apache-2.0
#include "common/queries/interpolate.hpp"

#include <string>

#include "common/driver/device_text.hpp"

namespace cadt {
namespace {

using namespace device_text;

void require_narrow(const QueryBatch& queries) {
  if (queries.by.wide)
    throw InputError(
        "natural neighbours need coordinates within 240 binades (a factor of 10^72 between the largest and the "
        "lowest bit): scale or round them, or take linear",
        0);
}

}  // namespace

Allocation interpolate_queries(Context& ctx, const MeshIndex& mesh, const QueryBatch& queries, const Allocation& values,
                               std::size_t per_point, Interpolation method, Outside outside,
                               const Allocation& results) {
  Launcher& launch = ctx.launcher;
  const std::size_t count = queries.count;
  if (mesh.triangles == 0) {
    launch.run<KernelId::cadt_clear_raster>(results, launch.grid(count * per_point));
    return {};
  }
  if (method == Interpolation::natural) require_narrow(queries);
  Allocation located = ctx.memory.allocate(count * word), nearest;
  if (method == Interpolation::nearest || outside == Outside::nearest) {
    const Allocation reached = ctx.memory.allocate(count * word);
    nearest = ctx.memory.allocate(count * word);
    locate_queries(ctx, mesh, queries, located, reached);
    find_nearest(ctx, mesh, queries, reached, 1, nearest);
  } else {
    const Allocation none;
    locate_queries(ctx, mesh, queries, located, none);
  }
  const LaunchGrid all = launch.grid(count);
  const QueryMesh in{mesh.view(), queries.by};
  switch (method) {
    case Interpolation::linear:
      launch.run<KernelId::cadt_interpolate_linear>(in, queries.points, queries.curve.order, located, nearest, values,
                                                    per_point, results, all);
      break;
    case Interpolation::nearest: {
      const Allocation all_of_the_plane;
      launch.run<KernelId::cadt_interpolate_nearest>(outside == Outside::nan ? located : all_of_the_plane, nearest,
                                                     values, per_point, results, all);
      break;
    }
    case Interpolation::natural: {
      const Allocation failed = launch.zeros(1);
      launch.run<KernelId::cadt_interpolate_natural>(in, queries.points, queries.curve.order, located, nearest, values,
                                                     per_point, results, failed, all);
      if (launch.read_word(failed, 0) != 0)
        throw InputError(
            "natural neighbours need a Delaunay mesh of these points: the boundary of a conflict region did "
            "not close (verify() says more)",
            0);
      break;
    }
  }
  return located;
}

}  // namespace cadt
