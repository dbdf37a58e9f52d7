// SPDX-License-Identifier: Apache-2.0
#include "common/stars/mesh_from_stars.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "common/driver/device_text.hpp"
#include "common/stars/local_stars.hpp"
#include "common/stars/wrap.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// With more than a third unproven, the residual vertices would need more memory than insertion of all points, and as
/// much time.
constexpr bool too_many(std::size_t unproven, std::size_t points) { return 3 * unproven > points; }

/// Too many edges between the two parts for their list and hash table.
constexpr bool too_many_open(std::size_t open, std::size_t points) { return 2 * open > points; }

/// Steps in which the compact plan replaces the stars by the vertices of the mesh.
constexpr std::uint32_t waves = 4;

/// Most points of a base mesh. Of coasts, 16,283 points are wrapped in 0.41 ms, 31,314 in 0.75 ms; to insert that many
/// more takes 0.23 to 0.3 ms.
constexpr std::size_t most_in_base = 16384;

/// The mesh of some of the residual vertices, to insert the others into; nothing if they cannot be wrapped.
std::optional<BaseMesh> wrap_base(Context& ctx, const SortedPoints& points, std::size_t all) {
  const std::size_t n = points.distinct, most = std::clamp<std::size_t>(n / 4, 1, most_in_base);
  BaseMesh base;
  while (blocks_of_level(n, base.level) > most) ++base.level;
  const std::size_t count = blocks_of_level(n, base.level);
  const Allocation picked = ctx.memory.allocate(count * sizeof(cadt_point));
  ctx.launcher.run<KernelId::cadt_pick_base>(points.points, n, base.level, ctx.launcher.grid(count), picked);
  const std::uint64_t wrapped = ctx.statistics.wrapped_stars;
  std::optional<Mesh> mesh = wrap_mesh(ctx, picked, count, all, MeshUse::part);
  ctx.statistics.wrapped_stars = wrapped;  // insertion changes these stars
  if (!mesh) return std::nullopt;
  base.mesh = std::move(*mesh);
  return base;
}

class StarStage {
 public:
  StarStage(Context& ctx, SortedPoints points, const InputPoints& input, const BuildStrategy& how, MeshUse use)
      : ctx_(ctx), order_(std::move(points)), input_(input), how_(how), use_(use) {
    order_.grid = grid_for_stars(order_.grid);
  }

  [[nodiscard]] Mesh build() {
    if (!make_stars() || !count_triangles()) {
      release_stars();
      ranks_.release();
      return wrap_or_insert(ctx_, std::move(order_), how_, use_);
    }
    // stars that contradict each other would have more
    if (proven_triangles_ > 2 * n_ - 2)
      give_up("the proven stars have ", proven_triangles_, " triangles, more than ", 2 * n_ - 2);
    ctx_.statistics.proven_stars = n_ - unproven_;
    SortedPoints residual = take_residual();
    if (ctx_.plan.regathers) order_.points.release();
    write_triangles();
    release_stars();
    stitch(std::move(residual));
    mesh_.points = order_.points ? std::move(order_.points) : input_.import_in_order(ctx_, order_);
    mesh_.input_ids = std::move(order_.input_ids);
    return std::move(mesh_);
  }

 private:
  /// False if there are no tiles or too few stars are proven.
  bool make_stars() {
    const KeyGrid& grid = order_.grid;
    Allocation high = std::move(order_.keys), low;
    if (!high) {
      high = ctx_.memory.transient(n_ * word);
      if (grid.fine_levels != 0) low = ctx_.memory.transient(n_ * word);
      make_keys(ctx_, order_.points, high, low, n_, grid);
    }
    const SortKeys keys{high, low, 2 * grid.fine_levels};
    const std::optional<TileList> tiles = make_tiles(ctx_, keys, n_, grid.levels(), how_.least_points_of_tile);
    ctx_.end_phase("tiles");
    if (!tiles) return false;
    ctx_.check("stars", 0.1);
    stars_ = allocate_stars(ctx_, n_, *tiles);
    const StarCounters found = prove_stars(ctx_, order_, keys, {}, {}, *tiles, how_.cautious, stars_);
    ctx_.end_phase("stars");
    ctx_.check("stars", 0.5);
    return found[CADT_STARS_SKIPPED_TILES] == 0 && !too_many(found[CADT_STARS_UNPROVEN], n_);
  }

