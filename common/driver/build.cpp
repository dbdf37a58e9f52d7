// SPDX-License-Identifier: Apache-2.0
// From sorted points to a certified mesh: chooses the strategy and runs its stages.
#include "common/driver/build.hpp"

#include <utility>

#include "common/certify/certify.hpp"
#include "common/driver/choose_strategy.hpp"
#include "common/insertion/insertion.hpp"
#include "common/stars/mesh_from_stars.hpp"

namespace cadt {

namespace {

Mesh build_by(const BuildStrategy& how, Context& ctx, SortedPoints points, const InputPoints& input, MeshUse use) {
  switch (how.method) {
    case BuildStrategy::Method::stars:
      return mesh_from_stars(ctx, std::move(points), input, how, use);
    case BuildStrategy::Method::wrapping:
      return wrap_or_insert(ctx, std::move(points), how, use);
    case BuildStrategy::Method::insertion:
      break;
  }
  return insert_incrementally(ctx, std::move(points), use);
}

}  // namespace

Mesh build(Context& ctx, SortedPoints points, const InputPoints& input, MeshUse use) {
  const BuildStrategy how = choose_strategy(traits_of(ctx.device), ctx.options, profile_of(points));
  const std::size_t n = points.distinct;  // not the mesh's own number, which may be wrong
  Mesh mesh = build_by(how, ctx, std::move(points), input, use);
  if (use == MeshUse::constrained) return mesh;
  if (!mesh.certified) certify(ctx, mesh, n);  // insertion's last legality sweep has certified its own
  mesh.points.release();
  return mesh;
}

}  // namespace cadt
