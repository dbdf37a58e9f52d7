// SPDX-License-Identifier: Apache-2.0
// Joins: what is open in the children, among itself.
#include <cadt/finalization.hpp>

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/finalization/finish.hpp"
#include "common/points/bounds.hpp"
#include "common/queries/call.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt {

using namespace device_text;
using namespace finalization;

namespace {

/// The open vertices of all children by id, and their sides by index of these.
struct Merged {
  std::vector<double> xy;
  std::vector<std::uint64_t> ids;
  std::vector<OpenSide> sides;
};

Merged merge(std::span<const Open> children) {
  std::size_t count = 0, side_count = 0;
  for (const Open& child : children) count += child.ids.size(), side_count += child.sides.size();
  if (count > max_points())
    throw LimitError(std::to_string(count) + " vertices are open in a join, more than " + std::to_string(max_points()) +
                         ": most circles are larger than the tiles, as those of points on one circle; take fewer "
                         "points",
                     count, max_points());
  std::vector<std::uint64_t> ids;
  std::vector<double> xy;
  ids.reserve(count);
  xy.reserve(2 * count);
  for (const Open& child : children) {
    ids.insert(ids.end(), child.ids.begin(), child.ids.end());
    xy.insert(xy.end(), child.xy.begin(), child.xy.end());
  }
  if (xy.size() != 2 * count) throw InputError("the open vertices of a child have not two coordinates each", 0);
  std::vector<std::uint32_t> order(count), place(count);
  std::iota(order.begin(), order.end(), 0U);
  const auto by_id = [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; };
  std::ptrdiff_t done = 0;
  for (const Open& child : children) {
    const auto size = static_cast<std::ptrdiff_t>(child.ids.size());
    std::inplace_merge(order.begin(), order.begin() + done, order.begin() + done + size, by_id);
    done += size;
  }
  Merged result;
  result.ids.reserve(count);
  result.xy.reserve(2 * count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t from = order[i];
    place[from] = i;
    result.ids.push_back(ids[from]);
    result.xy.insert(result.xy.end(), {xy[2 * from], xy[2 * from + 1]});
    if (i != 0 && result.ids[i - 1] >= result.ids[i])
      throw InputError("two children have an open vertex with the same id, or ids do not ascend", i);
  }
  result.sides.reserve(side_count);
  std::size_t offset = 0;
  for (const Open& child : children) {
    for (OpenSide side : child.sides) {
      if (side.from >= child.ids.size() || side.to >= child.ids.size() || side.from == side.to)
        throw InputError("a side of a child is not one between two of its open vertices", result.sides.size());
      side.from = place[offset + side.from];
      side.to = place[offset + side.to];
      result.sides.push_back(side);
    }
    offset += child.ids.size();
  }
  return result;
}

/// Which triangles the children cover (common/stars/stitch.dev.h).
Cover find_cover(Context& ctx, const Node& node, const std::vector<OpenSide>& sides) {
  Launcher& launch = ctx.launcher;
  const std::size_t count = node.mesh->triangle_count;
  const LaunchGrid inner = launch.grid(count);
  // A side is an open triangle: its first vertex, which is closed, is not known here.
  std::vector<std::uint32_t> corners, list(sides.size());
  corners.reserve(3 * sides.size());
  for (const OpenSide& side : sides) corners.insert(corners.end(), {CADT_NONE, side.from, side.to});
  std::iota(list.begin(), list.end(), 0U);
  std::vector<std::uint32_t> positions(node.data->point_count);
  std::iota(positions.begin(), positions.end(), 0U);
  const auto upload = [&](const std::vector<std::uint32_t>& words) {
    Allocation memory = ctx.memory.allocate(std::max<std::size_t>(words.size(), 1) * word);
    if (!words.empty()) ctx.device.write(*memory, 0, words.data(), words.size() * word);
    return memory;
  };
  const Allocation open_triangles = upload(corners), open_list = upload(list), identity = upload(positions);
  const std::size_t places = std::bit_ceil(2 * sides.size() + 2), mask = places - 1;
  const Allocation table = ctx.memory.allocate(places * word);
  ctx.device.fill(*table, 0, places * word, CADT_NONE);
  launch.run<KernelId::cadt_stitch_enter>(open_triangles, open_list, launch.grid(sides.size()), table, mask);

  Cover cover;
  cover.half_edges = ctx.memory.allocate(3 * count * word);
  launch.run<KernelId::cadt_half_edges_of>(inner.items, node.view(), inner.grain, cover.half_edges);
  // Triangle `count` is outside of the hull.
  cover.covers = ctx.memory.allocate(3 * (count + 1) * word);
  ctx.device.fill(*cover.covers, 3 * count * word, 3 * word, CADT_NONE);
  const Allocation roots = ctx.memory.allocate((count + 1) * word), none;
  ctx.device.fill(*roots, count * word, word, static_cast<std::uint32_t>(count));
  const auto all = static_cast<std::uint32_t>(count);
  const DeviceMeshView mesh{none, node.mesh->triangles, cover.half_edges, none, all, all, 2};
  launch.run<KernelId::cadt_stitch_cover>(inner.items, mesh, open_triangles, identity, inner.grain, table, mask,
                                          cover.covers, roots);
  launch.run<KernelId::cadt_stitch_components>(inner.items, mesh, inner.grain, cover.covers, roots);
  const Allocation hidden = launch.zeros(count + 1);
  const LaunchGrid outer = launch.grid(count + 1);
  launch.run<KernelId::cadt_stitch_hide>(cover.covers, roots, outer, hidden);
  cover.kept = ctx.memory.allocate((count + 2) * word);
  launch.run<KernelId::cadt_stitch_flags>(roots, hidden, outer, cover.kept);
  if (launch.read_word(cover.kept, count) != 1)
    give_up("the children of node ", node.number, " cover what is outside of the hull of their open vertices");
  return cover;
}

/// What CADT_MATCH_WORDS say of a side.
struct Match {
  std::uint32_t kind, with, apex;
};

std::vector<Match> match_sides(Context& ctx, const Node& node, const Allocation& places, std::size_t count) {
  static_assert(sizeof(Match) == CADT_MATCH_WORDS * word);
  if (count == 0) return {};
  const Allocation matches = ctx.memory.allocate(count * sizeof(Match));
  ctx.device.fill(*matches, 0, count * sizeof(Match), CADT_NONE);
  const LaunchGrid all = ctx.launcher.grid(node.mesh->triangle_count);
  ctx.launcher.run<KernelId::cadt_match_sides>(all.items, node.view(), node.cover.half_edges, node.cover.covers, places,
                                               all.grain, matches);
  return ctx.device.read_values<Match>(*matches, count);
}

/// What lies across the sides of the children, and the certificates of these edges.
class Settlement {
 public:
  Settlement(const Node& node, const Merged& merged, Finished& finished)
      : node_(node), merged_(merged), finished_(finished) {}