  /// False if too few triangles are those of proven stars.
  [[nodiscard]] bool count_triangles() {
    // All pooled buffers but one are taken as a whole while the bases live; the compact plan gives them a buffer of
    // their own.
    const std::size_t bases = (n_ + 1) * word;
    bases_ = ctx_.plan.compact ? ctx_.memory.allocate_unpooled(bases) : ctx_.memory.transient(bases);
    ranks_ = ctx_.memory.transient((n_ + 1) * word);
    totals_ = launch_.zeros(2);
    const std::size_t words = (n_ - 1) / 32 + 1;
    proven_ = ctx_.memory.allocate(words * word);
    const std::size_t marks = n_ * sizeof(std::uint16_t);
    marks_ = ctx_.plan.compact ? ctx_.memory.allocate_unpooled(marks) : ctx_.memory.allocate(marks);
    launch_.run<KernelId::cadt_pack_proven>(stars_.sizes, n_, launch_.grid(words), proven_);
    launch_.run<KernelId::cadt_star_counts>(stars_.star_vertices, stars_.begins, stars_.sizes, proven_,
                                            launch_.grid(n_), marks_, bases_, ranks_, totals_);
    stars_.sizes.release();
    launch_.scan(bases_, n_ + 1);
    launch_.scan(ranks_, n_ + 1);
    proven_triangles_ = launch_.read_word(bases_, n_);
    unproven_ = launch_.read_word(ranks_, n_);
    open_count_ = launch_.read_word(totals_, 0);
    return !too_many(unproven_, n_) && !too_many_open(open_count_, n_);
  }

  /// The vertices without a proven star; their input ids are positions in the sorted order.
  [[nodiscard]] SortedPoints take_residual() {
    SortedPoints residual;
    residual.distinct = unproven_;
    residual.points = ctx_.memory.allocate(unproven_ * sizeof(cadt_point));
    residual.input_ids = ctx_.memory.allocate(unproven_ * word);
    launch_.run<KernelId::cadt_pack_residual>(ranks_, order_.points, residual.points, residual.input_ids,
                                              launch_.grid(n_));
    ranks_.release();
    return residual;
  }

  /// Half-edges and vertices of the triangles with a proven vertex.
  void write_triangles() {
    mesh_.all = 2 * n_ - 2;
    const auto groups = static_cast<std::uint32_t>((n_ - 1) / CADT_ASSEMBLY_LANES + 1);
    mesh_.across = make_mesh_array(ctx_, mesh_.all, MeshUse::whole);
    open_ = ctx_.memory.allocate(std::size_t{open_count_} * word);
    const Allocation firsts = ctx_.memory.allocate((groups + std::size_t{1}) * word);
    launch_.run<KernelId::cadt_star_half_edges>(stars_.star_vertices, stars_.begins, marks_, bases_, proven_, n_,
                                                launch_.grid_of_teams(groups, CADT_ASSEMBLY_LANES), mesh_.across,
                                                firsts, open_, totals_);
    bases_.release();
    if (!ctx_.plan.compact || !write_vertices_in_place(firsts, groups)) {
      mesh_.vertices = make_mesh_array(ctx_, mesh_.all, MeshUse::whole);
      write_vertices(firsts, 0, groups, mesh_.vertices.device);
    }
    ctx_.end_phase("assemble");
  }

  void write_vertices(const Allocation& firsts, std::uint32_t from, std::uint32_t groups, const Allocation& to) {
    launch_.run<KernelId::cadt_star_vertices>(stars_.star_vertices, stars_.begins, marks_, firsts, n_, from,
                                              launch_.grid_of_teams(groups, CADT_ASSEMBLY_LANES), to);
  }

  /// Writes the vertices over the stars. Both are in the order of the points, six words a point, and there are some
  /// words more before and between the stars of the tiles: a share of the vertices, first written to a buffer of its
  /// own, fits where no star is still to be read. False if it does not fit: where most triangles belong to the first
  /// points.
  bool write_vertices_in_place(const Allocation& firsts, std::uint32_t groups) {
    const std::uint32_t share = (groups - 1) / waves + 1;
    std::vector<std::uint32_t> bounds;  // first triangle of each share
    std::size_t most = 0;
    for (std::uint32_t from = 0; from < groups; from += share) {
      bounds.push_back(launch_.read_word(firsts, from));
      if (from == 0) continue;
      most = std::max<std::size_t>(most, bounds.back() - bounds[bounds.size() - 2]);
      const std::size_t begin = std::size_t{from} * CADT_ASSEMBLY_LANES;
      const std::size_t tile = begin - std::min<std::size_t>(begin, CADT_TILE_POINTS);  // its tile begins here or later
      if (std::size_t{3} * bounds.back() > CADT_STAR_LEAD + 6 * tile + tile / 8) return false;
    }
    bounds.push_back(proven_triangles_);
    most = std::max<std::size_t>(most, bounds.back() - bounds[bounds.size() - 2]);
    const Allocation staged = ctx_.memory.transient(3 * most * word);
    std::uint32_t from = 0;
    for (std::size_t wave = 0; wave + 1 < bounds.size(); ++wave, from += share) {
      write_vertices(firsts, from, std::min(share, groups - from), staged);
      const std::uint32_t words = 3 * (bounds[wave + 1] - bounds[wave]);
      launch_.run<KernelId::cadt_copy_words>(staged, stars_.star_vertices, 3 * bounds[wave], launch_.grid(words));
    }
    mesh_.vertices.device = std::move(stars_.star_vertices);
    return true;
  }

