// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/constraints.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "common/certify/certify.hpp"
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
  Constrainer(Context& ctx, Mesh& mesh, SegmentJob& job) : ctx_(ctx), mesh_(mesh), job_(job) {}

  void map_segments(std::size_t points, std::size_t distinct, const DuplicateLists& duplicates) {
    ctx_.device.fill(*words_, CADT_SEGMENTS_BAD_INDEX * word, word, CADT_NONE);
    Allocation vertex_of = ctx_.memory.allocate(points * word);
    launch_.run<KernelId::cadt_vertices_of_points>(mesh_.input_ids, launch_.grid(distinct), vertex_of);
    if (duplicates.count != 0)
      launch_.run<KernelId::cadt_vertices_of_duplicates>(duplicates.points, duplicates.representatives,
                                                         launch_.grid(duplicates.count), vertex_of);
    ends_ = ctx_.memory.allocate(std::max<std::size_t>(2 * job_.count, 1) * word);
    launch_.run<KernelId::cadt_vertices_of_segments>(job_.segments, launch_.grid(job_.count), vertex_of, points, ends_,
                                                     words_);
    if (const std::uint32_t bad = launch_.read_word(words_, CADT_SEGMENTS_BAD_INDEX); bad != CADT_NONE)
      throw InputError("segment " + std::to_string(bad) + " has an end that is none of the " + std::to_string(points) +
                           " points",
                       bad);
    vertex_triangle_ = ctx_.memory.allocate(distinct * word);
    launch_.run<KernelId::cadt_vertex_triangles>(mesh_.vertices, launch_.grid(mesh_.all), vertex_triangle_);
    mesh_.edge_flags = ctx_.memory.allocate_zeros(mesh_.all * word);
  }

  [[nodiscard]] Outcome insert() {
    find();
    while (missing_ != 0) {
      const std::size_t before = missing_;
      if (!insert_some()) return Outcome::crossed;
      // If none had room, fewer are tried: one alone always has.
      taken_ = missing_ < before ? std::numeric_limits<std::size_t>::max() : std::max<std::size_t>(tried_ / 4, 1);
      ctx_.statistics.segment_retries += missing_;
      ctx_.check("constrain", 0.75);
    }
    return Outcome::done;
  }

  /// Flags are those of the segments and no others; chains if they are wanted.
  void trace() {
    ctx_.device.fill(*mesh_.edge_flags, 0, mesh_.all * word, 0);
    Allocation offsets = ctx_.memory.allocate((job_.count + 1) * word);
    const Allocation none;
    const LaunchGrid grid = launch_.grid(job_.count);
    const auto run = [&](const Allocation& begins) {
      launch_.run<KernelId::cadt_trace_segments>(segment_mesh(), ends_, grid, offsets, begins, mesh_.input_ids,
                                                 job_.chains, words_);
    };
    if (job_.count != 0) run(none);
    require_sound();
    if (!job_.wants_chains) return;
    if (job_.count == 0) ctx_.device.fill(*offsets, 0, word, 0);
    launch_.scan(offsets, job_.count + 1);
    job_.chain_length = launch_.read_word(offsets, job_.count);
    job_.chains = ctx_.memory.allocate(std::max<std::size_t>(job_.chain_length, 1) * word);
    if (job_.count != 0) run(offsets);
    job_.chain_offsets = std::move(offsets);
  }

 private:
  [[nodiscard]] MeshArguments segment_mesh() const { return {*this}; }
  /// CADT_PIECES_PARAMETERS
  struct Pieces {
    Allocation ends, entry, sizes, begins, upper;
    [[nodiscard]] auto arguments() const { return std::tie(ends, entry, sizes, begins, upper); }
  };
  /// CADT_RINGS_PARAMETERS
  struct Rings {
    Allocation vertex, triangle, edge, outer;
    std::size_t room = 0;
    [[nodiscard]] auto arguments() const { return std::tie(vertex, triangle, edge, outer, room); }
  };

  void require_sound() {
    if (const std::uint32_t broken = launch_.read_word(words_, CADT_SEGMENTS_BROKEN); broken != 0)
      give_up("the mesh is wrong at ", broken, " segments");
  }

  [[nodiscard]] std::uint32_t take(std::uint32_t which) {
    const std::uint32_t count = launch_.read_word(words_, which);
    ctx_.device.fill(*words_, which * word, word, 0);
    return count;
  }

  void find() {
    if (job_.count == 0) return;
    Allocation missing = ctx_.memory.allocate(2 * std::size_t{few_} * word);
    const LaunchGrid grid = launch_.grid(job_.count);
    const auto run = [&](std::size_t room) {
      launch_.run<KernelId::cadt_find_segments>(segment_mesh(), ends_, grid, missing, room, words_);
      missing_ = take(CADT_SEGMENTS_MISSING);
    };
    run(few_);
    require_sound();
    if (missing_ > few_) {  // flags are set already, and are set again
      const std::size_t all = missing_;
      missing = ctx_.memory.allocate(2 * all * word);
      run(all);
    }
    next_ = std::move(missing);
    ctx_.statistics.inserted_segments = missing_;
  }

  /// False if a piece crosses a constrained edge.
  bool insert_some() {
    const std::size_t count = missing_;
    const std::size_t most_taken = std::size_t{1} << 20;
    tried_ = std::min({count, taken_, most_taken});
    const std::size_t most = std::numeric_limits<std::uint32_t>::max() / tried_;
    Pieces pieces;
    pieces.ends = std::move(next_);
    for (Allocation* array : {&pieces.entry, &pieces.sizes, &pieces.begins, &pieces.upper})
      *array = ctx_.memory.allocate((count + 1) * word);
    const LaunchGrid each = launch_.grid(count);
    launch_.run<KernelId::cadt_walk_segments>(segment_mesh(), pieces, tried_, most, each, words_);
    launch_.scan(pieces.begins, count + 1);
    require_sound();
    const std::size_t total = launch_.read_word(pieces.begins, count);
    const Rings rings = make_rings(total);
    if (!claims_) {
      claims_ = ctx_.memory.allocate(mesh_.all * word);
      ctx_.device.fill(*claims_, 0, mesh_.all * word, CADT_NONE);
    }
    const Allocation wins = ctx_.memory.allocate(count * word), bases = ctx_.memory.transient(count * word);
    next_ = ctx_.memory.allocate(2 * count * word);
    ctx_.device.fill(*bases, 0, count * word, CADT_NONE);
    launch_.run<KernelId::cadt_claim_cavities>(segment_mesh(), pieces, rings, each, claims_, words_);
    launch_.run<KernelId::cadt_decide_cavities>(segment_mesh(), pieces, rings, each, claims_, wins, next_, words_);
    if (launch_.read_word(words_, CADT_SEGMENTS_CROSSED) != 0) return false;
    missing_ = take(CADT_SEGMENTS_MISSING);
    if (rings.room != 0) {
      fill(pieces, rings, wins, bases, each);
      const LaunchGrid places = launch_.grid(std::min(total, rings.room));
      launch_.run<KernelId::cadt_link_cavities>(segment_mesh(), rings, places, claims_);
      launch_.run<KernelId::cadt_release_cavities>(rings.triangle, places, claims_);
    }
    require_sound();
    return true;
  }

  [[nodiscard]] Rings make_rings(std::size_t total) {
    Rings rings;
    rings.room = std::min(total, 2 * mesh_.all);  // one piece alone always has room
    for (Allocation* array : {&rings.vertex, &rings.triangle, &rings.edge, &rings.outer})
      *array = ctx_.memory.allocate(std::max<std::size_t>(rings.room, 1) * word);
    return rings;
  }

  void fill(const Pieces& pieces, const Rings& rings, const Allocation& wins, const Allocation& bases,
            const LaunchGrid& each) {
    // Chains in the queue share no place and are longer than CADT_CHAIN_LONG.
    const std::size_t room = rings.room / std::size_t{CADT_CHAIN_LONG} + 2;
    Allocation queue = ctx_.memory.allocate(room * sizeof(cadt_chain)), chains;
    launch_.run<KernelId::cadt_fill_cavities>(segment_mesh(), pieces, rings, each, claims_, wins, bases, queue, words_);
    if (ctx_.device.shape().contiguous) return;
    while (const std::uint32_t waiting = take(CADT_SEGMENTS_QUEUED)) {
      std::swap(queue, chains);
      if (!queue) queue = ctx_.memory.allocate(room * sizeof(cadt_chain));
      launch_.run<KernelId::cadt_fill_chains>(segment_mesh(), rings, chains, launch_.grid_spread(waiting), bases, queue,
                                              words_);
      require_sound();
    }
  }

  static constexpr std::size_t few_ = std::size_t{1} << 16;

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  Mesh& mesh_;
  SegmentJob& job_;
  Allocation words_ = launch_.zeros(CADT_SEGMENTS_WORDS);
  Allocation ends_, vertex_triangle_, claims_;
  Allocation next_;  ///< ends of the pieces that are missing
  std::size_t missing_ = 0, tried_ = 0, taken_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace

SegmentResults read_results(Context& ctx, const SegmentJob& job, std::size_t triangles) {
  SegmentResults results;
  if (job.edge_flags) results.edge_flags = ctx.device.read_values(*job.edge_flags, triangles);
  if (job.chain_offsets) results.chain_offsets = ctx.device.read_values(*job.chain_offsets, job.count + 1);
  if (job.chain_length != 0) results.chains = ctx.device.read_values(*job.chains, job.chain_length);
  return results;
}

void constrain(Context& ctx, Mesh& mesh, std::size_t points, std::size_t distinct, const DuplicateLists& duplicates,
               SegmentJob& job) {
  if (!job.segments && job.count != 0)
    job.segments = ctx.memory.import(job.on_host.data(), job.count * sizeof(Segment));
  Constrainer constrainer(ctx, mesh, job);
  constrainer.map_segments(points, distinct, duplicates);
  if (constrainer.insert() == Outcome::crossed) {
    job.crossed = true;
    return;
  }
  constrainer.trace();
  ctx.end_phase("constrain");
  certify(ctx, mesh, distinct);
}

}  // namespace cadt
