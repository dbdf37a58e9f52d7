// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/crossings/device_crossings.hpp"

#include <cadt/constrained.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <utility>

#include "common/constraints/exact/implicit_point.hpp"
#include "common/constraints/stop_check.hpp"
#include "common/driver/device_text.hpp"
#include "common/platform/parallel.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

using namespace device_text;

class CrossingFinder {
  /// CADT_SEGMENT_MESH_PARAMETERS
  struct MeshArguments {
    const SegmentsInMesh& in;
    [[nodiscard]] auto arguments() const {
      return std::tie(in.mesh.points, in.mesh.vertices, in.mesh.across, in.mesh.edge_flags, in.vertex_triangle);
    }
  };
  /// CADT_DIVIDED_PARAMETERS
  struct Divided {
    Allocation begins, ends, segments;
    [[nodiscard]] auto arguments() const { return std::tie(begins, ends, segments); }
  };
  /// CADT_LISTED_PARAMETERS
  struct Listed {
    Allocation ends, pieces, triangles;
    [[nodiscard]] auto arguments() const { return std::tie(ends, pieces, triangles); }
  };
  /// CADT_PARTNER_PARAMETERS
  struct Partners {
    Allocation ends, partners, counts, owned;
    [[nodiscard]] auto arguments() const { return std::tie(ends, partners, counts, owned); }
  };

 public:
  CrossingFinder(Context& ctx, const SegmentsInMesh& in) : ctx_(ctx), in_(in) {}

  /// False if there is too much to be tested.
  [[nodiscard]] bool find_pairs() {
    Listed lists;
    if (!divide(lists)) return false;
    check();
    list_partners(test(lists));
    check();
    lists = {};
    const LaunchGrid each = launch_.grid(in_.count);
    found_.pairs = words_for(2 * found_.count);
    launch_.run<KernelId::cadt_order_pairs>(partners_.ends, each, partners_.partners, partners_.counts, partners_.owned,
                                            found_.pairs);
    return true;
  }

  /// Without effect if the order of a chain is not known.
  void find_places() {
    const std::size_t n = in_.points;
    const double first = 1 / in_.mesh.scale_again, second = 1 / in_.mesh.scale;
    Allocation places = ctx_.memory.allocate((n + found_.count) * point_bytes(ctx_.device));
    launch_.run<KernelId::cadt_gather_points>(in_.mesh.points, in_.vertex_of, places, launch_.grid(n), first, second);
    const Allocation unsure = words_for(found_.count);
    launch_.run<KernelId::cadt_place_crossings>(in_.segments, found_.pairs, launch_.grid(found_.count), n, places,
                                                unsure, words_);
    if (const std::size_t count = launch_.read_word(words_, CADT_PAIRS_UNSURE); count != 0)
      place_exactly(ctx_.device.read_values(*unsure, count), places);
    check();
    if (!write_chains(places)) return;
    found_.places = std::move(places);
  }

  [[nodiscard]] FoundCrossings take() { return std::move(found_); }

 private:
  [[nodiscard]] MeshArguments mesh() const { return {in_}; }
  /// Whether the caller stops the call: pieces have reported their progress.
  void check() { ctx_.check("constrain", 1); }
  [[nodiscard]] Allocation words_for(std::size_t count) {
    return ctx_.memory.allocate(std::max<std::size_t>(count, 1) * word);
  }
  [[nodiscard]] std::uint64_t wide_word(const std::vector<std::uint32_t>& words, std::size_t low) const {
    return words[low] | std::uint64_t{words[low + 1]} << 32;
  }

