// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/constraints.hpp"

#include <algorithm>
#include <bit>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "common/certify/certify.hpp"
#include "common/constraints/chains.hpp"
#include "common/driver/device_text.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// Segments that cross need not be inserted to the end.
enum class Outcome { done, crossed };

class Constrainer {
  /// CADT_SEGMENT_MESH_PARAMETERS
  struct MeshArguments {
    const Constrainer& of;
    [[nodiscard]] auto arguments() const {
      return std::tie(of.mesh_.points, of.mesh_.vertices, of.mesh_.across, of.mesh_.edge_flags, of.vertex_triangle_);
    }
  };

 public:
  Constrainer(Context& ctx, Mesh& mesh, const KeyGrid& grid, SegmentJob& job)
      : ctx_(ctx), mesh_(mesh), grid_(grid), job_(job) {}

  void map_segments(std::size_t points, std::size_t distinct, const DuplicateLists& duplicates) {
    ctx_.device.fill(*words_, CADT_SEGMENTS_BAD_INDEX * word, word, CADT_NONE);
    vertex_of_ = ctx_.memory.allocate(points * word);
    launch_.run<KernelId::cadt_vertices_of_points>(mesh_.input_ids, launch_.grid(distinct), vertex_of_);
    if (duplicates.count != 0)
      launch_.run<KernelId::cadt_vertices_of_duplicates>(duplicates.points, duplicates.representatives,
                                                         launch_.grid(duplicates.count), vertex_of_);
    ends_ = ctx_.memory.allocate(std::max<std::size_t>(2 * job_.count, 1) * word);
    // In the order of patches what is read of the mesh is soon read again.
    const auto width = static_cast<unsigned>(std::bit_width(distinct));
    const unsigned bits = width > unsigned{CADT_PATCH_BITS} ? width - unsigned{CADT_PATCH_BITS} : 0;
    const bool sorted = bits != 0 && job_.count > distinct / 64;
    Allocation patches, spare, spare_order;
    if (sorted) make(job_.count, {&patches, &spare, &order_, &spare_order});
    launch_.run<KernelId::cadt_vertices_of_segments>(job_.segments, launch_.grid(job_.count), vertex_of_, points, ends_,
                                                     patches, words_);
    if (sorted) launch_.sort(patches, order_, spare, spare_order, job_.count, bits, true);
    if (const std::uint32_t bad = launch_.read_word(words_, CADT_SEGMENTS_BAD_INDEX); bad != CADT_NONE)
      refuse_segment(bad, ctx_.device.read_values<Segment>(*job_.segments, 1, bad).front(), points);
    ctx_.device.fill(*words_, 0, CADT_SEGMENTS_WORDS * word, 0);
    points_ = points;
    vertices_ = distinct;
    if (job_.wants_crossings == FindCrossings::no) vertex_of_.release();
    vertex_triangle_ = ctx_.memory.allocate(distinct * word);
    launch_.run<KernelId::cadt_vertex_triangles>(mesh_.vertices, launch_.grid(mesh_.all), vertex_triangle_);
    mesh_.edge_flags = ctx_.memory.allocate_zeros(mesh_.all * word);
  }

