// SPDX-License-Identifier: Apache-2.0
#include "common/insertion/insertion.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "common/driver/choose_strategy.hpp"
#include "common/driver/counters.hpp"
#include "common/driver/device_text.hpp"
#include "common/insertion/drop_locks.hpp"
#include "common/insertion/locked_mesh.hpp"
#include "common/overlay/growth_snapshots.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

using namespace device_text;

constexpr std::size_t points_per_launch_contiguous = std::size_t{1} << 19;  // bounds the time until a cancellation
constexpr std::size_t points_per_launch_strided = std::size_t{1} << 25;
constexpr std::size_t points_per_launch_watched = std::size_t{1} << 20;  // a watchdog allows two seconds a launch
// Partitions without locks: the representatives of blocks of 2^partition_level positions are inserted before, with
// locks. The smaller a partition, the more of its points lie at its border.
constexpr unsigned partition_level = 5;
// After a base mesh, on GPUs. A launch waits for its longest chain of flips, so one of three levels takes two thirds of
// the time of three (coasts: 0.67 ms instead of 0.99). Without a base it may be a row along a curve, where several
// points beside each other at a time cause flip cascades.
constexpr unsigned levels_per_launch = 3;
constexpr int stalled_launches = 4;  // launches without progress after which one work-item does everything
constexpr int unresolvable_launches = 64;
constexpr std::size_t poll_interval = 4096;  // points inserted between two reads of what was deferred
constexpr int max_sweeps = 2000;
constexpr std::size_t sweep_counts = 5;

/// Points that one launch inserts at most.
std::size_t points_per_launch(const Device& device) {
  if (device.shape().contiguous) return points_per_launch_contiguous;
  return device.info().watchdog ? points_per_launch_watched : points_per_launch_strided;
}

static_assert(static_cast<int>(Stabilize::off) == CADT_STABILIZE_OFF &&
              static_cast<int>(Stabilize::defer) == CADT_STABILIZE_DEFER &&
              static_cast<int>(Stabilize::paper) == CADT_STABILIZE_PAPER);

class IncrementalInsertion {
 public:
  /// `points` are those of `own` where it is given, which run() needs.
  IncrementalInsertion(Context& ctx, const SortedPoints& points, SortedPoints* own = nullptr,
                       std::optional<BaseMesh> base = std::nullopt)
      : ctx_(ctx), own_(own), order_(points), base_(std::move(base)) {}

  [[nodiscard]] Mesh run(MeshUse use) {
    if (n_ >= 3 && !ctx_.device.shape().contiguous) order_by_level();
    if (n_ < 3 || !find_seed_triangle()) return Mesh::without_triangles(std::move(own_->input_ids));
    mesh_.locked = ctx_.memory.allocate_zeros(2 * n_ * sizeof(cadt_locked_triangle));  // lock word 0: not there yet
    mesh_.vertex_to_triangle = ctx_.memory.transient(n_ * word);
    make_edge_lists();
    ctx_.end_phase("seed");
    if (!inserts_serially(traits_of(ctx_.device), ctx_.options, n_) || !insert_serially()) insert_in_parallel();
    ctx_.end_phase("insert");
    LockedTriangles locked = finish(3 * std::uint64_t{n_} - 3);
    if (use != MeshUse::constrained) own_->points.release();
    const std::uint32_t unused = base_ ? static_cast<std::uint32_t>(2 * first_points() - 2) : 2 * mesh_.third;
    Mesh mesh = drop_locks(ctx_, std::move(locked), unused, std::move(own_->input_ids), use);
    mesh.points = std::move(own_->points);
    return mesh;
  }

  /// No point is located in a complete mesh: vertex_to_triangle is written by repairs only, and the seed triangle is
  /// not used.
  [[nodiscard]] LockedTriangles sweep(Allocation locked, std::uint64_t edges) {
    mesh_.locked = std::move(locked);
    mesh_.vertex_to_triangle = ctx_.memory.transient(n_ * word);
    make_edge_lists();
    return finish(edges);
  }

