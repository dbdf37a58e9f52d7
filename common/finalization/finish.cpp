// SPDX-License-Identifier: Apache-2.0
#include "common/finalization/finish.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/points/bounds.hpp"
#include "common/points/device_points.hpp"
#include "common/points/import.hpp"
#include "common/queries/call.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt::finalization {

using namespace device_text;

namespace {

/// CADT_TILE_BOX_PARAMETERS
struct ScaledBox {
  const TileBox& box;
  double scale, scale_again;
  [[nodiscard]] auto arguments() const {
    return std::tie(box.min_x, box.min_y, box.max_x, box.max_y, scale, scale_again);
  }
};

/// Two powers of two whose product makes the extent of the points about 1; one alone may be out of range.
ScaledBox scaled(const TileBox& box, const Bounds& bounds) {
  const double extent = std::max(bounds.max_x / 2 - bounds.min_x / 2, bounds.max_y / 2 - bounds.min_y / 2);
  const int exponent = extent > 0 ? -std::ilogb(extent) - 1 : 0;
  return {box, std::ldexp(1.0, exponent / 2), std::ldexp(1.0, exponent - exponent / 2)};
}

/// While this lives, what a call reports is its share of the node's work.
class MeshProgress {
 public:
  explicit MeshProgress(Options& options) : options_(options), of_node_(options.progress) {
    if (of_node_)
      options_.progress = [this](const Progress& of_mesh) {
        of_node_({of_mesh.phase, share_of_mesh * of_mesh.fraction});
      };
  }
  ~MeshProgress() { options_.progress.swap(of_node_); }
  MeshProgress(const MeshProgress&) = delete;
  MeshProgress& operator=(const MeshProgress&) = delete;

 private:
  Options& options_;
  std::function<void(const Progress&)> of_node_;
};

/// The node's open vertices without triangles: all distinct ones.
std::vector<std::uint32_t> distinct_points(const Node& node) {
  std::vector<bool> duplicate(node.data->point_count);
  for (const Duplicate& d : read_duplicates(*node.mesh)) duplicate[static_cast<std::size_t>(d.point)] = true;
  std::vector<std::uint32_t> points;
  points.reserve(node.mesh->distinct);
  for (std::uint32_t i = 0; i < duplicate.size(); ++i)
    if (!duplicate[i]) points.push_back(i);
  return points;
}

/// Copies ids and coordinates of the open vertices to the host. `points`: theirs; null if `list` is not on the device.
void read_open(Context& ctx, const Node& node, const Allocation& list, const Allocation& points, std::size_t count,
               Finished& finished) {
  Open& open = finished.node.open;
  const Allocation ids = ctx.memory.allocate(count * id_bytes);
  ctx.launcher.run<KernelId::cadt_gather_ids>(node.data->ids, list, ids, ctx.launcher.grid(count));
  open.ids = ctx.device.read_values<std::uint64_t>(*ids, count);
  open.xy = ctx.device.read_values<double>(*points, 2 * count);
}

void leave_all_open(Context& ctx, const Node& node, Finished& finished) {
  const std::vector<std::uint32_t> all = distinct_points(node);
  const std::size_t count = all.size();
  if (count == 0) return;
  const Allocation list = ctx.memory.allocate(count * word);
  ctx.device.write(*list, 0, all.data(), count * word);
  const Allocation points = ctx.memory.allocate(count * point_bytes(ctx.device));
  ctx.launcher.run<KernelId::cadt_gather_points>(node.data->points, list, points, ctx.launcher.grid(count), 1.0, 1.0);
  read_open(ctx, node, list, points, count, finished);
}

/// Lists the edges that have a row, ascending; returns their number.
std::size_t list_rows(Context& ctx, const Node& node, const Allocation& places, Allocation& rows) {
  Launcher& launch = ctx.launcher;
  const LaunchGrid all = launch.grid(node.mesh->triangle_count);
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(node.mesh->triangle_count)));
  for (std::size_t room = 32 * side + 1024;;) {
    rows = ctx.memory.allocate(room * word);
    const Allocation counter = launch.zeros(1);
    launch.run<KernelId::cadt_list_rows>(all.items, node.view(), places, node.is_root, all.grain, counter, rows, room);
    const std::size_t count = launch.read_word(counter, 0);
    if (count > room) {
      room = count;
      continue;
    }
    if (count > 1) {
      Allocation values = ctx.memory.allocate(room * word), spare = ctx.memory.allocate(room * word),
                 spare_values = ctx.memory.allocate(room * word);
      launch.sort(rows, values, spare, spare_values, count, 32, true);
    }
    return count;
  }
}

void read_rows(Context& ctx, const Node& node, const Allocation& places, const Allocation& ranks,
               const Allocation& rows, std::size_t count, Finished& finished) {
  if (count == 0) return;
  Launcher& launch = ctx.launcher;
  const Allocation words = ctx.memory.allocate(count * sizeof(Row)),
                   apexes = ctx.memory.allocate(count * point_bytes(ctx.device));
  static_assert(sizeof(Row) == CADT_ROW_WORDS * word);
  const LaunchGrid all = launch.grid(count);
  launch.run<KernelId::cadt_pack_rows>(all.items, node.view(), places, ranks, node.cover.half_edges, node.cover.covers,
                                       rows, all.count, all.grain, words, apexes);
  finished.rows = ctx.device.read_values<Row>(*words, count);
  if (!node.is_root) finished.apexes = ctx.device.read_values<double>(*apexes, 2 * count);
}

}  // namespace

DeviceMeshView Node::view() const {
  static const Allocation none;
  const auto count = static_cast<std::uint32_t>(mesh->triangle_count);
  return {data->points, mesh->triangles, mesh->neighbors, none, count, count, 0};
}

