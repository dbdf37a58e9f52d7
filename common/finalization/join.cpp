// SPDX-License-Identifier: Apache-2.0
// Joins: what is open in the children, among itself.
#include <cadt/finalization.hpp>

#include <algorithm>
#include <bit>
#include <string>
#include <thread>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/finalization/finish.hpp"
#include "common/points/bounds.hpp"
#include "common/queries/call.hpp"
#include "common/verify/host/exact_sign.hpp"
#include "common/verify/host/parallel.hpp"

namespace cadt {

using namespace device_text;
using namespace finalization;

namespace {

/// The open vertices of all children, one child after the other, and their sides.
struct Gathered {
  std::vector<double> xy;
  std::vector<std::uint64_t> ids;
  std::vector<OpenSide> sides;       ///< ends are indices of the node's points once these are known
  std::vector<std::uint32_t> order;  ///< of each of the node's points: which one here
  [[nodiscard]] verifier::Point point(std::uint32_t v) const {
    const std::size_t at = order[v];
    return {xy[2 * at], xy[2 * at + 1]};
  }
};

/// \throws LimitError, InputError
Gathered gather(std::span<const Open> children) {
  std::size_t count = 0, side_count = 0;
  for (const Open& child : children) {
    if (child.xy.size() != 2 * child.ids.size())
      throw InputError("the open vertices of a child have not two coordinates each", child.ids.size());
    count += child.ids.size();
    side_count += child.sides.size();
  }
  if (count > max_points())
    throw LimitError(
        std::to_string(count) + " vertices are open in a join, more than " + std::to_string(max_points()) +
            ": most circles are larger than the tiles, as those of points on one circle; take fewer points",
        count, max_points());
  Gathered all;
  all.ids.reserve(count);
  all.xy.reserve(2 * count);
  all.sides.reserve(side_count);
  for (const Open& child : children) {
    const auto offset = static_cast<std::uint32_t>(all.ids.size());
    for (OpenSide side : child.sides) {
      if (side.from >= child.ids.size() || side.to >= child.ids.size() || side.from == side.to)
        throw InputError("a side of a child is not one between two of its open vertices", all.sides.size());
      side.from += offset;
      side.to += offset;
      all.sides.push_back(side);
    }
    all.ids.insert(all.ids.end(), child.ids.begin(), child.ids.end());
    all.xy.insert(all.xy.end(), child.xy.begin(), child.xy.end());
  }
  return all;
}

/// The order of ids of 64 bits: two stable sorts by words of 32.
Allocation sort_ids(Context& ctx, const std::vector<std::uint64_t>& ids) {
  Launcher& launch = ctx.launcher;
  const std::size_t n = ids.size(), bytes = n * word;
  std::vector<std::uint32_t> low(n), high(n);
  for (std::size_t i = 0; i < n; ++i) {
    low[i] = static_cast<std::uint32_t>(ids[i]);
    high[i] = static_cast<std::uint32_t>(ids[i] >> 32);
  }
  Allocation keys = ctx.memory.allocate(bytes), order = ctx.memory.allocate(bytes), spare = ctx.memory.allocate(bytes),
             spare_order = ctx.memory.allocate(bytes);
  ctx.device.write(*keys, 0, low.data(), bytes);
  launch.sort(keys, order, spare, spare_order, n, 32, true);
  const Allocation high_words = ctx.memory.allocate(bytes);
  ctx.device.write(*high_words, 0, high.data(), bytes);
  launch.run<KernelId::cadt_gather_words>(high_words, order, keys, launch.grid(n));
  launch.sort(keys, order, spare, spare_order, n, 32, false);
  return order;
}

/// Gives the node its points, in the order of their ids.
void take_points(Context& ctx, Node& node, Gathered& all) {
  const std::size_t n = all.ids.size();
  Launcher& launch = ctx.launcher;
  const Allocation order = sort_ids(ctx, all.ids);
  const Allocation points = ctx.memory.import(all.xy.data(), n * sizeof(cadt_point)),
                   ids = ctx.memory.import(all.ids.data(), n * id_bytes);
  node.data->points = ctx.memory.allocate(n * sizeof(cadt_point));
  node.data->ids = ctx.memory.allocate(n * id_bytes);
  launch.run<KernelId::cadt_gather_points>(points, order, node.data->points, launch.grid(n), 1.0, 1.0);
  launch.run<KernelId::cadt_gather_ids>(ids, order, node.data->ids, launch.grid(n));
  require_ascending(ctx, node.data->ids, n);
  all.order = ctx.device.read_values(*order, n);
  std::vector<std::uint32_t> place(n);
  for (std::uint32_t i = 0; i < n; ++i) place[all.order[i]] = i;
  for (OpenSide& side : all.sides) {
    side.from = place[side.from];
    side.to = place[side.to];
  }
}

/// Which triangles the children cover (common/stars/stitch.dev.h).
Cover find_cover(Context& ctx, const Node& node, const std::vector<OpenSide>& sides) {
  Launcher& launch = ctx.launcher;
  const std::size_t count = node.mesh->triangle_count;
  const LaunchGrid inner = launch.grid(count);
  // A side is an open triangle: its first vertex, which is closed, is not known here.
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * sides.size());
  for (const OpenSide& side : sides) corners.insert(corners.end(), {CADT_NONE, side.from, side.to});
  const Allocation open_triangles = ctx.memory.allocate(std::max<std::size_t>(corners.size(), 1) * word);
  if (!corners.empty()) ctx.device.write(*open_triangles, 0, corners.data(), corners.size() * word);
  // Positions of vertices in the node, and the list of all sides.
  const std::size_t n = std::max(node.data->point_count, sides.size());
  const Allocation identity = ctx.memory.allocate(n * word);
  launch.run<KernelId::cadt_identity>(identity, launch.grid(n));
  const std::size_t places = std::bit_ceil(2 * sides.size() + 2), mask = places - 1;
  const Allocation table = ctx.memory.allocate(places * word);
  ctx.device.fill(*table, 0, places * word, CADT_NONE);
  launch.run<KernelId::cadt_stitch_enter>(open_triangles, identity, launch.grid(sides.size()), table, mask);

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

/// Edges between final triangles of two nodes.
struct Edges {
  verifier::Findings illegal, folded;
  /// q: the vertex across from a side.
  void examine(std::size_t i, const Gathered& all, const verifier::Point& q) {
    const OpenSide& side = all.sides[i];
    const verifier::Point apex{side.apex_x, side.apex_y}, a = all.point(side.from), b = all.point(side.to);
    ++illegal.examined;
    if (verifier::orientation(apex, a, b) <= 0 || verifier::orientation(q, b, a) <= 0) return folded.fail(i);
    int inside = verifier::incircle(apex, a, b, q);
    if (inside == 0) inside = verifier::incircle_perturbed(apex, a, b, q);
    if (inside > 0) illegal.fail(i);
  }
  void merge(const Edges& other) {
    illegal.merge(other.illegal);
    folded.merge(other.folded);
  }
};

constexpr std::size_t fewest_for_threads = std::size_t{1} << 15;  // below, a thread costs more than it saves

/// What lies across the sides of the children, and the certificates of these edges.
class Settlement {
 public:
  Settlement(const Node& node, const Gathered& all, Finished& finished) : node_(node), all_(all), finished_(finished) {}