  void settle(const std::vector<Match>& matches) {
    for (std::size_t i = 0; i < matches.size(); ++i) settle(i, matches[i], matches);
    std::size_t covered_rows = 0;
    finished_.node.links.resize(finished_.rows.size());
    for (std::size_t row = 0; row < finished_.rows.size(); ++row) {
      const std::uint32_t cover = finished_.rows[row].cover;
      if (cover == CADT_NONE) {
        if (node_.is_root) give_up("an edge of the root has nothing across");
        pass_side(finished_, node_, row);
      } else {
        finished_.node.links[row] = merged_.sides[cover].triangle;
        ++covered_rows;
      }
    }
    if (covered_rows != met_)
      give_up(met_, " sides of children meet final triangles of node ", node_.number, ", which meet ", covered_rows);
  }

  [[nodiscard]] std::size_t outside() const noexcept { return outside_; }
  [[nodiscard]] std::uint64_t certified() const noexcept { return certified_; }

 private:
  void settle(std::size_t i, const Match& match, const std::vector<Match>& matches) {
    const OpenSide& side = merged_.sides[i];
    switch (match.kind) {
      case CADT_MATCHED_OUTSIDE:
        if (!node_.is_root) return pass_up(side);
        ++outside_;
        return tell(side, outside_hull);
      case CADT_MATCHED_SIDE: {
        const OpenSide& other = merged_.sides.at(match.with);
        if (matches[match.with].with != i) give_up("the sides ", i, " and ", match.with, " of children do not match");
        if (i < match.with) certify(side, other.apex_x, other.apex_y);
        return tell(side, other.triangle);
      }
      case CADT_MATCHED_FINAL:
        ++met_;
        certify(side, merged_.xy[2 * std::size_t{match.apex}], merged_.xy[2 * std::size_t{match.apex} + 1]);
        return tell(side, triangle_id(node_.number, match.with));
      case CADT_MATCHED_OPEN:
        if (!node_.is_root) return pass_up(side);
        [[fallthrough]];
      default:
        give_up("side ", i, " of the children of node ", node_.number, " is not in the mesh of their open vertices");
    }
  }

