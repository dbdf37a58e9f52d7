// SPDX-License-Identifier: Apache-2.0
#include "common/batch/batch_mesh.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/driver/choose_strategy.hpp"
#include "common/driver/counters.hpp"
#include "common/driver/device_text.hpp"
#include "common/stars/local_stars.hpp"
#include "common/stars/wrap.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// Words a vertex for stars with more star vertices than fit into a row. Stars with more than 12 have fewer than 3.9 a
/// vertex in all, since the average of all stars is 6 and none has fewer than 3.
constexpr std::size_t long_star_words = 4;

class BatchStage {
 public:
  BatchStage(Context& ctx, SortedBatch& sets) : ctx_(ctx), sets_(sets) {}

  [[nodiscard]] BatchMesh build() {
    read_sets();
    // One core inserts faster where it has a set for itself.
    const bool insertion = inserts_batched_sets(traits_of(ctx_.device), ctx_.options);
    if (batched_ != 0 && !insertion) {
      make_stars();
      wrap();
      count_triangles();
    }
    locked_ = ctx_.memory.allocate_zeros(2 * n_ * sizeof(cadt_locked_triangle));  // lock word 0: slot not in use
    if (batched_ != 0) {
      insertion ? insert() : write_locked();
      certify();
    }
    build_individual();
    drop_locks();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::uint32_t points_of(std::size_t set) const noexcept {
    return result_.positions[set + 1] - result_.positions[set];
  }

  void read_sets() {
    result_.positions = ctx_.device.read_values(*sets_.positions(), set_count_ + 1);
    read_states();
    for (std::size_t s = 0; s < set_count_; ++s) {
      if (states_[s] != CADT_SET_BATCHED) continue;
      ++batched_;
      vertices_ += points_of(s);
    }
  }

  void read_states() { states_ = ctx_.device.read_values(*sets_.states, set_count_); }

  void make_stars() {
    const unsigned levels = order_.grid.levels();
    Allocation keys = std::move(order_.keys), none;
    if (!keys) {
      keys = ctx_.memory.allocate(n_ * word);
      launch_.run<KernelId::cadt_batch_keys>(order_.points, sets_.positions(), set_count_, sets_.sets, levels, true,
                                             keys, launch_.grid(n_));
    }
    const std::optional<TileList> tiles = make_tiles(ctx_, {keys, none}, n_, levels, least_points_of_tile);
    ctx_.end_phase("tiles");
    ctx_.check("stars", 0.1);
    stars_.star_vertices = ctx_.memory.allocate(n_ * (CADT_STAR_DEGREE + long_star_words) * word);
    stars_.sizes = ctx_.memory.allocate_zeros(n_ * word);
    if (tiles) prove_stars(ctx_, order_, {keys, none}, sets_.sets, sets_.states, *tiles, false, stars_);
    ctx_.end_phase("stars");
    ctx_.check("stars", 0.4);
  }

  /// Wraps the stars that are not proven.
  void wrap() {
    const LaunchGrid all = launch_.grid(n_);
    begins_ = ctx_.memory.allocate(n_ * word);
    Allocation ranks = ctx_.memory.allocate((n_ + 1) * word);
    launch_.run<KernelId::cadt_batch_unproven>(stars_.sizes, sets_.positions(), set_count_, sets_.states, all,
                                               static_cast<std::uint32_t>(CADT_STAR_DEGREE), ranks, begins_);
    launch_.scan(ranks, n_ + 1);
    unproven_ = launch_.read_word(ranks, n_);
    ctx_.statistics.proven_stars += vertices_ - unproven_;
    if (unproven_ == 0) return;
    const Allocation list = ctx_.memory.allocate(std::size_t{unproven_} * word);
    launch_.run<KernelId::cadt_batch_list>(ranks, list, all);
    ranks.release();
    const Allocation counts = launch_.zeros(CADT_WRAP_WORDS);
    wrap_batch(ctx_, order_.points, n_, list, unproven_, {sets_.positions(), set_count_, sets_.states},
               {CADT_STAR_DEGREE, stars_.star_vertices, n_ * (CADT_STAR_DEGREE + long_star_words), begins_,
                stars_.sizes, counts});
    const std::vector<std::uint32_t> words = ctx_.device.read_values(*counts, CADT_WRAP_DRIVER_WORDS);
    add_exact_tests(ctx_.statistics, std::span(words).subspan<CADT_WRAP_EXACT_ORIENTATIONS, 3>());
    if (words[CADT_WRAP_OVERFLOWED] > n_ * long_star_words)
      give_up("the wrapped stars have ", words[CADT_WRAP_OVERFLOWED], " neighbours beyond their rows");
    ctx_.end_phase("wrap");
    ctx_.check("stars", 0.6);
  }

  void count_triangles() {
    bases_ = ctx_.memory.allocate((n_ + 1) * word);
    launch_.run<KernelId::cadt_batch_counts>(stars_.star_vertices, begins_, stars_.sizes, sets_.positions(), set_count_,
                                             sets_.states, launch_.grid(n_), bases_);
    launch_.scan(bases_, n_ + 1);
    const Allocation wrong = launch_.zeros(1);
    const LaunchGrid each = launch_.grid(set_count_ + 1);
    launch_.run<KernelId::cadt_batch_check>(each.items, sets_.positions(), set_count_, bases_, each.grain, wrong);
    if (const std::uint32_t sets = launch_.read_word(wrong, 0); sets != 0)
      give_up("stars contradict each other in or before ", sets, " sets");
    read_states();
    ctx_.statistics.wrapped_stars += unproven_;
    for (const std::uint32_t state : states_) ctx_.statistics.wrapped_stars -= state / CADT_SET_FAILURE;
  }

  void write_locked() {
    const LaunchGrid shares = launch_.grid(n_ * CADT_WRAP_SHARES);
    launch_.run<KernelId::cadt_batch_locked>(shares.items, stars_.star_vertices, begins_, stars_.sizes, bases_, n_,
                                             shares.grain, locked_);
    stars_ = {};
    begins_.release();
    bases_.release();
    ctx_.end_phase("assemble");
    ctx_.check("stitch", 0.7);
  }

  void insert() {
    order_.keys.release();
    const Counters counters(ctx_);
    const Allocation vertex_to_triangle = ctx_.memory.allocate(n_ * word), deferred_counts = launch_.zeros(3);
    // Small pieces, since sets differ in size.
    const std::size_t pieces = std::size_t{16} * ctx_.device.shape().parallelism,
                      grain = std::min<std::size_t>(set_count_ / pieces, 256) + 1;
    launch_.run<KernelId::cadt_batch_insert>(static_cast<std::uint32_t>((set_count_ - 1) / grain + 1), locked_,
                                             order_.points, vertex_to_triangle, sets_.positions(), set_count_,
                                             sets_.states, grain, deferred_counts, counters);
    counters.collect(ctx_.statistics);
    read_states();
    ctx_.end_phase("insert");
    ctx_.check("insert", 0.7);
  }

  void certify() {
    std::uint64_t edges = 0;
    for (std::size_t s = 0; s < set_count_; ++s) {
      if (states_[s] != CADT_SET_BATCHED) continue;
      edges += 3 * std::uint64_t{points_of(s)} - 3;
      ++ctx_.statistics.batched_sets;
    }
    locked_ = std::move(sweep_legality(ctx_, order_, std::move(locked_), edges).triangles);
  }

  void drop_locks() {
    std::vector<std::uint32_t> first_slots = result_.positions;  // two a vertex
    for (std::uint32_t& slot : first_slots) slot *= 2;
    order_.points.release();
    result_.mesh =
        drop_locks_of_sets(ctx_, {std::move(locked_), {}, 2 * n_}, first_slots, order_.input_ids, result_.set_starts);
  }

  /// Individually: sets classified so, and those with a vertex without a star.
  void build_individual() {
    const Allocation none;
    for (std::size_t s = 0; s < set_count_; ++s) {
      if (states_[s] == CADT_SET_BATCHED) continue;
      const std::uint32_t size = points_of(s), begin = result_.positions[s];
      if (size < 3 || states_[s] == CADT_SET_FLAT) continue;
      ctx_.check("insert", 0.8);
      launch_.set_variant(states_[s] == CADT_SET_WIDE ? KernelVariant::wide : narrow_variant(ctx_.options.statistics));
      ctx_.statistics.wide_arithmetic = ctx_.statistics.wide_arithmetic || states_[s] == CADT_SET_WIDE;
      SortedPoints one;
      one.distinct = size;
      one.points = ctx_.memory.allocate(size * sizeof(cadt_point));
      one.input_ids = ctx_.memory.allocate(size * word);  // positions in the set
      launch_.run<KernelId::cadt_identity>(one.input_ids, launch_.grid(size));
      launch_.run<KernelId::cadt_batch_extract>(order_.points, begin, launch_.grid(size), one.points);
      const Mesh mesh = insert_incrementally(ctx_, std::move(one), MeshUse::part);
      launch_.set_variant(narrow_variant(ctx_.options.statistics));
      if (mesh.flat) continue;
      const LaunchGrid all = launch_.grid(mesh.all);
      launch_.run<KernelId::cadt_batch_store>(all.items, view_of(mesh, none), mesh.input_ids, begin, all.grain,
                                              locked_);
    }
  }

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  SortedBatch& sets_;
  SortedPoints& order_ = sets_.order;
  std::size_t n_ = order_.distinct, set_count_ = sets_.starts.count;
  std::uint32_t unproven_ = 0;
  std::size_t batched_ = 0, vertices_ = 0;  ///< batched sets after classification, and their vertices
  std::vector<std::uint32_t> states_;
  Stars stars_;
  Allocation begins_, bases_, locked_;
  BatchMesh result_;
};

}  // namespace

BatchMesh build_batch(Context& ctx, SortedBatch& sets) { return BatchStage(ctx, sets).build(); }

}  // namespace cadt