  /// The first launch inserts short pieces, all that do not meet. The others are taken in a random order, so that those
  /// of many that cross one triangle part the rest: as many as the launch before has inserted, or twice as many if
  /// nearly all were. What is walked along without result is in proportion to what is inserted. CPUs, whose launches
  /// are small, insert all that they have tried before they take others, and first what had to wait: a long piece that
  /// meets many short ones would otherwise lose against one of them in each launch, and be walked along each time.
  [[nodiscard]] Outcome insert() {
    ctx_.begin_share(0.6, 0.2);  // the points have reported up to 0.56, and certification begins at 0.9
    ctx_.check("constrain", 0);
    std::size_t count = job_.count, taken = count, most = 0;
    std::size_t untried = 0;     // pairs, the first ones, that no launch has taken
    std::size_t fresh_size = 0;  // how many of them a launch takes
    bool fresh = true;           // whether it took some
    bool tries_few = !ctx_.device.shape().contiguous;
    Allocation left;
    std::size_t room = 0;  // of left, in pairs
    for (int launch = 0; count != 0; ++launch) {
      const std::size_t first = count - taken;
      Pieces pieces = find(launch == 0 ? ends_ : left, first, taken, launch == 0);
      if (launch == 0) ctx_.statistics.inserted_segments = pieces.count;
      // What is left of the pairs that were taken, whose ends the pieces have, follows the others.
      if (const std::size_t wanted = first + 2 * pieces.count; wanted > room) {
        Allocation larger = ctx_.memory.allocate(2 * (room = wanted) * word);
        if (first != 0) launch_.run<KernelId::cadt_copy_words>(left, larger, 0U, launch_.grid(2 * first));
        left = std::move(larger);
      }
      ctx_.device.fill(*words_, CADT_SEGMENTS_LEFT * word, word, static_cast<std::uint32_t>(first));
      const std::optional<std::size_t> all = pieces.count == 0 ? first : insert(pieces, left);
      if (!all) return Outcome::crossed;
      const std::size_t waiting = *all - first;
      count = *all;
      if (launch == 0) left = shuffled(left, room = most = count);
      // Of the first launch, which takes whole segments, pieces alone.
      const std::size_t tried = launch == 0 ? pieces.count : taken;
      // A segment with a vertex on it is two pieces, which meet there.
      if (pieces.count == 1 && waiting == 1 && launch != 0)
        give_up("a piece of a segment that meets no other is not inserted");
      ctx_.statistics.segment_retries += waiting;
      if (tries_few && count > 1 && count <= CADT_FEW_PIECES) {
        tries_few = false;  // what is left then is long, or nearly so
        if (!insert_few(left, count)) return Outcome::crossed;
      }
      const std::size_t next = next_tries(tried, waiting, launch == 0);
      if (fresh) fresh_size = next;
      fresh = launch == 0 || count == untried || !ctx_.device.shape().contiguous;
      taken = fresh ? std::min(count, fresh_size) : std::min({count - untried, next, waiting != 0 ? waiting : next});
      if (fresh) untried = count - taken;
      ctx_.check("constrain", 1 - static_cast<double>(count) / static_cast<double>(std::max(most, count) + 1));
    }
    return Outcome::done;
  }

  /// What crosses, as far as that is wanted: the mesh is one of all vertices, whatever was inserted.
  void find_crossings() {
    claims_.release();
    job_.crossed = true;
    if (job_.wants_crossings == FindCrossings::no) return;
    job_.crossings = cadt::find_crossings(
        ctx_, {mesh_, ends_, vertex_triangle_, job_.segments, vertex_of_, job_.count, vertices_, points_},
        job_.wants_crossings == FindCrossings::places);
  }

  /// Flags are those of the segments and no others; chains if they are wanted.
  void trace() {
    ctx_.device.fill(*mesh_.edge_flags, 0, mesh_.all * word, 0);
    Allocation offsets;
    if (job_.wants_chains) {
      make(job_.count + 1, {&offsets});
      ctx_.device.fill(*offsets, job_.count * word, word, 0);
    }
    const Allocation none;
    const auto run = [&](const Allocation& which, std::size_t count, const Allocation& begins) {
      launch_.run<KernelId::cadt_trace_segments>(segment_mesh(), ends_, which, launch_.grid(count), offsets, begins,
                                                 mesh_.input_ids, job_.chains, words_);
    };
    const Others others = flag_edges(offsets);
    run(others.which, others.count, none);
    const auto found = ctx_.device.read_values(*words_, CADT_SEGMENTS_WORDS);
    require_sound(found[CADT_SEGMENTS_BROKEN]);
    job_.divided = found[CADT_SEGMENTS_MORE_LOW] != 0 || found[CADT_SEGMENTS_MORE_HIGH] != 0;
    if (!job_.wants_chains) return;
    require_chain_length(2 * job_.count + (std::uint64_t{found[CADT_SEGMENTS_MORE_HIGH]} << 32) +
                         found[CADT_SEGMENTS_MORE_LOW]);
    launch_.scan(offsets, job_.count + 1);
    job_.chain_length = launch_.read_word(offsets, job_.count);
    job_.chains = ctx_.memory.allocate(std::max<std::size_t>(job_.chain_length, 1) * word);
    run(none, job_.count, offsets);
    job_.chain_offsets = std::move(offsets);
  }

 private:
  [[nodiscard]] MeshArguments segment_mesh() const { return {*this}; }
  /// Segments that are not found as edges at once.
  struct Others {
    Allocation which;
    std::size_t count = 0;
  };
  /// CADT_PIECES_PARAMETERS
  struct Pieces {
    Allocation ends, entry, sizes, begins, upper, strides;
    std::size_t room = 0, count = 0, stride_count = 0;
    [[nodiscard]] auto arguments() const { return std::tie(ends, entry, sizes, begins, upper, strides, room); }
  };
  /// CADT_STRIDES_PARAMETERS
  struct Strides {
    Allocation piece, start, steps, left;
    [[nodiscard]] auto arguments() const { return std::tie(piece, start, steps, left); }
  };
  /// CADT_RINGS_PARAMETERS
  struct Rings {
    Allocation vertex, triangle, edge, outer, piece;
    std::size_t room = 0;
    [[nodiscard]] auto arguments() const { return std::tie(vertex, triangle, edge, outer, piece, room); }
  };