Call::Call(Triangulator::State& state, std::size_t points, double done)
    : ctx(*state.device, state.memory, state.options, statistics) {
  begin_budget(state, points);
  ctx.begin_share(done, 1 - done);
  ctx.check("finish", 0);
}

Node open_node(Triangulator& triangulator, std::size_t points, const TileBox& box, std::uint32_t number) {
  require_size(points);
  if (number >> node_bits != 0)
    throw LimitError(
        "a tree has at most 2^24 nodes, and this one is number " + std::to_string(number) + ": take larger tiles",
        number, std::size_t{1} << node_bits);
  query::require_doubles(*triangulator.state()->device);
  verifier::require_ieee_arithmetic();
  Node node;
  node.number = number;
  node.box = box;
  node.is_root = box.is_plane();
  node.data = std::make_unique<DevicePart::Data>();
  node.data->state = triangulator.state();
  node.data->point_count = points;
  return node;
}

void require_ascending(Context& ctx, const Allocation& ids, std::size_t count) {
  const Allocation first = ctx.memory.allocate(word);
  ctx.device.fill(*first, 0, word, CADT_NONE);
  ctx.launcher.run<KernelId::cadt_check_ids>(ids, ctx.launcher.grid(count), first);
  const std::uint32_t wrong = ctx.launcher.read_word(first, 0);
  if (wrong != CADT_NONE)
    throw InputError("the id of point " + std::to_string(wrong) +
                         " of the node is not above the one before it: sort the points by their ids, each once",
                     wrong);
}

void triangulate_node(Node& node) {
  DevicePart::Data& data = *node.data;
  Device& device = *data.state->device;
  DevicePoints points;
  points.x = data.points ? device.handle(*data.points) : nullptr;
  points.size = data.point_count;
  const MeshProgress progress(data.state->options);
  node.mesh = triangulate_on_device(data.state, points);
}

Finished take_final(Call& call, Node& node) {
  Context& ctx = call.ctx;
  Launcher& launch = ctx.launcher;
  DevicePart::Data& data = *node.data;
  DeviceTriangulation::Data& mesh = *node.mesh;
  Finished finished;
  const std::size_t n = data.point_count, count = mesh.triangle_count;
  if (count == 0) {
    if (!node.is_root) leave_all_open(ctx, node, finished);
    return finished;
  }
  const LaunchGrid all = launch.grid(count);
  Allocation& ranks = finished.ranks;
  if (!node.is_root) {
    ranks = ctx.memory.allocate_zeros((n + 1) * word);
    launch.run<KernelId::cadt_mark_open>(all.items, node.view(), node.cover.kept, scaled(node.box, node.bounds),
                                         all.grain, ranks);
    ctx.end_phase("certain");
  }
  Allocation& places = finished.places = ctx.memory.allocate((count + 1) * word);
  launch.run<KernelId::cadt_flag_final>(mesh.triangles, node.cover.kept, ranks, all, places);
  launch.scan(places, count + 1);
  data.triangle_count = launch.read_word(places, count);
  if (!node.is_root) {
    launch.scan(ranks, n + 1);
    const std::size_t open = launch.read_word(ranks, n);  // hull vertices are open, so there are some
    const Allocation list = ctx.memory.allocate(open * word),
                     points = ctx.memory.allocate(open * point_bytes(ctx.device));
    launch.run<KernelId::cadt_pack_residual>(ranks, data.points, points, list, launch.grid(n));
    read_open(ctx, node, list, points, open, finished);
  }
  if (data.triangle_count == 0) return finished;
  Allocation rows;
  const std::size_t row_count = list_rows(ctx, node, places, rows);
  if (data.triangle_count == count && row_count == 0) {
    data.triangles = std::move(mesh.triangles);
    data.neighbors = std::move(mesh.neighbors);
    return finished;
  }
  data.triangles = ctx.memory.allocate(3 * data.triangle_count * word);
  data.neighbors = ctx.memory.allocate(3 * data.triangle_count * word);
  launch.run<KernelId::cadt_pack_final>(all.items, node.view(), places, node.is_root, all.grain, rows, row_count,
                                        data.triangles, data.neighbors);
  read_rows(ctx, node, places, ranks, rows, row_count, finished);
  ctx.end_phase("pack");
  return finished;
}

OpenSide side_of(const Finished& finished, const Node& node, std::size_t row) {
  const Row& r = finished.rows[row];
  if (r.from == CADT_NONE || r.to == CADT_NONE)
    give_up("an edge of a final triangle, of node ", node.number, ", has a closed end and nothing final across");
  return {r.from,
          r.to,
          finished.apexes[2 * row],
          finished.apexes[2 * row + 1],
          triangle_id(node.number, r.triangle),
          static_cast<std::uint32_t>(row)};
}

void add_sums(Call& call, Finished& finished, const Node& node, std::size_t covered_hull_edges,
              std::uint64_t certified_links) {
  NodeSums& sums = finished.node.sums;
  sums.triangles = node.data->triangle_count;
  sums.dimension = node.mesh->dimension;
  if (node.is_root) sums.hull_edges = node.mesh->hull_size();
  // Edges of two final triangles were examined with the node's mesh.
  const std::uint64_t outside = sums.hull_edges - covered_hull_edges;
  sums.certified_edges = (3 * sums.triangles - finished.rows.size() - outside) / 2 + certified_links;
  call.ctx.finish();
  call.ctx.check("finish", 1);
  Statistics& statistics = finished.node.statistics = std::move(node.mesh->statistics);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(statistics.milliseconds, call.statistics.milliseconds);
  append(statistics.kernels, call.ctx.launcher.kernel_times());
}

}  // namespace cadt::finalization