  void settle(const std::vector<Match>& matches) {
    certify(matches);
    finished_.node.messages.reserve(matches.size());
    for (std::size_t i = 0; i < matches.size(); ++i) settle(i, matches[i]);
    std::size_t covered_rows = 0;
    finished_.node.links.resize(finished_.rows.size());
    for (std::size_t row = 0; row < finished_.rows.size(); ++row) {
      const std::uint32_t cover = finished_.rows[row].cover;
      if (cover == CADT_NONE) {
        if (node_.is_root) give_up("an edge of the root has nothing across");
        pass_side(finished_, node_, row);
      } else {
        finished_.node.links[row] = all_.sides[cover].triangle;
        ++covered_rows;
      }
    }
    if (covered_rows != met_)
      give_up(met_, " sides of children meet final triangles of node ", node_.number, ", which meet ", covered_rows);
  }

  [[nodiscard]] std::size_t outside() const noexcept { return outside_; }
  [[nodiscard]] std::uint64_t certified() const noexcept { return certified_; }

 private:
  void settle(std::size_t i, const Match& match) {
    const OpenSide& side = all_.sides[i];
    switch (match.kind) {
      case CADT_MATCHED_OUTSIDE:
        if (!node_.is_root) return pass_up(side);
        ++outside_;
        return tell(side, outside_hull);
      case CADT_MATCHED_FINAL:
        ++met_;
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

  /// Examines the edges that have a final triangle on both sides, each once.
  void certify(const std::vector<Match>& matches) {
    unsigned threads = 1;
    if (matches.size() >= fewest_for_threads) {
      threads = node_.data->state->options.threads;  // as the host's own work: 0 means all cores
      if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
    }
    const Edges edges = verifier::reduce_each<Edges>(matches.size(), threads, [&](std::size_t i, Edges& mine) {
      const Match& match = matches[i];
      if (match.kind == CADT_MATCHED_FINAL) mine.examine(i, all_, all_.point(match.apex));
    });
    if (edges.folded.failures != 0)
      give_up("two triangles of an edge that node ", node_.number, " closes are on the same side of it");
    if (edges.illegal.failures != 0)
      give_up(edges.illegal.failures, " edges between two nodes, closed by node ", node_.number, ", are illegal");
    certified_ = edges.illegal.examined;
  }

  const Node& node_;
  const Gathered& all_;
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
  Gathered all = gather(children);
  const std::size_t n = all.ids.size();
  Node node = open_node(triangulator, n, box, number);
  Triangulator::State& state = *node.data->state;
  if (n != 0) {
    state.device->begin_call();
    Call call(state, n);
    node.bounds = bounds_of(all.xy);
    take_points(call.ctx, node, all);
  }
  triangulate_node(node);
  if (node.mesh->distinct != n)
    give_up(n - node.mesh->distinct, " open vertices of different tiles are equal: their boxes overlap");
  Call call(state, n);
  const bool flat = node.mesh->triangle_count == 0;
  if (flat && !all.sides.empty()) give_up("children of collinear open vertices have final triangles");
  if (!flat) node.cover = find_cover(call.ctx, node, all.sides);
  Finished finished = take_final(call, node);
  Settlement settlement(node, all, finished);
  if (!flat) settlement.settle(match_sides(call.ctx, node, finished.places, all.sides.size()));
  add_sums(call, finished, node, settlement.outside(), settlement.certified());
  finished.node.part = DevicePart(std::move(node.data));
  return std::move(finished.node);
}

}  // namespace cadt
