// SPDX-License-Identifier: Apache-2.0
#include "common/host/star_stage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/host/certify.hpp"
#include "common/host/counters.hpp"
#include "common/host/device_constants.hpp"
#include "common/host/tiles.hpp"
#include "common/host/wrap_mesh.hpp"

namespace cadt {
namespace {

using namespace device_constants;

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr unsigned most_bits = 26;  // of an axis: cells of a window are counted in 32 bits, see CADT_WINDOW_ERROR too

/// With more than a third unproven the rest would need more memory than insertion of all points, and as much time.
constexpr bool too_many(std::size_t unproven, std::size_t points) { return 3 * unproven > points; }

/// Edges between the two parts have a list and a hash table.
constexpr bool too_many_open(std::size_t open, std::size_t points) { return 2 * open > points; }

/// The vertices of the mesh take the place of the stars in so many steps where memory is to be saved.
constexpr std::uint32_t waves = 4;

/// How many points are wrapped, rather than inserted or given to the star stage.
std::size_t most_wrapped_of(const Run& run, const SpatialOrder& order) {
  const std::size_t most = most_wrapped(run.device);
  if (run.options.strategy != Strategy::automatic) return most;
  if (order.shapes.on_circles) return std::min(most, most_wrapped_on_circles);
  if (order.shapes.on_lattice) return std::min(most, most_wrapped_on_lattice);
  return order.shapes.on_ring ? std::min(most, most_wrapped_on_ring) : most;
}

/// The mesh without the star stage: by gift wrapping if the points are few, else by insertion.
DeviceMesh build_without_stars(Run& run, SpatialOrder& order) {
  std::optional<DeviceMesh> wrapped;
  if (order.distinct <= most_wrapped_of(run, order)) wrapped = wrap_mesh(run, order);
  return wrapped ? std::move(*wrapped) : build_mesh(run, order);
}

/// The same for a part of a mesh of `all` points that is certified as a whole: in records, without a closing pass where
/// that is no use.
DeviceMesh build_part(Run& run, SpatialOrder& order, std::size_t all) {
  std::optional<DeviceMesh> wrapped;
  if (order.distinct <= most_wrapped(run.device)) wrapped = wrap_part(run, order.points, order.distinct, all);
  return wrapped ? std::move(*wrapped) : build_mesh(run, order);
}

class StarStage {
 public:
  StarStage(Run& run, SpatialOrder& order)
      : run_(run),
        launch_(run.launcher),
        order_(order),
        n_(order.distinct),
        count_(static_cast<std::uint32_t>(n_)),
        keys_(std::move(order.keys)) {}

  [[nodiscard]] DeviceMesh build() {
    const bool made = make_stars();
    keys_.release();
    if (!made) {
      release_stars();
      return build_without_stars(run_, order_);
    }
    count_triangles();
    if (too_many(unproven_, n_) || too_many_open(open_count_, n_)) {
      release_stars();
      ranks_.release();
      return build_without_stars(run_, order_);
    }
    // stars that contradict each other would number more
    if (proven_triangles_ > 2 * n_ - 2)
      throw InternalError("the proven stars have " + std::to_string(proven_triangles_) + " triangles, more than " +
                          std::to_string(2 * n_ - 2) + "; please report this with the input");
    run_.statistics.proven_stars = n_ - unproven_;
    SpatialOrder rest = take_unproven();
    if (order_.points_again) order_.points.release();
    write_triangles();
    release_stars();
    join(rest);
    if (!order_.points) order_.points = order_.points_again(order_);
    certify_arrays(run_, order_, mesh_);
    return std::move(mesh_);
  }

 private:
  /// False if there are no tiles, or too few stars.
  bool make_stars() {
    const KeyGrid& grid = order_.grid;
    Allocation low;
    if (!keys_) {
      keys_ = run_.memory.borrow(n_ * word);
      if (grid.fine_levels != 0) {
        low = run_.memory.borrow(n_ * word);
        make_fine_keys(run_, order_.points, keys_, low, n_, grid);
      } else {
        make_keys(run_, order_.points, keys_, n_, grid);
      }
    }
    const SortKeys keys{keys_, low, 2 * grid.fine_levels};
    const bool automatic = run_.options.strategy == Strategy::automatic;
    const std::optional<TileList> tiles =
        make_tiles(run_, keys, n_, grid.levels(), automatic ? least_points_of_tile : 0);
    run_.end_phase("tiles");
    if (!tiles) return false;
    run_.check("stars", 0.1);
    stars_ = make_star_list(run_, n_, *tiles);
    const StarCounts found = run_stars(run_, order_, keys, {}, {}, *tiles, automatic, stars_);
    found.add_to(run_.statistics);
    run_.end_phase("stars");
    run_.check("stars", 0.5);
    return found.left_tiles == 0 && !too_many(found.unproven, n_);
  }