  /// How many pieces a launch takes, after one of which so many have to wait.
  [[nodiscard]] std::size_t next_tries(std::size_t tried, std::size_t waiting, bool first) const {
    const LaunchShape shape = ctx_.device.shape();
    const std::size_t won = tried > waiting ? tried - waiting : 0, least = shape.contiguous ? shape.parallelism : 512;
    if (won == 0 && !first) return std::max<std::size_t>(tried / 4, 1);  // one alone always has room
    // More long pieces at a time would not stay in the caches of CPUs.
    const bool more = !shape.contiguous || places_ <= std::size_t{shape.parallelism} * 512;
    return std::max(more && 4 * waiting <= tried ? 2 * won : won, least);
  }

  static void require_sound(std::uint32_t broken) {
    if (broken != 0) give_up("the mesh is wrong at ", broken, " segments");
  }

  [[nodiscard]] std::uint32_t take(std::uint32_t which) {
    const std::uint32_t count = launch_.read_word(words_, which);
    ctx_.device.fill(*words_, which * word, word, 0);
    return count;
  }

  [[nodiscard]] Allocation shuffled(const Allocation& pairs, std::size_t count) {
    Allocation result = ctx_.memory.allocate(std::max<std::size_t>(2 * count, 1) * word);
    launch_.run<KernelId::cadt_shuffle_pairs>(pairs, launch_.grid(count),
                                              static_cast<std::uint32_t>(std::bit_width(count)), result);
    return result;
  }

  /// Flags segments that are edges. `counts`: see cadt_flag_segments
  [[nodiscard]] Others flag_edges(const Allocation& counts) {
    Others others{ctx_.memory.allocate(std::max<std::size_t>(job_.count, 1) * word)};
    launch_.run<KernelId::cadt_flag_segments>(segment_mesh(), ends_, order_, launch_.grid(job_.count), counts,
                                              others.which, words_);
    others.count = take(CADT_SEGMENTS_OTHERS);
    return others;
  }

  /// The pieces of segments between pairs of vertices that are no edges. `whole`: of the segments; all are taken.
  [[nodiscard]] Pieces find(const Allocation& pairs, std::size_t first, std::size_t count, bool whole) {
    Pieces pieces;
    const Allocation none;
    const Others others = whole ? flag_edges(none) : Others{};
    if (whole) count = others.count;
    pieces.room = count + 64;
    const bool limited = whole || !ctx_.device.shape().contiguous;
    const std::uint32_t limit = limited ? std::uint32_t{CADT_PIECE_LONG} : CADT_NONE;
    for (bool again = false;; again = true) {
      make(pieces.room + 1, {&pieces.entry, &pieces.sizes, &pieces.begins, &pieces.upper, &pieces.strides});
      make(2 * pieces.room, {&pieces.ends});
      launch_.run<KernelId::cadt_find_segments>(segment_mesh(), pairs, others.which, first,
                                                whole ? launch_.grid(count) : launch_.grid_of_long(count), limit,
                                                std::uint32_t{!whole}, pieces, again ? claims_ : none, words_);
      const auto found = ctx_.device.read_values(*words_, CADT_SEGMENTS_WORDS);
      pieces.count = found[CADT_SEGMENTS_PIECES];
      pieces.stride_count = found[CADT_SEGMENTS_STRIDES];
      require_sound(found[CADT_SEGMENTS_BROKEN]);
      ctx_.device.fill(*words_, 0, CADT_SEGMENTS_WORDS * word, 0);
      const bool fits = pieces.count <= pieces.room;
      if (fits && !again) return pieces;
      free_claims();
      if (fits) return pieces;
      // Flags are set already, and are set again. Pieces that several segments share are now listed once.
      pieces.room = again ? pieces.count : std::min(pieces.count, 6 * vertices_ + count);
    }
  }

  void free_claims() {
    if (!claims_) claims_ = ctx_.memory.allocate(mesh_.all * word);
    ctx_.device.fill(*claims_, 0, mesh_.all * word, CADT_NONE);
  }

