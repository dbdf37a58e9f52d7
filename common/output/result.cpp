// SPDX-License-Identifier: Apache-2.0
#include "common/output/result.hpp"

#include <utility>

#include "common/output/renumber.hpp"

namespace cadt {
namespace {

using device_text::word;

/// Below, a few launches take longer than memory is worth.
constexpr std::size_t small = std::size_t{1} << 18;

/// Whether the arrays of the mesh become those of the result: in the fast order, with the compact plan, or where cached
/// buffers leave no memory for a second array.
bool in_place(const Context& ctx, const Mesh& mesh) noexcept {
  if (ctx.options.order == Order::fast || ctx.plan.compact) return true;
  return !mesh.vertices.host && ctx.memory.caches() && mesh.all * word >= small;
}

}  // namespace

ResultArrays write_result(Context& ctx, Mesh mesh, std::size_t points) {
  ResultArrays result;
  result.count = mesh.triangles;
  if (in_place(ctx, mesh)) {
    renumber_in_place(ctx, mesh, points);
    result.triangles = std::move(mesh.vertices);
    result.neighbors = std::move(mesh.across);
    result.edge_flags = std::move(mesh.edge_flags);
    return result;
  }
  const Allocation numbers = number_triangles(ctx, mesh, points), none;
  ctx.check("output", 0.95);
  // one after the other, so that the second reuses the memory of one of the mesh's
  result.neighbors = make_mesh_array(ctx, result.count, MeshUse::whole);
  write_triangles(ctx, mesh, numbers, {none, result.neighbors.device, none});
  mesh.across.release();
  result.triangles = make_mesh_array(ctx, result.count, MeshUse::whole);
  if (mesh.edge_flags) result.edge_flags = ctx.memory.allocate(result.count * word);
  write_triangles(ctx, mesh, numbers, {result.triangles.device, none, result.edge_flags});
  return result;
}

}  // namespace cadt