 private:
  void make_edge_lists() {
    for (Allocation& list : deferred_edges_) list = ctx_.memory.transient(edge_capacity_ * word);
    deferred_counts_ = launch_.zeros(CADT_DEFERRED_COUNTS + sweep_counts);
  }

  /// `edges`: of all spheres, ghost edges included. Nothing is left but the triangles.
  LockedTriangles finish(std::uint64_t edges) {
    certify(edges);
    ctx_.end_phase("certify");
    show_growth(0, true);
    counters_.collect(ctx_.statistics);
    mesh_.vertex_to_triangle.release();
    for (Allocation& list : deferred_points_) list.release();
    for (Allocation& list : deferred_edges_) list.release();
    return {std::move(mesh_.locked), std::move(mesh_.edge_flags), 2 * n_};
  }

  /// Points among which the centre lies: those of the base mesh, or all.
  [[nodiscard]] std::size_t first_points() const noexcept { return base_ ? blocks_of_level(n_, base_->level) : n_; }

  /// Levels of halving until a block is one point.
  [[nodiscard]] unsigned levels() const noexcept { return static_cast<unsigned>(std::bit_width(n_ - 1)); }

  /// Brings the points into the order of insertion (common/insertion/insert.dev.h).
  void order_by_level() {
    Allocation points = ctx_.memory.transient(n_ * point_bytes(ctx_.device)),
               input_ids = ctx_.memory.allocate(n_ * word);
    launch_.run<KernelId::cadt_by_level>(order_.points, order_.input_ids, launch_.grid(n_), points, input_ids);
    own_->points = std::move(points);
    own_->input_ids = std::move(input_ids);
    by_level_ = true;
  }

  /// Three points not on a line: the representative of all, the middle one, and the first that is not on their line.
  bool find_seed_triangle() {
    Allocation found = ctx_.memory.allocate(word);
    if (!by_level_) {
      launch_.run<KernelId::cadt_first_representative>(1, n_, levels(), found);
      mesh_.first = launch_.read_word(found, 0);
    }
    const std::size_t n = first_points();
    mesh_.second = static_cast<std::uint32_t>(n / 2);
    if (mesh_.second == mesh_.first) mesh_.second = 0;
    ctx_.device.fill(*found, 0, word, CADT_NONE);
    constexpr std::size_t few = 1024;  // enough unless nearly all points are on a line
    for (std::size_t begin = 0, end = std::min(n, few); begin < n; begin = end, end = n) {
      launch_.run<KernelId::cadt_find_seed_triangle>(order_.points, mesh_.first, mesh_.second, begin,
                                                     launch_.grid(end - begin), found);
      mesh_.third = launch_.read_word(found, 0);
      if (mesh_.third != CADT_NONE) break;
    }
    if (mesh_.third == CADT_NONE) return false;
    mesh_.center = {0, 0};
    for (const std::uint32_t at : {mesh_.first, mesh_.second, mesh_.third}) {
      const auto p = read_coordinates<2>(ctx_.device, *order_.points, at * point_bytes(ctx_.device));
      mesh_.center.x += p[0] / 3;
      mesh_.center.y += p[1] / 3;
    }
    return true;
  }

  /// One work-item inserts all points, as it does with a set of a batch (common/batch/batch_insertion.dev.h). False if
  /// it could not place one: then the mesh is empty again.
  bool insert_serially() {
    const std::array<std::uint32_t, 2> ends = {0, static_cast<std::uint32_t>(n_)};
    const Allocation starts = ctx_.memory.allocate(sizeof ends), state = launch_.zeros(1);
    static_assert(CADT_SET_BATCHED == 0);
    ctx_.device.write(*starts, 0, ends.data(), sizeof ends);
    launch_.run<KernelId::cadt_batch_insert>(1, mesh_.locked, order_.points, mesh_.vertex_to_triangle, starts, 1U,
                                             state, 1U, deferred_counts_, counters_);
    // Edges for which the worklist had no place are counted but on no list: the legality sweep finds them.
    ctx_.device.fill(*deferred_counts_, 0, CADT_DEFERRED_COUNTS * word, 0);
    if (launch_.read_word(state, 0) == CADT_SET_BATCHED) {
      ctx_.check("insert", 0.8);
      return true;
    }
    ctx_.device.fill(*mesh_.locked, 0, 2 * n_ * sizeof(cadt_locked_triangle), 0);
    counters_.clear();
    return false;
  }