  bool divide(Listed& lists) {
    const std::size_t all = in_.mesh.all;
    launch_.run<KernelId::cadt_vertex_triangles>(in_.mesh.vertices, launch_.grid(all), in_.vertex_triangle);
    divided_.begins = words_for(in_.count + 1);
    lists.ends = ctx_.memory.allocate_zeros(all * word);
    const auto run = [&](const Allocation& ends, std::size_t count) {
      launch_.run<KernelId::cadt_divide_segments>(mesh(), ends, launch_.grid_of_long(count), divided_, lists, words_);
    };
    const std::uint64_t most = most_listed * (in_.vertices + in_.count);
    if (in_.count >= least_sampled) {  // where all run through very many triangles, a few tell it
      const Allocation shuffled = words_for(2 * in_.count);
      launch_.run<KernelId::cadt_shuffle_pairs>(in_.ends, launch_.grid(in_.count),
                                                static_cast<std::uint32_t>(std::bit_width(in_.count)), shuffled);
      run(shuffled, in_.count / 64);
      if (wide_word(ctx_.device.read_values(*words_, CADT_PAIRS_WORDS), CADT_PAIRS_LISTED_LOW) > most) return false;
      ctx_.device.fill(*words_, 0, CADT_PAIRS_WORDS * word, 0);
      ctx_.device.fill(*lists.ends, 0, all * word, 0);
    }
    run(in_.ends, in_.count);
    launch_.run<KernelId::cadt_count_pairs>(lists.ends, launch_.grid_strided(all), words_);
    const auto found = ctx_.device.read_values(*words_, CADT_PAIRS_WORDS);
    if (found[CADT_PAIRS_BROKEN] != 0) give_up("the mesh is wrong at ", found[CADT_PAIRS_BROKEN], " segments");
    const std::uint64_t listed = wide_word(found, CADT_PAIRS_LISTED_LOW),
                        tests = wide_word(found, CADT_PAIRS_TESTS_LOW);
    if (listed > most || tests > most_tests * (listed + few) || std::max(listed, tests) >= most_of_all) return false;
    listed_ = static_cast<std::size_t>(listed);
    tests_ = static_cast<std::size_t>(tests);
    launch_.scan(divided_.begins, in_.count + 1);
    launch_.scan(lists.ends, all);
    pieces_ = launch_.read_word(divided_.begins, in_.count);
    divided_.ends = words_for(2 * pieces_);
    divided_.segments = words_for(pieces_);
    lists.pieces = words_for(listed_);
    lists.triangles = words_for(listed_);
    run(in_.ends, in_.count);
    return true;
  }

  /// The pairs, some several times.
  std::pair<Allocation, std::size_t> test(const Listed& lists) {
    for (std::size_t room = std::min(tests_, in_.count + few);;) {
      Allocation pairs = words_for(2 * room);
      launch_.run<KernelId::cadt_find_pairs>(in_.mesh.points, divided_, lists, launch_.grid(listed_), pairs, room,
                                             words_);
      const std::size_t found = launch_.read_word(words_, CADT_PAIRS_FOUND);
      if (found <= room) return {std::move(pairs), found};
      ctx_.device.fill(*words_, CADT_PAIRS_FOUND * word, word, 0);
      room = found;
    }
  }

  void list_partners(const std::pair<Allocation, std::size_t>& pairs) {
    const std::size_t count = in_.count;
    const LaunchGrid each = launch_.grid(pairs.second);
    partners_.ends = ctx_.memory.allocate_zeros(count * word);
    launch_.run<KernelId::cadt_list_partners>(pairs.first, each, partners_.ends, partners_.partners);
    launch_.scan(partners_.ends, count);
    partners_.partners = words_for(2 * pairs.second);
    launch_.run<KernelId::cadt_list_partners>(pairs.first, each, partners_.ends, partners_.partners);
    partners_.counts = words_for(count);
    partners_.owned = words_for(count + 1);
    launch_.run<KernelId::cadt_sort_partners>(partners_.ends, launch_.grid(count), partners_.partners, partners_.counts,
                                              partners_.owned);
    launch_.scan(partners_.owned, count + 1);
    found_.count = launch_.read_word(partners_.owned, count);
  }

