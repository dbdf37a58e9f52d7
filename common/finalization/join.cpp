// SPDX-License-Identifier: Apache-2.0
// Joins: what is open in the children, among itself.
#include <cadt/finalization.hpp>

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/finalization/children.hpp"
#include "common/finalization/finish.hpp"
#include "common/platform/parallel.hpp"
#include "common/points/bounds.hpp"
#include "common/queries/call.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt {

using namespace device_text;
using namespace finalization;

namespace {

/// The order of ids of 64 bits, of which `largest` is one: two stable sorts by words of 32 bits, as far as they differ.
Allocation sort_ids(Context& ctx, const Allocation& ids, std::size_t n, std::uint64_t largest) {
  Launcher& launch = ctx.launcher;
  const std::size_t bytes = n * word;
  const auto bits = static_cast<unsigned>(std::bit_width(largest));
  Allocation keys = ctx.memory.allocate(bytes), order = ctx.memory.allocate(bytes), spare = ctx.memory.allocate(bytes),
             spare_order = ctx.memory.allocate(bytes);
  const Allocation none;
  launch.run<KernelId::cadt_id_words>(ids, none, 0U, keys, launch.grid(n));
  launch.sort(keys, order, spare, spare_order, n, std::clamp(bits, 1U, 32U), true);
  if (bits > 32) {
    launch.run<KernelId::cadt_id_words>(ids, order, 32U, keys, launch.grid(n));
    launch.sort(keys, order, spare, spare_order, n, bits - 32, false);
  }
  return order;
}

/// Gives the node its points, in the order of their ids. Returns of each its number among those of the children.
Allocation take_points(Context& ctx, Node& node, const Children& children) {
  const std::size_t n = children.vertices();
  Launcher& launch = ctx.launcher;
  const Allocation points = ctx.memory.allocate(n * sizeof(cadt_point)), ids = ctx.memory.allocate(n * id_bytes);
  children.write(ctx.device, points, ids);
  Allocation order = sort_ids(ctx, ids, n, children.largest_id());
  node.data->points = ctx.memory.allocate(n * sizeof(cadt_point));
  node.data->ids = ctx.memory.allocate(n * id_bytes);
  launch.run<KernelId::cadt_gather_points>(points, order, node.data->points, launch.grid(n), 1.0, 1.0);
  launch.run<KernelId::cadt_gather_ids>(ids, order, node.data->ids, launch.grid(n));
  require_ascending(ctx, node.data->ids, n);
  node.bounds = find_bounds(ctx, node.data->points, n, ctx.memory.allocate(CADT_ORDER_WORDS * word));
  return order;
}

/// Threads that work with so many sides.
unsigned threads_for(const Node& node, std::size_t sides) {
  constexpr std::size_t of_thread = std::size_t{1} << 13;  // with fewer, a thread costs more than it saves
  const std::size_t most = platform::threads_or_all(node.data->state->options.threads);
  return static_cast<unsigned>(std::clamp<std::size_t>(sides / of_thread, 1, most));
}

/// Which triangles the children cover (common/stars/stitch.dev.h). `order`: as take_points gives it.
Cover find_cover(Context& ctx, const Node& node, const Children& children, const Allocation& order) {
  Launcher& launch = ctx.launcher;
  const std::size_t count = node.mesh->triangle_count, sides = children.sides();
  const LaunchGrid inner = launch.grid(count);
  // A side is an open triangle: its first vertex, which is closed, is not known here.
  const auto corners = std::make_unique_for_overwrite<std::uint32_t[]>(3 * sides);
  platform::for_each_task(children.stretches(), threads_for(node, sides), [&](std::size_t stretch) {
    children.each_side(stretch, [&](const Children::Side& side) {
      std::uint32_t* to = &corners[3 * side.number];
      to[0] = CADT_NONE, to[1] = side.from, to[2] = side.to;
    });
  });
  const Allocation open_triangles = ctx.memory.allocate(std::max<std::size_t>(3 * sides, 1) * word);
  if (sides != 0) ctx.device.write(*open_triangles, 0, corners.get(), 3 * sides * word);
  const Allocation list = ctx.memory.allocate(std::max<std::size_t>(sides, 1) * word);  // of all of them
  launch.run<KernelId::cadt_identity>(list, launch.grid(sides));
  const std::size_t places = std::bit_ceil(2 * sides + 2), mask = places - 1;
  const Allocation table = ctx.memory.allocate(places * word);
  ctx.device.fill(*table, 0, places * word, CADT_NONE);
  launch.run<KernelId::cadt_stitch_enter>(open_triangles, list, launch.grid(sides), table, mask);

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
  launch.run<KernelId::cadt_stitch_cover>(inner.items, mesh, open_triangles, order, inner.grain, table, mask,
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
  std::uint32_t kind, first, second;
  Match() noexcept {}  // NOLINT: many are read from the device, and not zeroed before
};

std::vector<Match> match_sides(Context& ctx, const Node& node, const Finished& finished, const Allocation& order,
                               std::size_t count) {
  static_assert(sizeof(Match) == CADT_MATCH_WORDS * word);
  if (count == 0) return {};
  const Allocation matches = ctx.memory.allocate(count * sizeof(Match));
  ctx.device.fill(*matches, 0, count * sizeof(Match), CADT_NONE);
  const LaunchGrid all = ctx.launcher.grid(node.mesh->triangle_count);
  ctx.launcher.run<KernelId::cadt_match_sides>(all.items, node.view(), node.cover.half_edges, node.cover.covers,
                                               finished.places, finished.ranks, order, all.grain, matches);
  return ctx.device.read_values<Match>(*matches, count);
}

/// Edges between final triangles of two nodes.
struct Edges {
  std::uint64_t examined = 0, illegal = 0, folded = 0;
  /// q: the vertex across from a side.
  void examine(const Children::Side& side, const verifier::Point& q) {
    const verifier::Point apex{side.side.apex_x, side.side.apex_y}, &a = side.a, &b = side.b;
    ++examined;
    if (verifier::orientation(apex, a, b) <= 0 || verifier::orientation(q, b, a) <= 0) {
      ++folded;
      return;
    }
    int inside = verifier::incircle(apex, a, b, q);
    if (inside == 0) inside = verifier::incircle_perturbed(apex, a, b, q);
    if (inside > 0) ++illegal;
  }
  void merge(const Edges& other) {
    examined += other.examined;
    illegal += other.illegal;
    folded += other.folded;
  }
};

/// What lies across the sides of the children, and the certificates of these edges.
class Settlement {
 public:
  Settlement(const Node& node, const Children& children, Finished& finished)
      : node_(node), children_(children), finished_(finished) {}

  void settle(const std::vector<Match>& matches) {
    // Where what the sides of each stretch tell and pass up is written.
    std::vector<Places> places(children_.stretches());
    Places end;
    std::size_t met = 0;
    for (std::size_t s = 0; s < places.size(); ++s) {
      places[s] = end;
      for (std::size_t i = children_.first_side(s); i < children_.end_side(s); ++i) {
        ++(is_told(matches[i]) ? end.messages : end.sides);
        met += matches[i].kind == CADT_MATCHED_FINAL ? 1 : 0;
      }
    }
    finished_.node.messages.resize(end.messages);
    finished_.node.open.sides.reserve(end.sides + finished_.rows.size() - std::min(met, finished_.rows.size()));
    finished_.node.open.sides.resize(end.sides);
    const Sum sum = platform::reduce_each<Sum>(
        children_.stretches(), threads_for(node_, matches.size()),
        [&](std::size_t s, Sum& mine) {
          Places at = places[s];
          children_.each_side(s, [&](const Children::Side& side) { settle(side, matches[side.number], at, mine); });
        },
        1);
    require_legal(sum.edges);
    certified_ = sum.edges.examined;
    outside_ = sum.outside;
    link_rows(certified_);
  }

  [[nodiscard]] std::size_t outside() const noexcept { return outside_; }
  [[nodiscard]] std::uint64_t certified() const noexcept { return certified_; }

 private:
  struct Places {
    std::size_t messages = 0, sides = 0;
  };
  struct Sum {
    Edges edges;
    std::size_t outside = 0;
    void merge(const Sum& other) {
      edges.merge(other.edges);
      outside += other.outside;
    }
  };

  /// Whether what lies across the side is known now; else the side goes up.
  [[nodiscard]] bool is_told(const Match& match) const noexcept {
    return match.kind == CADT_MATCHED_FINAL || (node_.is_root && match.kind == CADT_MATCHED_OUTSIDE);
  }

  void settle(const Children::Side& side, const Match& match, Places& at, Sum& mine) const {
    const auto tell = [&](TriangleId across) {
      finished_.node.messages[at.messages++] = {side.side.triangle, side.side.row, across};
    };
    if (match.kind == CADT_MATCHED_FINAL) {
      mine.edges.examine(side, children_.point(match.second));
      return tell(triangle_id(node_.number, match.first));
    }
    if (is_told(match)) {
      ++mine.outside;
      return tell(outside_hull);
    }
    if (node_.is_root || (match.kind != CADT_MATCHED_OUTSIDE && match.kind != CADT_MATCHED_OPEN))
      give_up("side ", side.number, " of the children of node ", node_.number,
              " is not in the mesh of their open vertices");
    if (match.first == CADT_NONE || match.second == CADT_NONE)
      give_up("an end of a side of the children of node ", node_.number, " is closed, and nothing final is across");
    OpenSide& up = finished_.node.open.sides[at.sides++];
    up = side.side;
    up.from = match.first;
    up.to = match.second;
  }

  void require_legal(const Edges& edges) const {
    if (edges.folded != 0)
      give_up("two triangles of an edge that node ", node_.number, " closes are on the same side of it");
    if (edges.illegal != 0)
      give_up(edges.illegal, " edges between two nodes, closed by node ", node_.number, ", are illegal");
  }

  /// `met`: sides of the children that meet a final triangle of this node.
  void link_rows(std::uint64_t met) {
    const std::size_t rows = finished_.rows.size();
    std::vector<TriangleId>& links = finished_.node.links;
    links.resize(rows);
    const auto link = [&](std::size_t row) {
      const std::uint32_t cover = finished_.rows[row].cover;
      links[row] = cover == CADT_NONE ? pending_triangle : children_.triangle(cover);
    };
    platform::for_each_task(rows, threads_for(node_, rows), link, std::size_t{1} << 13);
    std::size_t covered = rows;
    for (std::size_t row = 0; row < rows; ++row) {
      if (finished_.rows[row].cover != CADT_NONE) continue;
      --covered;
      if (node_.is_root) give_up("an edge of the root has nothing across");
      finished_.node.open.sides.push_back(side_of(finished_, node_, row));
    }
    if (covered != met)
      give_up(met, " sides of children meet final triangles of node ", node_.number, ", which meet ", covered);
  }

  const Node& node_;
  const Children& children_;
  Finished& finished_;
  std::size_t outside_ = 0;
  std::uint64_t certified_ = 0;
};

}  // namespace

FinishedNode finish_join(Triangulator& triangulator, std::span<const Open> open, const TileBox& box,
                         std::uint32_t number) {
  const Children children(open);
  const std::size_t n = children.vertices();
  Node node = open_node(triangulator, n, box, number);
  Triangulator::State& state = *node.data->state;
  Allocation order;
  if (n != 0) {
    state.device->begin_call();
    Call call(state, n, 0);
    order = take_points(call.ctx, node, children);
  }
  triangulate_node(node);
  if (node.mesh->distinct != n)
    give_up(n - node.mesh->distinct, " open vertices of different tiles are equal: their boxes overlap");
  Call call(state, n, share_of_mesh);
  const bool flat = node.mesh->triangle_count == 0;
  if (flat && children.sides() != 0) give_up("children of collinear open vertices have final triangles");
  if (!flat) node.cover = find_cover(call.ctx, node, children, order);
  Finished finished = take_final(call, node);
  Settlement settlement(node, children, finished);
  if (!flat) settlement.settle(match_sides(call.ctx, node, finished, order, children.sides()));
  add_sums(call, finished, node, settlement.outside(), settlement.certified());
  finished.node.part = DevicePart(std::move(node.data));
  return std::move(finished.node);
}

}  // namespace cadt