  /// All work-items insert points into the same mesh, level by level.
  void insert_in_parallel() {
    // points of a launch: a level and deferred ones, of one launch or of several since the last read
    const std::size_t most = base_ ? n_ - first_points() : n_ / 2;
    const std::size_t limit = most + n_ / 32 + std::min(n_ / 2, poll_interval) + 64;
    for (Allocation& list : deferred_points_) list = ctx_.memory.transient(limit * word);
    if (base_)
      lock_base();
    else
      launch_.run<KernelId::cadt_seed_mesh>(1, mesh_);
    const unsigned last = inserts_partitions(traits_of(ctx_.device), ctx_.options, n_) ? partition_level : 0;
    for (unsigned above = base_ ? base_->level : levels(); above > last;) {
      const unsigned level = above - std::min(above - last, base_ ? levels_per_launch : 1U);
      insert_levels(above, level, last);
      above = level;
    }
    if (last != 0) insert_partitions();
    if (deferred_.points != 0 || deferred_.edges != 0) finish_deferred();
  }

  void lock_base() {
    Mesh& base = base_->mesh;
    launch_.run<KernelId::cadt_lock_base>(mesh_, base.vertices, base.across, n_, base_->level, launch_.grid(base.all));
    base.vertices.release();
    base.across.release();
  }

  /// Those below `above`, which are in the mesh, down to `level`.
  void insert_levels(unsigned above, unsigned level, unsigned last) {
    // On CPUs one level: of each block of `above` that has two halves, one.
    const std::size_t there = blocks_of_level(n_, above), first = by_level_ ? there : 0;
    const std::size_t count = blocks_of_level(n_, level) - there;
    std::size_t limit = points_per_launch(ctx_.device);
    if (ctx_.options.tuning.watch && ctx_.options.tuning.watch_points != 0)
      limit = std::min(limit, ctx_.options.tuning.watch_points);
    for (std::size_t begin = 0; begin < count; begin += limit) {
      const std::size_t size = std::min(limit, count - begin);
      launch_insert(first + begin, size, above, false);
      inserted_ += size;
      // Reading what was deferred takes as long as the launch of a level of few points.
      since_poll_ += size;
      if (since_poll_ < poll_interval && level != last && !ctx_.options.tuning.watch) {
        deferred_ = {};  // the lists [1] are done; what this launch defers stays on the lists [0]
        continue;
      }
      since_poll_ = 0;
      // A few deferred points join the next launch; many would make its walks long.
      take_deferred();
      show_growth(level, false);
      if (deferred_.points > size / 8 + 32 || deferred_.edges > size / 8 + 32) finish_deferred();
      ctx_.check("insert", 0.1 + 0.7 * static_cast<double>(inserted_) / static_cast<double>(n_));
    }
  }