  void tell(const OpenSide& side, TriangleId across) {
    finished_.node.messages.push_back({side.triangle, side.row, across});
  }

  void pass_up(OpenSide side) {
    const auto rank = [&](std::uint32_t vertex) {
      const auto at = std::ranges::lower_bound(finished_.open, vertex);
      if (at == finished_.open.end() || *at != vertex)
        give_up("an end of a side of the children of node ", node_.number, " is closed, and nothing final is across");
      return static_cast<std::uint32_t>(at - finished_.open.begin());
    };
    side.from = rank(side.from);
    side.to = rank(side.to);
    finished_.node.open.sides.push_back(side);
  }

  /// The edge is legal: q, across from the side, is not in the circle of its triangle.
  void certify(const OpenSide& side, double x, double y) {
    const auto vertex = [&](std::uint32_t v) {
      return verifier::Point{merged_.xy[2 * std::size_t{v}], merged_.xy[2 * std::size_t{v} + 1]};
    };
    const verifier::Point apex{side.apex_x, side.apex_y}, a = vertex(side.from), b = vertex(side.to), q{x, y};
    ++certified_;
    int inside = -1;
    if (verifier::orientation(apex, a, b) <= 0 || verifier::orientation(q, b, a) <= 0)
      give_up("two triangles of an edge of node ", node_.number, " are on the same side of it");
    inside = verifier::incircle(apex, a, b, q);
    if (inside == 0) inside = verifier::incircle_perturbed(apex, a, b, q);
    if (inside > 0) give_up("an edge between two nodes, found by node ", node_.number, ", is illegal");
  }

  const Node& node_;
  const Merged& merged_;
  Finished& finished_;
  std::size_t met_ = 0, outside_ = 0;
  std::uint64_t certified_ = 0;
};

Bounds bounds_of(const std::vector<double>& xy) {
  Bounds bounds{xy[0], xy[0], xy[1], xy[1]};
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    bounds.min_x = std::min(bounds.min_x, xy[i]);
    bounds.max_x = std::max(bounds.max_x, xy[i]);
    bounds.min_y = std::min(bounds.min_y, xy[i + 1]);
    bounds.max_y = std::max(bounds.max_y, xy[i + 1]);
  }
  return bounds;
}

}  // namespace

FinishedNode finish_join(Triangulator& triangulator, std::span<const Open> children, const TileBox& box,
                         std::uint32_t number) {
  Merged merged = merge(children);
  const std::size_t n = merged.ids.size();
  Node node = open_node(triangulator, n, box, number);
  Triangulator::State& state = *node.data->state;
  node.data->xy = merged.xy;
  node.data->own_ids = merged.ids;
  if (n != 0) {
    state.device->begin_call();
    Call call(state, n);
    node.bounds = bounds_of(merged.xy);
    node.data->points = call.ctx.memory.import(node.data->xy.data(), n * sizeof(cadt_point));
    node.data->ids = call.ctx.memory.import(node.data->own_ids.data(), n * sizeof(std::uint64_t));
  }
  triangulate_node(node);
  if (node.mesh->distinct != n)
    give_up(n - node.mesh->distinct, " open vertices of different tiles are equal: their boxes overlap");
  Call call(state, n);
  const bool flat = node.mesh->triangle_count == 0;
  if (flat && !merged.sides.empty()) give_up("children of collinear open vertices have final triangles");
  if (!flat) node.cover = find_cover(call.ctx, node, merged.sides);
  Finished finished = take_final(call, node);
  Settlement settlement(node, merged, finished);
  if (!flat) settlement.settle(match_sides(call.ctx, node, finished.places, merged.sides.size()));
  add_sums(finished, node, settlement.outside(), settlement.certified());
  call.ctx.device.finish();
  finished.node.part = DevicePart(std::move(node.data));
  return std::move(finished.node);
}

}  // namespace cadt