  void count_triangles() {
    // All but one of the buffers that lend are taken as a whole while the bases are here; to save memory, there is one.
    const std::size_t bases = (n_ + 1) * word;
    bases_ = run_.saves_memory ? run_.memory.allocate_once(bases) : run_.memory.borrow(bases);
    ranks_ = run_.memory.borrow((n_ + 1) * word);
    totals_ = launch_.zeros(2);
    const Cut c = launch_.cut(n_);
    const std::size_t words = (n_ - 1) / 32 + 1;
    proven_ = run_.memory.allocate(words * word);
    const std::size_t marks = n_ * sizeof(std::uint16_t);
    marks_ = run_.saves_memory ? run_.memory.allocate_once(marks) : run_.memory.allocate(marks);
    const Cut of_words = launch_.cut(words);
    launch_.run(KernelId::cadt_star_proven, of_words.items, stars_.sizes, count_, static_cast<std::uint32_t>(words),
                of_words.grain, proven_);
    launch_.run(KernelId::cadt_star_counts, c.items, stars_.links, stars_.begins, stars_.sizes, proven_, count_,
                c.grain, marks_, bases_, ranks_, totals_);
    stars_.sizes.release();
    launch_.scan(bases_, n_ + 1);
    launch_.scan(ranks_, n_ + 1);
    proven_triangles_ = launch_.read_word(bases_, n_);
    unproven_ = launch_.read_word(ranks_, n_);
    open_count_ = launch_.read_word(totals_, 0);
  }

  /// The vertices without a star, and in place of labels their positions.
  [[nodiscard]] SpatialOrder take_unproven() {
    SpatialOrder rest;
    rest.distinct = unproven_;
    rest.points = run_.memory.allocate(unproven_ * sizeof(cadt_point));
    rest.labels = run_.memory.allocate(unproven_ * word);
    const Cut all = launch_.cut(n_);
    launch_.run(KernelId::cadt_unproven_pack, all.items, ranks_, order_.points, rest.points, rest.labels, count_,
                all.grain);
    ranks_.release();
    return rest;
  }

  /// Links and vertices of the triangles with a proven vertex.
  void write_triangles() {
    const std::size_t bytes = 3 * (2 * n_ - 2) * word;
    const std::uint32_t groups = (count_ - 1) / CADT_RECORD_LANES + 1;
    const Cut c = launch_.cut_teams(groups, CADT_RECORD_LANES);
    mesh_.links = run_.memory.allocate(bytes);
    open_ = run_.memory.allocate(std::size_t{open_count_} * word);
    const Allocation firsts = run_.memory.allocate((groups + std::size_t{1}) * word);
    launch_.run(KernelId::cadt_star_links, c.items, stars_.links, stars_.begins, marks_, bases_, proven_, count_,
                groups, c.grain, mesh_.links, firsts, open_, totals_);
    bases_.release();
    if (!run_.saves_memory || !write_vertices_in_place(firsts, groups)) {
      mesh_.vertices = run_.memory.allocate(bytes);
      write_vertices(firsts, 0, groups, mesh_.vertices);
    }
    run_.end_phase("records");
  }

  void write_vertices(const Allocation& firsts, std::uint32_t from, std::uint32_t groups, const Allocation& to) {
    const Cut c = launch_.cut_teams(groups, CADT_RECORD_LANES);
    launch_.run(KernelId::cadt_star_vertices, c.items, stars_.links, stars_.begins, marks_, firsts, count_, from,
                groups, c.grain, to);
  }

  /// To where the stars are. Both are in the order of the points, six words a point, and there are some more before and
  /// between the stars of the tiles: a share of the vertices, put together elsewhere, has room where no star is that is
  /// still to be read. False if that is not so: where most triangles belong to the first of the points.
  bool write_vertices_in_place(const Allocation& firsts, std::uint32_t groups) {
    const std::uint32_t share = (groups - 1) / waves + 1;
    std::vector<std::uint32_t> cuts;  // first triangles
    std::size_t most = 0;
    for (std::uint32_t from = 0; from < groups; from += share) {
      cuts.push_back(launch_.read_word(firsts, from));
      if (from == 0) continue;
      most = std::max<std::size_t>(most, cuts.back() - cuts[cuts.size() - 2]);
      const std::size_t begin = std::size_t{from} * CADT_RECORD_LANES;
      const std::size_t tile = begin - std::min<std::size_t>(begin, CADT_TILE_POINTS);  // or later
      if (std::size_t{3} * cuts.back() > CADT_STAR_LEAD + 6 * tile + tile / 8) return false;
    }
    cuts.push_back(proven_triangles_);
    most = std::max<std::size_t>(most, cuts.back() - cuts[cuts.size() - 2]);
    const Allocation together = run_.memory.borrow(3 * most * word);
    std::uint32_t from = 0;
    for (std::size_t wave = 0; wave + 1 < cuts.size(); ++wave, from += share) {
      write_vertices(firsts, from, std::min(share, groups - from), together);
      const std::uint32_t words = 3 * (cuts[wave + 1] - cuts[wave]);
      const Cut c = launch_.cut(words);
      launch_.run(KernelId::cadt_copy_words, c.items, together, stars_.links, 3 * cuts[wave], words, c.grain);
    }
    mesh_.vertices = std::move(stars_.links);
    return true;
  }