  /// All levels below partition_level: partitions side by side without locks, then the border between them.
  void insert_partitions() {
    finish_deferred();  // representatives of blocks must be in the mesh
    const std::size_t all = ((n_ - 1) >> partition_level) + 1;
    const std::size_t wanted = std::clamp<std::size_t>(ctx_.device.shape().parallelism / 2, 1, n_ / least_partition);
    const std::size_t blocks = (all - 1) / wanted + 1, partitions = (all - 1) / blocks + 1;
    const std::size_t points = std::min(points_per_launch(ctx_.device), n_ / 2);
    const std::size_t step = std::max<std::size_t>((points >> partition_level) / partitions, 1);
    for (std::size_t from = 0; from < blocks; from += step) {
      const std::size_t to = std::min(blocks, from + step);
      launch_.run<KernelId::cadt_insert_partitions>(static_cast<std::uint32_t>(partitions), mesh_, n_, partition_level,
                                                    partitions, blocks, from, to, deferred_points_[0], deferred_counts_,
                                                    counters_);
      inserted_ += std::min(n_, ((to - from) * partitions) << partition_level);
      // The list has room for those that the next launch may defer.
      if (to == blocks || launch_.read_word(deferred_counts_, 0) > n_ / 32) {
        launch_.run<KernelId::cadt_border_sweep>(mesh_, launch_.grid(2 * n_), blocks << partition_level,
                                                 deferred_edges_[0], deferred_counts_, edge_capacity_, counters_);
        take_deferred();
        finish_deferred();
      }
      ctx_.check("insert", 0.1 + 0.7 * static_cast<double>(std::min(inserted_, n_)) / static_cast<double>(n_));
    }
  }

  /// `level`: of halving.
  void show_growth(unsigned level, bool complete) {
    if (!ctx_.options.tuning.watch) return;
    Snapshot snapshot;
    snapshot.level = levels() - level;
    snapshot.complete = complete;
    snapshot.waiting_points = deferred_.points;
    snapshot.waiting_edges = deferred_.edges;
    show_snapshot(ctx_, mesh_.locked, order_, counters_, snapshot);
  }

  /// Moves what the last launches deferred to the lists [1]; the lists [0] are empty then.
  void take_deferred() {
    const auto counts =
        ctx_.device.read_values(*deferred_counts_, 3);  // points, edges, work-items that changed the mesh
    deferred_ = {counts[0], std::min(counts[1], edge_capacity_), counts[2]};
    if (counts[0] == 0 && counts[1] == 0 && counts[2] == 0) return;
    ctx_.device.fill(*deferred_counts_, 0, 3 * word, 0);
    std::swap(deferred_points_[0], deferred_points_[1]);
    std::swap(deferred_edges_[0], deferred_edges_[1]);
  }

  /// Launches the deferred edges, and the deferred points with `size` others (cadt_insert). `serial`: one work-item
  /// each.
  void launch_insert(std::size_t begin, std::size_t size, unsigned above, bool serial) {
    const auto count = static_cast<std::uint32_t>(deferred_.points + size);
    const auto grid_of = [&](std::uint32_t of) { return serial ? LaunchGrid{1, of, of} : launch_.grid_spread(of); };
    if (deferred_.edges != 0)
      launch_.run<KernelId::cadt_legalize_edges>(mesh_, deferred_edges_[1], grid_of(deferred_.edges),
                                                 deferred_edges_[0], deferred_counts_, edge_capacity_, counters_);
    if (count == 0) return;
    const LaunchGrid c = grid_of(count);
    launch_.run<KernelId::cadt_insert>(c.items, mesh_, deferred_points_[1], deferred_.points, begin, count, n_, above,
                                       c.grain, deferred_points_[0], deferred_edges_[0], deferred_counts_,
                                       edge_capacity_, counters_);
  }

  /// Launches for what got no locks, until nothing is deferred.
  void finish_deferred() {
    int launches = 0, stalled = 0;
    std::size_t last = 0;
    while (deferred_.points != 0 || deferred_.edges != 0) {
      const std::size_t remaining = std::size_t{deferred_.points} + deferred_.edges;
      stalled = launches != 0 && remaining >= last && deferred_.changes == 0 ? stalled + 1 : 0;
      last = remaining;
      if (++launches > unresolvable_launches && stalled > unresolvable_launches) {
        give_up("no progress: ", deferred_.points, " points and ", deferred_.edges, " edges cannot get their locks");
      }
      // A single work-item meets no conflict, so it always makes progress.
      launch_insert(0, 0, 0, stalled >= stalled_launches);
      take_deferred();
    }
  }

