// SPDX-License-Identifier: Apache-2.0
#include "common/host/set_mesh.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "common/host/counters.hpp"
#include "common/host/device_constants.hpp"
#include "common/host/tiles.hpp"
#include "common/host/wrap_mesh.hpp"

namespace cadt {
namespace {

using namespace device_constants;

constexpr std::size_t word = sizeof(std::uint32_t);

/// Words a vertex for stars with more neighbours than fit into a row. Those of more than 12 are less than 3.9 a vertex
/// together, since all are 6 on average and none is below 3.
constexpr std::size_t long_star_words = 4;

class SetStage {
 public:
  SetStage(Run& run, SetOrder& sets)
      : run_(run),
        launch_(run.launcher),
        sets_(sets),
        order_(sets.order),
        n_(order_.distinct),
        count_(static_cast<std::uint32_t>(n_)),
        set_count_(static_cast<std::uint32_t>(sets.starts.count)) {}

  [[nodiscard]] SetMesh build() {
    read_sets();
    result_.mesh.slots = 2 * n_;
    // One core is better at insertion, where it has a set for itself.
    const bool insertion = run_.device.shape().contiguous && run_.options.strategy != Strategy::stars;
    if (together_ != 0 && !insertion) {
      make_stars();
      wrap();
      count_triangles();
    }
    result_.mesh.records = run_.memory.allocate_zeros(2 * n_ * sizeof(cadt_record));  // lock word 0: not in use
    if (together_ != 0) {
      insertion ? insert() : write_records();
      certify();
    }
    build_others();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::uint32_t points_of(std::size_t set) const noexcept {
    return result_.positions[set + 1] - result_.positions[set];
  }

  void read_sets() {
    states_.resize(set_count_);
    result_.positions.resize(set_count_ + std::size_t{1});
    run_.device.read(*sets_.positions(), 0, result_.positions.data(), result_.positions.size() * word);
    read_states();
    for (std::size_t s = 0; s < set_count_; ++s) {
      if (states_[s] != CADT_SET_TOGETHER) continue;
      ++together_;
      vertices_ += points_of(s);
    }
  }

  void read_states() { run_.device.read(*sets_.states, 0, states_.data(), states_.size() * word); }

  void make_stars() {
    const unsigned levels = order_.grid.levels();
    const Cut c = launch_.cut(n_);
    Allocation keys = std::move(order_.keys), none;
    if (!keys) {
      keys = run_.memory.allocate(n_ * word);
      launch_.run(KernelId::cadt_set_keys, c.items, order_.points, sets_.positions(), set_count_, sets_.sets,
                  static_cast<std::uint32_t>(levels), 1U, keys, count_, c.grain);
    }
    const std::optional<TileList> tiles = make_tiles(run_, {keys, none}, n_, levels, least_points_of_tile);
    run_.end_phase("tiles");
    run_.check("stars", 0.1);
    stars_.links = run_.memory.allocate(n_ * (CADT_STAR_DEGREE + long_star_words) * word);
    stars_.sizes = run_.memory.allocate_zeros(n_ * word);
    if (tiles)
      run_stars(run_, order_, {keys, none}, sets_.sets, sets_.states, *tiles, false, stars_).add_to(run_.statistics);
    run_.end_phase("stars");
    run_.check("stars", 0.4);
  }

  /// The stars that are not proven.
  void wrap() {
    const Cut c = launch_.cut(n_);
    begins_ = run_.memory.allocate(n_ * word);
    Allocation ranks = run_.memory.allocate((n_ + 1) * word);
    launch_.run(KernelId::cadt_set_unproven, c.items, stars_.sizes, sets_.positions(), set_count_, sets_.states, count_,
                c.grain, static_cast<std::uint32_t>(CADT_STAR_DEGREE), ranks, begins_);
    launch_.scan(ranks, n_ + 1);
    unproven_ = launch_.read_word(ranks, n_);
    run_.statistics.proven_stars += vertices_ - unproven_;
    if (unproven_ == 0) return;
    const Allocation list = run_.memory.allocate(std::size_t{unproven_} * word);
    launch_.run(KernelId::cadt_set_list, c.items, ranks, list, count_, c.grain);
    ranks.release();
    const Allocation found = launch_.zeros(CADT_WRAP_WORDS);
    wrap_sets(
        run_, order_.points, n_, {list, unproven_, sets_.positions(), sets_.states, set_count_},
        {stars_.links, begins_, stars_.sizes, found, CADT_STAR_DEGREE, n_ * (CADT_STAR_DEGREE + long_star_words)});
    std::array<std::uint32_t, CADT_WRAP_FOUND> words{};
    run_.device.read(*found, 0, words.data(), sizeof words);
    run_.statistics.exact_orientations += words[3];
    run_.statistics.exact_incircles += words[4];
    run_.statistics.ties += words[5];
    if (words[0] > n_ * long_star_words)
      throw InternalError("the wrapped stars have " + std::to_string(words[0]) +
                          " neighbours beyond their rows; please report this with the input");
    run_.end_phase("wrap");
    run_.check("stars", 0.6);
  }

  void count_triangles() {
    bases_ = run_.memory.allocate((n_ + 1) * word);
    const Cut c = launch_.cut(n_), each = launch_.cut(set_count_ + std::size_t{1});
    launch_.run(KernelId::cadt_set_counts, c.items, stars_.links, begins_, stars_.sizes, sets_.positions(), set_count_,
                sets_.states, count_, c.grain, bases_);
    launch_.scan(bases_, n_ + 1);
    const Allocation wrong = launch_.zeros(1);
    launch_.run(KernelId::cadt_set_check, each.items, sets_.positions(), set_count_, bases_, each.grain, wrong);
    if (const std::uint32_t sets = launch_.read_word(wrong, 0); sets != 0)
      throw InternalError("stars contradict each other in or before " + std::to_string(sets) +
                          " sets; please report this with the input");
    read_states();
    run_.statistics.wrapped_stars += unproven_;
    for (const std::uint32_t state : states_) run_.statistics.wrapped_stars -= state / CADT_SET_FAILURE;
  }

  void write_records() {
    const Cut shares = launch_.cut(n_ * CADT_WRAP_SHARES);
    const Allocation edges;  // there are no hubs
    launch_.run(KernelId::cadt_wrap_records, shares.items, stars_.links, begins_, stars_.sizes, bases_, edges, 0U, 0U,
                0U, 0U, count_, shares.grain, result_.mesh.records);
    stars_ = {};
    begins_.release();
    bases_.release();
    run_.end_phase("records");
    run_.check("join", 0.7);
  }

  void insert() {
    order_.keys.release();
    const Counters counters(run_);
    const Allocation hints = run_.memory.allocate(n_ * word), left_counts = launch_.zeros(3);
    // Small pieces, since sets are not alike.
    const std::uint32_t pieces = 16 * run_.device.shape().parallelism, grain = std::min(set_count_ / pieces, 256U) + 1;
    launch_.run(KernelId::cadt_set_insert, (set_count_ - 1) / grain + 1, result_.mesh.records, order_.points, hints,
                sets_.positions(), set_count_, sets_.states, grain, left_counts, counters);
    counters.collect(run_.statistics);
    read_states();
    run_.end_phase("insert");
    run_.check("insert", 0.7);
  }

  void certify() {
    std::uint64_t edges = 0;
    for (std::size_t s = 0; s < set_count_; ++s) {
      if (states_[s] != CADT_SET_TOGETHER) continue;
      edges += 3 * std::uint64_t{points_of(s)} - 3;
      ++run_.statistics.sets_together;
    }
    result_.mesh = certify_mesh(run_, order_, std::move(result_.mesh.records), edges);
  }

  /// One by one: sets that are alone from the beginning, or one of whose stars was not found.
  void build_others() {
    result_.flat.assign(set_count_, false);
    for (std::size_t s = 0; s < set_count_; ++s) {
      if (states_[s] == CADT_SET_TOGETHER) continue;
      const std::uint32_t size = points_of(s), begin = result_.positions[s];
      if (size < 3 || states_[s] == CADT_SET_FLAT) {
        result_.flat[s] = true;
        continue;
      }
      run_.check("insert", 0.8);
      launch_.set_build(states_[s] == CADT_SET_WIDE ? KernelBuild::wide : narrow_build(run_.options.statistics));
      run_.statistics.wide_arithmetic = run_.statistics.wide_arithmetic || states_[s] == CADT_SET_WIDE;
      SpatialOrder one;
      one.distinct = size;
      one.points = run_.memory.allocate(size * sizeof(cadt_point));
      one.labels = run_.memory.allocate(size * word);  // positions
      const Cut c = launch_.cut(size);
      launch_.run(KernelId::cadt_identity, c.items, one.labels, size, c.grain);
      launch_.run(KernelId::cadt_set_points, c.items, order_.points, begin, size, c.grain, one.points);
      const DeviceMesh mesh = build_mesh(run_, one);
      launch_.set_build(narrow_build(run_.options.statistics));
      result_.flat[s] = mesh.flat;
      if (mesh.flat) continue;
      const Cut slots = launch_.cut(mesh.slots);
      launch_.run(KernelId::cadt_set_records, slots.items, mesh.records, one.labels,
                  static_cast<std::uint32_t>(mesh.slots), begin, slots.grain, result_.mesh.records);
    }
  }

  Run& run_;
  Launcher& launch_;
  SetOrder& sets_;
  SpatialOrder& order_;
  std::size_t n_;
  std::uint32_t count_, set_count_, unproven_ = 0;
  std::size_t together_ = 0, vertices_ = 0;  ///< sets that are together at first, and their vertices
  std::vector<std::uint32_t> states_;
  StarList stars_;
  Allocation begins_, bases_;
  SetMesh result_;
};

}  // namespace

SetMesh build_sets(Run& run, SetOrder& sets) { return SetStage(run, sets).build(); }

}  // namespace cadt