  void release_stars() {
    stars_ = {};
    marks_.release();
    proven_.release();
    bases_.release();
  }

  void join(SpatialOrder& rest) {
    // The place of the stars is free now, unless it became that of the mesh.
    const Memory::BorrowAll borrows(run_.memory, !run_.saves_memory);
    const std::uint64_t certified = run_.statistics.certified_edges;
    const DeviceMesh smaller = build_part(run_, rest, n_);
    run_.statistics.certified_edges = certified;  // those of the whole mesh count
    if (smaller.flat) throw InternalError("the unproven vertices are on a line; please report this with the input");

    const std::size_t places = std::bit_ceil(2 * std::size_t{open_count_} + 2);
    const auto mask = static_cast<std::uint32_t>(places - 1), slots = static_cast<std::uint32_t>(smaller.slots);
    Allocation table = run_.memory.allocate(places * word);
    run_.device.fill(*table, 0, places * word, CADT_NONE);
    const Cut open = launch_.cut(open_count_);
    launch_.run(KernelId::cadt_join_enter, open.items, mesh_.vertices, open_, open_count_, open.grain, table, mask);
    Allocation covers = run_.memory.allocate(3 * smaller.slots * word),
               roots = run_.memory.allocate(smaller.slots * word);
    const Cut c = launch_.cut(smaller.slots);
    launch_.run(KernelId::cadt_join_cover, c.items, mesh_.vertices, smaller.records, rest.labels, slots, c.grain, table,
                mask, covers, roots);
    launch_.run(KernelId::cadt_join_components, c.items, smaller.records, slots, c.grain, covers, roots);
    Allocation hidden = launch_.zeros(smaller.slots), ranks = run_.memory.allocate((2 * smaller.slots + 1) * word);
    launch_.run(KernelId::cadt_join_hide, c.items, covers, roots, slots, c.grain, hidden);
    launch_.run(KernelId::cadt_join_flags, c.items, smaller.records, roots, hidden, slots, c.grain, ranks);
    launch_.scan(ranks, 2 * smaller.slots + 1);
    const std::size_t triangles = std::size_t{proven_triangles_} + launch_.read_word(ranks, 2 * smaller.slots);
    if (triangles != 2 * n_ - 2)
      throw InternalError("the two parts of the mesh have " + std::to_string(triangles) + " triangles instead of " +
                          std::to_string(2 * n_ - 2) + "; please report this with the input");
    mesh_.slots = triangles;
    mesh_.triangles = proven_triangles_ + launch_.read_word(ranks, smaller.slots);
    const FlipCounts flips(run_);
    const Cut strided = launch_.cut_strided(smaller.slots);
    launch_.run(KernelId::cadt_join_rest, strided.items, smaller.records, covers, ranks, rest.labels, slots,
                strided.grain, proven_triangles_, mesh_.vertices, mesh_.links, flips);
    // triangles and ghosts have 3 and 1 sides that count
    flips.collect(run_.statistics, 3 * std::uint64_t{mesh_.triangles} + (mesh_.slots - mesh_.triangles));
    run_.end_phase("join");
    run_.check("join", 0.8);
  }

  Run& run_;
  Launcher& launch_;
  SpatialOrder& order_;
  std::size_t n_;
  std::uint32_t count_;
  StarList stars_;
  Allocation keys_, proven_, marks_, bases_, ranks_, totals_, open_;
  DeviceMesh mesh_;
  std::uint32_t proven_triangles_ = 0, unproven_ = 0, open_count_ = 0;
};

}  // namespace

DeviceMesh build_mesh_with_stars(Run& run, SpatialOrder& order) {
  KeyGrid& grid = order.grid;
  const int too_fine = static_cast<int>(std::max(grid.bits_x, grid.bits_y)) - static_cast<int>(most_bits);
  if (too_fine > 0 && grid.fine_levels != 0) grid = grid.finer(-std::min(too_fine, static_cast<int>(grid.fine_levels)));
  const bool automatic = run.options.strategy == Strategy::automatic;
  const PointShapes& shapes = order.shapes;
  // There are no triangles, or rounded numbers find few.
  const bool convex = (shapes.on_circle && order.distinct > CADT_WRAP_HULL_EXACT) ||
                      (shapes.on_hull && order.distinct > CADT_WRAP_HULL);
  const bool insert = automatic && (shapes.on_line || convex || shapes.on_rays);
  if (order.wide || insert) {
    order.keys.release();
    return build_mesh(run, order);
  }
  const bool without = automatic && (shapes.crowded || order.distinct <= most_wrapped_of(run, order));
  if (without || order.distinct < 3 || std::max(grid.bits_x, grid.bits_y) > most_bits) {
    order.keys.release();
    return build_without_stars(run, order);
  }
  return StarStage(run, order).build();
}

}  // namespace cadt
