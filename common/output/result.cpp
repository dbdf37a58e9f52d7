// SPDX-License-Identifier: Apache-2.0
#include "common/output/result.hpp"

#include <utility>

#include "common/driver/triangulation_data.hpp"
#include "common/output/renumber.hpp"

namespace cadt {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);

/// Whether the arrays of the mesh become those of the result without a second array for the canonical order: to save
/// memory, or because no pooled buffer would hold that array.
bool in_place(const Context& ctx, const Mesh& mesh) noexcept {
  return mesh.in_arrays() && (ctx.plan.compact || ctx.memory.pools(mesh.slots * word));
}

/// Writes the arrays on the device; reuses those of the mesh where possible.
void write_on_device(Context& ctx, Mesh& mesh, const Numbering& numbering, ResultArrays& result) {
  const std::size_t bytes = 3 * result.count * word;
  if (!mesh.in_arrays()) {
    result.triangles = ctx.memory.allocate(bytes);
    result.neighbors = ctx.memory.allocate(bytes);
    write_triangles(ctx, mesh, numbering, result.triangles, result.neighbors);
  } else if (!numbering.numbers) {
    write_triangles(ctx, mesh, numbering, mesh.vertices, mesh.half_edges);
    result.triangles = std::move(mesh.vertices);
    result.neighbors = std::move(mesh.half_edges);
  } else {  // one after the other, so that the second reuses the memory of the mesh's half-edges
    result.neighbors = ctx.memory.allocate(bytes);
    write_triangles(ctx, mesh, numbering, {}, result.neighbors);
    mesh.half_edges.release();
    result.triangles = ctx.memory.allocate(bytes);
    write_triangles(ctx, mesh, numbering, result.triangles, {});
  }
}

/// Writes straight to host memory; false if the device cannot.
bool write_on_host(Context& ctx, const Mesh& mesh, const Numbering& numbering, Triangulation::Data& host,
                   ResultArrays& result) {
  const std::size_t values = 3 * result.count;
  host.triangles = make_words(values);
  host.neighbors = make_words(values);
  result.triangles = ctx.memory.export_to(host.triangles.get(), values * word);
  result.neighbors = ctx.memory.export_to(host.neighbors.get(), values * word);
  result.on_host = result.triangles && result.neighbors;
  if (result.on_host) write_triangles(ctx, mesh, numbering, result.triangles, result.neighbors);
  return result.on_host;
}

}  // namespace

ResultArrays write_result(Context& ctx, Mesh mesh, std::size_t points, Triangulation::Data* host) {
  ResultArrays result;
  if (in_place(ctx, mesh)) {
    result.count = renumber_in_place(ctx, mesh, points);
    result.triangles = std::move(mesh.vertices);
    result.neighbors = std::move(mesh.half_edges);
    return result;
  }
  const Numbering numbering = renumber(ctx, mesh, points);
  result.count = numbering.triangles;
  ctx.check("output", 0.95);
  if (host == nullptr || !write_on_host(ctx, mesh, numbering, *host, result))
    write_on_device(ctx, mesh, numbering, result);
  return result;
}

}  // namespace cadt
