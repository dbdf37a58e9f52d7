// SPDX-License-Identifier: Apache-2.0
// Leaves: the points of a tile alone.
#include <cadt/finalization.hpp>

#include <algorithm>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/finalization/finish.hpp"
#include "common/points/bounds.hpp"
#include "common/points/import.hpp"

namespace cadt {

using namespace device_text;
using namespace finalization;

namespace {

void require_in_box(const Bounds& bounds, const TileBox& box) {
  if (box.contains(bounds.min_x, bounds.min_y) && box.contains(bounds.max_x, bounds.max_y)) return;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "the points of the tile, x " << bounds.min_x << " to " << bounds.max_x << " and y " << bounds.min_y << " to "
       << bounds.max_y << ", leave its box, x from " << box.min_x << " to below " << box.max_x << " and y from "
       << box.min_y << " to below " << box.max_y << ": give each point to the tile that contains it";
  throw InputError(text.str(), 0);
}

std::vector<DuplicateId> duplicate_ids(Context& ctx, const Node& node) {
  const std::size_t count = node.mesh->duplicate_count;
  std::vector<DuplicateId> result(count);
  if (count == 0) return result;
  const auto ids_of = [&](const Allocation& points) {
    const Allocation ids = ctx.memory.allocate(count * id_bytes);
    ctx.launcher.run<KernelId::cadt_gather_ids>(node.data->ids, points, ids, ctx.launcher.grid(count));
    return ctx.device.read_values<std::uint64_t>(*ids, count);
  };
  const auto points = ids_of(node.mesh->duplicate_points), equal = ids_of(node.mesh->representatives);
  for (std::size_t i = 0; i < count; ++i) result[i] = {points[i], equal[i]};
  return result;
}

/// `import`: gives the node its points and ids.
template <class Import>
FinishedNode finish(Node node, const Import& import) {
  DevicePart::Data& data = *node.data;
  const std::size_t n = data.point_count;
  Triangulator::State& state = *data.state;
  if (n != 0) {
    state.device->begin_call();
    Call call(state, n, 0);
    import(call.ctx);
    node.bounds = find_bounds(call.ctx, data.points, n, call.ctx.memory.allocate(CADT_ORDER_WORDS * word));
    require_in_box(node.bounds, node.box);
    require_ascending(call.ctx, data.ids, n);
  }
  triangulate_node(node);
  Call call(state, n, share_of_mesh);
  Finished finished = take_final(call, node);
  FinishedNode& result = finished.node;
  result.links.assign(finished.rows.size(), pending_triangle);
  result.open.sides.reserve(finished.rows.size());
  for (std::size_t row = 0; row < finished.rows.size(); ++row)
    result.open.sides.push_back(side_of(finished, node, row));
  result.duplicates = duplicate_ids(call.ctx, node);
  add_sums(call, finished, node, 0, 0);
  NodeSums& sums = result.sums;
  sums.points = n;
  sums.distinct = node.mesh->distinct;
  cadt_hash hash = {0, 0};
  for (const DuplicateId& d : result.duplicates)
    cadt_hash_add(&hash, CADT_HASH_DUPLICATE, d.point, d.representative, 0);
  sums.hash = {hash.high, hash.low};
  result.part = DevicePart(std::move(node.data));
  return std::move(result);
}

}  // namespace

FinishedNode finish_leaf(Triangulator& triangulator, PointsView points, std::span<const std::uint64_t> ids,
                         const TileBox& box, std::uint32_t node) {
  if (ids.size() != points.size())
    throw InputError(std::to_string(ids.size()) + " ids for " + std::to_string(points.size()) + " points",
                     std::min(ids.size(), points.size()));
  Node opened = open_node(triangulator, points.size(), box, node);
  DevicePart::Data& data = *opened.data;
  return finish(std::move(opened), [&](Context& ctx) {
    data.points = import_points(ctx, points);
    data.ids = ctx.memory.import(ids.data(), ids.size_bytes());
  });
}

FinishedNode finish_leaf(Triangulator& triangulator, const DevicePoints& points, const DeviceIds& ids,
                         const TileBox& box, std::uint32_t node) {
  Node opened = open_node(triangulator, points.size, box, node);
  DevicePart::Data& data = *opened.data;
  return finish(std::move(opened), [&](Context& ctx) {
    data.points = import_points(ctx, points);
    if (ids.memory != nullptr) {
      data.ids = ctx.memory.wrap(const_cast<void*>(ids.memory), points.size * id_bytes);
      return;
    }
    data.ids = ctx.memory.allocate(points.size * id_bytes);
    ctx.launcher.run<KernelId::cadt_number_ids>(data.ids, static_cast<std::uint32_t>(ids.first),
                                                static_cast<std::uint32_t>(ids.first >> 32),
                                                ctx.launcher.grid(points.size));
  });
}

}  // namespace cadt