  /// Inserts what does not meet a piece that goes first. How many pairs are left, in `left`, where words_ says that
  /// they begin; nothing if a piece crosses a constrained edge.
  std::optional<std::size_t> insert(Pieces& pieces, const Allocation& left) {
    const std::size_t tried = std::min(pieces.count, most_tried);
    const std::size_t most = std::numeric_limits<std::uint32_t>::max() / tried;
    const LaunchGrid each = launch_.grid_of_long(pieces.count);
    const Strides strides = walk_strides(pieces, each, left);
    launch_.run<KernelId::cadt_places_of_pieces>(pieces, tried, most, each);
    launch_.scan(pieces.begins, pieces.count + 1);
    Rings rings;
    const std::size_t total = launch_.read_word(pieces.begins, pieces.count);
    rings.room = places_ = std::min(total, 2 * mesh_.all);  // one piece alone always has room
    make(std::max<std::size_t>(rings.room, 1),
         {&rings.vertex, &rings.triangle, &rings.edge, &rings.outer, &rings.piece});
    if (!claims_) free_claims();
    const Allocation wins = ctx_.memory.allocate(pieces.count * word),
                     bases = ctx_.memory.allocate(pieces.count * word);
    ctx_.device.fill(*bases, 0, pieces.count * word, CADT_NONE);
    const LaunchGrid places = launch_.grid(rings.room);
    launch_.run<KernelId::cadt_claim_cavities>(segment_mesh(), pieces, rings, each, claims_, wins, words_);
    launch_.run<KernelId::cadt_claim_strides>(segment_mesh(), pieces, rings, strides, launch_.grid(pieces.stride_count),
                                              claims_, words_);
    launch_.run<KernelId::cadt_decide_cavities>(segment_mesh(), rings, places, claims_, wins);
    launch_.run<KernelId::cadt_settle_cavities>(rings, places, claims_, wins);
    launch_.run<KernelId::cadt_keep_pieces>(pieces, each, wins, left, words_);
    fill(pieces, rings, wins, bases, each);
    launch_.run<KernelId::cadt_link_cavities>(segment_mesh(), rings, places, claims_);
    launch_.run<KernelId::cadt_release_cavities>(rings.triangle, places, claims_);
    const auto found = ctx_.device.read_values(*words_, CADT_SEGMENTS_WORDS);
    if (found[CADT_SEGMENTS_CROSSED] != 0) return std::nullopt;
    require_sound(found[CADT_SEGMENTS_BROKEN]);
    ctx_.device.fill(*words_, 0, CADT_SEGMENTS_WORDS * word, 0);
    return found[CADT_SEGMENTS_LEFT];
  }

  /// Few pieces, as far as they are short; `count` of the pairs are left. False if one crosses a constrained edge.
  [[nodiscard]] bool insert_few(const Allocation& pairs, std::size_t& count) {
    Pieces pieces;
    Rings rings;
    pieces.room = count;
    rings.room = count * std::size_t{CADT_FEW_PLACES};
    make(count, {&pieces.entry, &pieces.sizes, &pieces.begins, &pieces.upper, &pieces.strides});
    make(2 * count, {&pieces.ends});
    make(rings.room, {&rings.vertex, &rings.triangle, &rings.edge, &rings.outer, &rings.piece});
    Allocation others, wins, bases;
    make(2 * count, {&others});
    make(count, {&wins, &bases});
    if (!claims_) free_claims();
    launch_.run_in_groups<KernelId::cadt_insert_few_pieces>(CADT_FEW_LANES, CADT_FEW_LANES, segment_mesh(), pieces,
                                                            rings, count, pairs, others, claims_, wins, bases, words_);
    const auto found = ctx_.device.read_values(*words_, CADT_SEGMENTS_WORDS);
    ctx_.device.fill(*words_, 0, CADT_SEGMENTS_WORDS * word, 0);
    if (found[CADT_SEGMENTS_CROSSED] != 0) return false;
    require_sound(found[CADT_SEGMENTS_BROKEN]);
    ctx_.statistics.segment_retries += found[CADT_SEGMENTS_RETRIES];
    count = found[CADT_SEGMENTS_LEFT];
    return true;
  }