  /// What the device is not certain of: by whole numbers.
  void place_exactly(const std::vector<std::uint32_t>& unsure, const Allocation& places) {
    const auto pairs = ctx_.device.read_values<Segment>(*found_.pairs, found_.count);
    const auto segments = ctx_.device.read_values<Segment>(*in_.segments, in_.count);
    auto all = ctx_.device.read_values<exact::Point>(*places, in_.points + found_.count);
    const auto line = [&](std::int32_t s) {
      const Segment& ends = segments[static_cast<std::size_t>(s)];
      return exact::Line{all[static_cast<std::size_t>(ends[0])], all[static_cast<std::size_t>(ends[1])]};
    };
    platform::for_each_block(
        unsure.size(), platform::threads_or_all(ctx_.options.threads), [&](std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) {
            const std::array<exact::Line, 2> lines = {line(pairs[unsure[i]][0]), line(pairs[unsure[i]][1])};
            all[in_.points + unsure[i]] = exact::ImplicitPoints(lines).crossing(0, 1).rounded();
          }
        });
    ctx_.device.write(*places, in_.points * sizeof(exact::Point), all.data() + in_.points,
                      found_.count * sizeof(exact::Point));
  }

  bool write_chains(const Allocation& places) {
    if (pieces_ + in_.count + 2 * found_.count >= most_of_all) return false;
    const LaunchGrid each = launch_.grid(in_.count);
    Allocation offsets = words_for(in_.count + 1);
    launch_.run<KernelId::cadt_count_chains>(divided_.begins, partners_.counts, each, offsets);
    launch_.scan(offsets, in_.count + 1);
    const std::size_t length = launch_.read_word(offsets, in_.count);
    Allocation chains = words_for(length), edges = words_for(2 * length);
    launch_.run<KernelId::cadt_write_chains>(divided_, partners_, offsets, each, in_.mesh.input_ids, places, in_.points,
                                             chains, edges, words_);
    if (launch_.read_word(words_, CADT_PAIRS_TIED) != 0) return false;
    found_.chain_offsets = std::move(offsets);
    found_.chains = std::move(chains);
    found_.chain_edges = std::move(edges);
    found_.chain_length = length;
    return true;
  }

  /// Places of pieces in triangles for each vertex and segment, pairs in the same triangle for each of those places,
  /// and what is always little enough.
  static constexpr std::uint64_t most_listed = 16, most_tests = 16, few = 1 << 16;
  static constexpr std::size_t least_sampled = 4096;  // segments
  /// Of what is numbered by words, two of them each.
  static constexpr std::uint64_t most_of_all = std::uint64_t{1} << 30;

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  const SegmentsInMesh& in_;
  Allocation words_ = launch_.zeros(CADT_PAIRS_WORDS);
  Divided divided_;
  Partners partners_;
  std::size_t pieces_ = 0, listed_ = 0, tests_ = 0;
  FoundCrossings found_;
};

}  // namespace

std::optional<FoundCrossings> find_crossings(Context& ctx, const SegmentsInMesh& in, bool with_places) {
  if (takes_floats_only(ctx.device)) return std::nullopt;
  CrossingFinder finder(ctx, in);
  if (!finder.find_pairs()) return std::nullopt;
  if (with_places) finder.find_places();
  return finder.take();
}

std::optional<std::vector<std::uint32_t>> certify_places(Context& ctx, const Mesh& mesh, const Allocation& places,
                                                         std::size_t points) {
  Launcher& launch = ctx.launcher;
  const std::size_t room = mesh.triangles / 16 + 1024;
  const Allocation words = launch.zeros(CADT_PAIRS_WORDS), suspects = ctx.memory.allocate(room * word);
  launch.run<KernelId::cadt_certify_places>(mesh.vertices, mesh.across, mesh.edge_flags, places,
                                            launch.grid(mesh.triangles), points, suspects, room, words);
  const std::size_t count = launch.read_word(words, CADT_PAIRS_SUSPECTS);
  if (count > room) return std::nullopt;
  return ctx.device.read_values(*suspects, count);
}

}  // namespace cadt