  void release_stars() {
    stars_ = {};
    marks_.release();
    proven_.release();
    bases_.release();
  }

  void stitch(SortedPoints residual) {
    // The buffer of the stars is free now, unless the mesh has taken it.
    const Memory::TransientScope transient(ctx_.memory, !ctx_.plan.compact);
    const std::uint64_t certified = ctx_.statistics.certified_edges;
    // Without legality sweeps where they are of no use: the whole mesh is certified later.
    const Mesh smaller = wrap_or_insert(ctx_, std::move(residual), how_, MeshUse::part, n_);
    ctx_.statistics.certified_edges = certified;  // only those of the whole mesh count
    // Vertices on the hull have no proven star, so not all of these are on a line.
    if (smaller.flat) give_up("the unproven vertices are on a line");
    const Allocation none;
    const DeviceMeshView residual_mesh = view_of(smaller, none);

    const std::size_t places = std::bit_ceil(2 * std::size_t{open_count_} + 2);
    const std::size_t mask = places - 1;
    Allocation table = ctx_.memory.allocate(places * word);
    ctx_.device.fill(*table, 0, places * word, CADT_NONE);
    launch_.run<KernelId::cadt_stitch_enter>(mesh_.vertices, open_, launch_.grid(open_count_), table, mask);
    Allocation covers = ctx_.memory.allocate(3 * smaller.all * word), roots = ctx_.memory.allocate(smaller.all * word);
    const LaunchGrid all = launch_.grid(smaller.all);
    launch_.run<KernelId::cadt_stitch_cover>(all.items, residual_mesh, mesh_.vertices, smaller.input_ids, all.grain,
                                             table, mask, covers, roots);
    launch_.run<KernelId::cadt_stitch_components>(all.items, residual_mesh, all.grain, covers, roots);
    Allocation hidden = launch_.zeros(smaller.all), ranks = ctx_.memory.allocate((smaller.all + 1) * word);
    launch_.run<KernelId::cadt_stitch_hide>(covers, roots, all, hidden);
    launch_.run<KernelId::cadt_stitch_flags>(roots, hidden, all, ranks);
    launch_.scan(ranks, smaller.all + 1);
    const std::size_t triangles = std::size_t{proven_triangles_} + launch_.read_word(ranks, smaller.all);
    if (triangles != mesh_.all)
      give_up("the two parts of the mesh have ", triangles, " triangles instead of ", mesh_.all);
    mesh_.triangles = proven_triangles_ + launch_.read_word(ranks, smaller.triangles);
    launch_.run<KernelId::cadt_stitch_residual>(all.items, residual_mesh, covers, ranks, smaller.input_ids, all.grain,
                                                proven_triangles_, mesh_.vertices, mesh_.across);
    ctx_.end_phase("stitch");
    ctx_.check("stitch", 0.8);
  }

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  SortedPoints order_;
  const InputPoints& input_;
  const BuildStrategy& how_;
  const MeshUse use_;
  std::size_t n_ = order_.distinct;
  Stars stars_;
  Allocation proven_, marks_, bases_, ranks_, totals_, open_;
  Mesh mesh_;
  std::uint32_t proven_triangles_ = 0, unproven_ = 0, open_count_ = 0;
};

}  // namespace

Mesh mesh_from_stars(Context& ctx, SortedPoints points, const InputPoints& input, const BuildStrategy& how,
                     MeshUse use) {
  return StarStage(ctx, std::move(points), input, how, use).build();
}

Mesh wrap_or_insert(Context& ctx, SortedPoints points, const BuildStrategy& how, MeshUse use, std::size_t all) {
  const bool part = use == MeshUse::part;
  points.keys.release();
  std::optional<BaseMesh> base;
  if (part && points.distinct > how.most_residual_wrapped && !ctx.device.shape().contiguous) {
    base = wrap_base(ctx, points, all);
  } else if (points.distinct <= (part ? how.most_residual_wrapped : how.most_wrapped)) {
    const std::size_t of = part ? all : points.distinct;
    if (std::optional<Mesh> wrapped = wrap_mesh(ctx, points.points, points.distinct, of, part ? use : MeshUse::whole)) {
      if (!part) wrapped->points = std::move(points.points);
      wrapped->input_ids = std::move(points.input_ids);
      return std::move(*wrapped);
    }
  }
  return insert_incrementally(ctx, std::move(points), use, std::move(base));
}

}  // namespace cadt