  /// Walks along long pieces; those with a vertex on them go to `left`.
  [[nodiscard]] Strides walk_strides(const Pieces& pieces, const LaunchGrid& each, const Allocation& left) {
    Strides strides;
    if (pieces.stride_count == 0) return strides;
    const std::size_t n = pieces.stride_count;
    make(n, {&strides.piece, &strides.start, &strides.steps, &strides.left});
    const LaunchGrid grid = launch_.grid(n);
    launch_.run<KernelId::cadt_divide_pieces>(pieces, each, strides, words_);
    launch_.run<KernelId::cadt_probe_pieces>(segment_mesh(), pieces, strides, grid_, grid, vertices_);
    launch_.run<KernelId::cadt_walk_strides>(segment_mesh(), pieces, strides, grid);
    launch_.run<KernelId::cadt_sum_strides>(segment_mesh(), pieces, each, strides, n, left, words_);
    return strides;
  }

  void fill(const Pieces& pieces, const Rings& rings, const Allocation& wins, const Allocation& bases,
            const LaunchGrid& each) {
    // Chains in a queue share no place.
    const bool queues = !ctx_.device.shape().contiguous;
    const std::size_t most_long = queues ? rings.room / std::size_t{CADT_CHAIN_LONG} + 1 : 1;
    const std::size_t most_others = queues ? rings.room / std::size_t{CADT_CHAIN_SHORT} + 1 : 1;
    Allocation longer = ctx_.memory.allocate(most_long * sizeof(cadt_chain)), chains;
    const Allocation others = ctx_.memory.allocate(most_others * sizeof(cadt_chain));
    launch_.run<KernelId::cadt_fill_cavities>(segment_mesh(), pieces, rings, each, wins, bases, longer, others, words_);
    if (!queues) return;
    std::uint32_t short_chains = 0;
    for (;;) {
      const auto found = ctx_.device.read_values(*words_, CADT_SEGMENTS_WORDS);
      const std::uint32_t waiting = found[CADT_SEGMENTS_LONG_CHAINS];
      short_chains = found[CADT_SEGMENTS_CHAINS];
      if (waiting == 0) break;
      ctx_.device.fill(*words_, CADT_SEGMENTS_LONG_CHAINS * word, word, 0);
      std::swap(longer, chains);
      if (!longer) longer = ctx_.memory.allocate(most_long * sizeof(cadt_chain));
      std::uint32_t lanes = CADT_CHAIN_LANES;  // fewer for many chains, as all of them run at a time
      while (lanes > 64 && std::size_t{waiting} * lanes > ctx_.device.shape().resident) lanes /= 2;
      const LaunchGrid teams = launch_.grid_of_teams(waiting, lanes);
      launch_.run_in_groups<KernelId::cadt_divide_chains>(teams.items, lanes, segment_mesh(), rings, chains, teams,
                                                          bases, longer, others, words_);
    }
    launch_.run<KernelId::cadt_fill_chains>(segment_mesh(), rings, others, launch_.grid_spread(short_chains), bases,
                                            words_);
  }

  void make(std::size_t words, std::initializer_list<Allocation*> arrays) {
    for (Allocation* array : arrays) *array = ctx_.memory.allocate(words * word);
  }

  static constexpr std::size_t most_tried = std::size_t{1} << 20;

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  Mesh& mesh_;
  const KeyGrid& grid_;
  SegmentJob& job_;
  Allocation words_ = launch_.zeros(CADT_SEGMENTS_WORDS);
  Allocation ends_, order_, vertex_of_, vertex_triangle_, claims_;  ///< order_: of segments, by where they are
  std::size_t points_ = 0, vertices_ = 0, places_ = 0;              ///< places of the rings of the last launch
};

}  // namespace

SegmentResults read_results(Context& ctx, const SegmentJob& job, std::size_t triangles) {
  SegmentResults results;
  if (job.edge_flags) results.edge_flags = ctx.device.read_values(*job.edge_flags, triangles);
  if (job.chain_offsets) results.chain_offsets = ctx.device.read_values(*job.chain_offsets, job.count + 1);
  if (job.chain_length != 0) results.chains = ctx.device.read_values(*job.chains, job.chain_length);
  return results;
}

void constrain(Context& ctx, Mesh& mesh, const KeyGrid& grid, std::size_t points, std::size_t distinct,
               const DuplicateLists& duplicates, SegmentJob& job) {
  if (!job.segments && job.count != 0)
    job.segments = ctx.memory.import(job.on_host.data(), job.count * sizeof(Segment));
  Constrainer constrainer(ctx, mesh, grid, job);
  constrainer.map_segments(points, distinct, duplicates);
  if (constrainer.insert() == Outcome::crossed) return constrainer.find_crossings();
  constrainer.trace();
  ctx.end_phase("constrain");
  ctx.begin_share(0, 1);
  certify(ctx, mesh, distinct);
}

}  // namespace cadt