  /// Legality sweeps until one finds nothing to repair.
  void certify(std::uint64_t edges) {
    if (ctx_.options.tuning.stabilize == Stabilize::defer)
      mesh_.stabilize = CADT_STABILIZE_OFF;  // flips deferred until now are due
    const std::size_t slots = 2 * n_, limit = 4 * points_per_launch(ctx_.device);
    for (int sweep = 1; sweep <= max_sweeps; ++sweep) {
      std::uint64_t examined = 0, illegal = 0, unsettled = 0, stabilized = 0, broken = 0;
      for (std::size_t begin = 0; begin < slots; begin += limit) {
        const std::size_t size = std::min(limit, slots - begin);
        launch_.run<KernelId::cadt_legality_sweep>(mesh_, begin, launch_.grid_strided(size), by_level_ ? n_ : 0,
                                                   deferred_edges_[0], deferred_counts_, edge_capacity_, counters_);
        const auto words = ctx_.device.read_values(*deferred_counts_, sweep_counts, CADT_DEFERRED_COUNTS);
        examined += words[0];
        illegal += words[1];
        unsettled += words[2];
        stabilized += words[3];
        broken += words[4];
        if (begin + size == slots && examined == edges && illegal + unsettled == 0) break;
        ctx_.device.fill(*deferred_counts_, CADT_DEFERRED_COUNTS * word, sweep_counts * word, 0);
        take_deferred();
        finish_deferred();
        ctx_.check("certify", 0.8 + 0.1 * static_cast<double>(begin + size) / static_cast<double>(slots));
      }
      Statistics& statistics = ctx_.statistics;  // of all meshes of the call, if there are several
      statistics.legality_sweeps = std::max(statistics.legality_sweeps, static_cast<std::uint64_t>(sweep));
      statistics.sweep_repairs += illegal;
      if (illegal == 0 && unsettled == 0) {
        if (broken != 0) give_up("the boundary of the mesh turns back at ", broken, " points");
        statistics.certified_edges += examined - stabilized;
        statistics.illegal_edges += stabilized;
        statistics.certified = statistics.certified && stabilized == 0;
        if (examined != edges) {
          give_up("the mesh has ", examined, " edges instead of ", edges);
        }
        return;
      }
    }
    give_up("the legality sweep still finds illegal edges after ", max_sweeps, " sweeps");
  }

  struct Deferred {
    std::uint32_t points = 0, edges = 0;
    std::uint32_t changes = 0;  ///< work-items that changed the mesh, if the launch had deferred points only
  };

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  SortedPoints* own_;
  const SortedPoints& order_;
  std::size_t n_ = order_.distinct;
  std::uint32_t edge_capacity_ = static_cast<std::uint32_t>(n_ / 8 + 4096);
  Counters counters_{ctx_, counted_lost_locks(ctx_.options, order_)};
  LockedMesh mesh_{ctx_, order_, static_cast<std::uint32_t>(ctx_.options.tuning.stabilize)};
  std::optional<BaseMesh> base_;
  Allocation deferred_counts_;
  std::array<Allocation, 2> deferred_points_, deferred_edges_;  // [0] is written by the next launch, [1] read by it
  Deferred deferred_;                                           // on the lists [1]
  bool by_level_ = false;                                       // the points are in the order of insertion
  std::size_t inserted_ = 0, since_poll_ = 0;                   // since_poll_: since what was deferred was read
};

}  // namespace

std::size_t slots_per_launch(const Device& device) { return 4 * points_per_launch(device); }

Mesh insert_incrementally(Context& ctx, SortedPoints points, MeshUse use, std::optional<BaseMesh> base) {
  points.keys.release();
  return IncrementalInsertion(ctx, points, &points, std::move(base)).run(use);
}

LockedTriangles sweep_legality(Context& ctx, const SortedPoints& points, Allocation locked, std::uint64_t edges) {
  return IncrementalInsertion(ctx, points).sweep(std::move(locked), edges);
}

}  // namespace cadt
