// SPDX-License-Identifier: Apache-2.0
// Many polygons in one call: small ones in rounds, by one work-item each; large ones one by one.
#include <cadt/constrained.hpp>
#include <cadt/polygons.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/constraints/constraints.hpp"
#include "common/constraints/polygons/alone.hpp"
#include "common/driver/choose_strategy.hpp"
#include "common/driver/context.hpp"
#include "common/driver/counters.hpp"
#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/driver/thread_state.hpp"
#include "common/points/import.hpp"
#include "common/queries/call.hpp"

namespace cadt {

using namespace device_text;

struct PolygonsResult::Data {
  Words triangles;
  std::vector<std::int64_t> offsets = {0};
  std::vector<PolygonStatus> status;
  std::vector<PolygonProblem> problems;
  Statistics statistics;
};

namespace {

/// Points of a round. On CPUs its arrays stay in the cache; on GPUs there are more polygons than lanes, and memory for
/// a million points takes 250 MB.
constexpr std::size_t points_of_cpu_thread = std::size_t{1} << 14, points_of_gpu = std::size_t{1} << 20;
/// Most triangles of n points.
constexpr std::size_t most_triangles(std::size_t points) noexcept { return 2 * points; }

static_assert(static_cast<int>(PolygonStatus::too_few_points) == CADT_POLYGON_TOO_FEW_POINTS &&
              static_cast<int>(PolygonStatus::not_finite) == CADT_POLYGON_NOT_FINITE &&
              static_cast<int>(PolygonStatus::self_crossing) == CADT_POLYGON_SELF_CROSSING &&
              static_cast<int>(PolygonStatus::ring_crossing) == CADT_POLYGON_RING_CROSSING &&
              static_cast<int>(PolygonStatus::zero_area) == CADT_POLYGON_ZERO_AREA);

void require_offsets(std::span<const std::int64_t> offsets, std::size_t most, const char* of, const char* what) {
  const std::string name = std::string("the offsets of ") + of;
  if (offsets.empty()) throw InputError(name + " are empty: give one number more than there are " + of, 0);
  if (offsets[0] < 0) throw InputError(name + " begin with a negative number", 0);
  for (std::size_t i = 1; i < offsets.size(); ++i)
    if (offsets[i] < offsets[i - 1])
      throw InputError("offset " + std::to_string(i) + " of " + of + " is " + std::to_string(offsets[i]) +
                           ", below the one before: they must not descend",
                       i);
  if (static_cast<std::uint64_t>(offsets.back()) > most)
    throw InputError(name + " end with " + std::to_string(offsets.back()) + ": let them end with at most " +
                         std::to_string(most) + ", the number of " + what,
                     offsets.size() - 1);
}

class PolygonsCall {
 public:
  PolygonsCall(Context& ctx, const Polygons& input, PolygonsResult::Data& result)
      : ctx_(ctx), in_(input), result_(result) {}

  void run() {
    const std::size_t count = in_.size(), points = in_.points_of(0, count);
    const LaunchShape shape = ctx_.device.shape();
    most_ = shape.contiguous ? points_of_cpu_thread * std::max(1U, shape.parallelism) : points_of_gpu;
    result_.triangles = make_words(3 * most_triangles(points));
    result_.status.reserve(count);
    result_.offsets.reserve(count + 1);
    prepare();
    for (std::size_t first = 0, end = 0; first < count; first = end) {
      end = end_of_round(first);
      ctx_.check("polygons", static_cast<double>(first) / static_cast<double>(count));
      if (is_large(first))
        add(triangulate_alone(ctx_, in_, first, alone_));
      else
        add_round(first, end);
    }
    result_.triangles = cut_words(std::move(result_.triangles), 3 * most_triangles(points), 3 * total());
  }

  /// Of the polygons done alone, which are calls of their own: complete once run() has returned.
  [[nodiscard]] const Statistics& alone() const noexcept { return alone_; }

 private:
  [[nodiscard]] std::size_t total() const noexcept { return static_cast<std::size_t>(result_.offsets.back()); }
  [[nodiscard]] bool is_large(std::size_t p) const { return in_.points_of(p, p + 1) > most_swept; }

  /// Where the round ends that begins with this polygon; a large one is alone.
  [[nodiscard]] std::size_t end_of_round(std::size_t first) const {
    std::size_t end = first + 1;
    if (is_large(first)) return end;
    while (end < in_.size() && !is_large(end) && in_.points_of(first, end + 1) <= most_ && end - first < most_) ++end;
    return end;
  }

  /// The largest of all rounds, and the largest polygons alone.
  struct Sizes {
    std::size_t points = 0, rings = 0, polygons = 0, scratch_words = 0;
    std::size_t large = 0, left = 0;  ///< points of polygons that are done alone: of large ones, and of small ones
  };
  /// Whether small polygons that are done alone, by the host, take memory that is limited.
  [[nodiscard]] bool counts_left() const { return ctx_.options.max_memory != 0 && is_host(ctx_.device); }
  [[nodiscard]] Sizes sizes() const {
    Sizes most;
    for (std::size_t first = 0, end = 0; first < in_.size(); first = end) {
      end = end_of_round(first);
      const std::size_t points = in_.points_of(first, end);
      if (is_large(first)) {
        most.large = std::max(most.large, points);
      } else if (points != 0) {
        most.points = std::max(most.points, points);
        most.rings = std::max(most.rings, in_.first_ring(end) - in_.first_ring(first));
        most.polygons = std::max(most.polygons, end - first);
        most.scratch_words = std::max(most.scratch_words, scratch_of(first, end).words);
        for (std::size_t p = first; p < end && counts_left(); ++p)
          if (in_.points_of(p, p + 1) > most.left && has_small_hole(in_, p)) most.left = in_.points_of(p, p + 1);
      }
    }
    return most;
  }

  /// Memory for all rounds. \throws OutOfMemory before any work if the limit does not allow for it and the largest
  /// polygon alone
  void prepare() {
    const Sizes most = sizes();
    Memory& memory = ctx_.memory;
    const std::size_t each = 3 * most_triangles(most.points) * word;
    if (most.points != 0)
      packed_ = memory.export_to(result_.triangles.get(), 3 * most_triangles(in_.points_of(0, in_.size())) * word);
    direct_ = static_cast<bool>(packed_);
    if (ctx_.options.max_memory != 0) memory.require(bytes_for(most, (direct_ ? 1 : 2) * each));
    if (most.points == 0) return;
    triangles_ = memory.allocate(each);
    if (!direct_) packed_ = memory.allocate(each);
  }

  [[nodiscard]] std::size_t bytes_for(const Sizes& most, std::size_t triangles) const {
    constexpr std::size_t fixed = std::size_t{1} << 16;  // partial sums, and what ends lists
    const bool on_host = is_host(ctx_.device);           // which reads points in place
    const std::size_t scalar = in_.points.scalar_size();
    const bool converted = !in_.points.interleaved() || scalar != sizeof(double);
    const std::size_t input = (on_host ? 0 : 2 * scalar) + (converted ? 2 * sizeof(double) : 0);
    const std::size_t kept = triangles + most.scratch_words * word;
    const std::size_t lists = most.rings + (2 + CADT_POLYGON_RESULT_WORDS) * most.polygons;
    const std::size_t rounds = most.points == 0 ? 0 : fixed + kept + input * most.points + lists * word;
    const auto alone = [&](std::size_t points) {
      const bool stars =
          may_use_stars(traits_of(ctx_.device), ctx_.options) && points >= fewest_for_stars(ctx_.options);
      return points == 0 ? 0 : plan_memory({points, on_host, false, sizeof(double)}, stars, true).bytes;
    };
    return std::max(rounds + alone(most.left), kept + alone(most.large));
  }

  /// Work-items, and the words of memory that one of them needs on a CPU.
  [[nodiscard]] LaunchGrid grid(std::size_t polygons) const {
    return ctx_.device.shape().contiguous ? ctx_.launcher.grid_spread(polygons) : ctx_.launcher.grid(polygons);
  }
  struct Scratch {
    std::size_t words, item_words;  ///< in all; of a work-item on CPUs
  };
  [[nodiscard]] Scratch scratch_of(std::size_t first, std::size_t end) const {
    std::size_t largest = 0;
    for (std::size_t p = first; p < end; ++p) largest = std::max(largest, in_.points_of(p, p + 1));
    const std::size_t item_words = CADT_POLYGON_WORDS * largest + CADT_POLYGON_SPARE;
    const std::size_t of_all = CADT_POLYGON_WORDS * in_.points_of(first, end) + CADT_POLYGON_SPARE * (end - first);
    return {ctx_.device.shape().contiguous ? grid(end - first).items * item_words : of_all, item_words};
  }

  void add_round(std::size_t first, std::size_t end) {
    const std::size_t polygons = end - first, points = in_.points_of(first, end), begin = in_.first_point(first);
    if (points == 0) {
      for (std::size_t p = first; p < end; ++p) add(p, PolygonStatus::too_few_points, -1, -1, 0);
      return;
    }
    std::vector<std::uint32_t> rings, of_polygons;
    for (std::size_t p = first; p <= end; ++p)
      of_polygons.push_back(static_cast<std::uint32_t>(in_.first_ring(p) - in_.first_ring(first)));
    for (std::size_t r = in_.first_ring(first); r <= in_.first_ring(end); ++r)
      rings.push_back(static_cast<std::uint32_t>(in_.ring(r) - begin));

    Memory& memory = ctx_.memory;
    const LaunchGrid all = grid(polygons);
    const Allocation input = import_points(ctx_, in_.points.subview(begin, points)),
                     ring_begins = memory.import(rings.data(), rings.size() * word),
                     polygon_rings = memory.import(of_polygons.data(), of_polygons.size() * word),
                     places = memory.allocate((polygons + 1) * word),
                     results = memory.allocate(polygons * CADT_POLYGON_RESULT_WORDS * word);
    const auto [words, item_words] = scratch_of(first, end);
    if (words > scratch_words_) {
      scratch_.release();
      scratch_ = memory.allocate(words * word);
      scratch_words_ = words;
    }
    Launcher& launch = ctx_.launcher;
    launch.run<KernelId::cadt_triangulate_polygons>(input, ring_begins, polygon_rings, all, scratch_, item_words, begin,
                                                    triangles_, places, results);
    const auto found = ctx_.device.read_values(*results, polygons * CADT_POLYGON_RESULT_WORDS);
    launch.scan(places, polygons + 1);
    const std::size_t before = direct_ ? total() : 0;
    launch.run<KernelId::cadt_pack_polygons>(triangles_, ring_begins, polygon_rings, all, places, packed_, before);
    const auto ends = ctx_.device.read_values(*places, polygons + 1);
    if (!direct_ && ends.back() != 0)
      ctx_.device.read(*packed_, 0, result_.triangles.get() + 3 * total(), 3 * std::size_t{ends.back()} * word);
    std::vector<PolygonAlone> alone;
    for (std::size_t p = 0; p < polygons; ++p) {
      if (!is_left(first + p, found[p * CADT_POLYGON_RESULT_WORDS])) continue;
      ctx_.check("polygons", static_cast<double>(first + p) / static_cast<double>(in_.size()));
      alone.push_back(triangulate_alone(ctx_, in_, first + p, alone_));
    }
    make_room(first, ends, alone);
    auto next = alone.begin();
    for (std::size_t p = 0; p < polygons; ++p) {
      if (next != alone.end() && next->number == first + p) {
        add(*next++);
        continue;
      }
      const std::uint32_t* words_of = &found[p * CADT_POLYGON_RESULT_WORDS];
      if (words_of[CADT_POLYGON_STATE] == CADT_POLYGON_BROKEN)
        give_up("the edges of polygon ", first + p, " were found to cross, but no two of them do");
      add(first + p, static_cast<PolygonStatus>(words_of[CADT_POLYGON_STATE]),
          static_cast<std::int32_t>(words_of[CADT_POLYGON_FIRST]),
          static_cast<std::int32_t>(words_of[CADT_POLYGON_SECOND]), ends[p + 1] - ends[p]);
    }
  }

  /// Whether a work-item leaves a small polygon to a call of its own: one with coordinates too far apart for the narrow
  /// arithmetic, or with a hole of one or two different points.
  [[nodiscard]] bool is_left(std::size_t p, std::uint32_t state) const {
    return state == CADT_POLYGON_WIDE || (state == CADT_POLYGON_TOO_FEW_POINTS && has_outline(in_, p));
  }

  /// Moves the triangles of the round that begins with polygon `first`, the last ones first, so that those of the
  /// polygons `alone` have room between them. `ends`: of the triangles of each polygon of the round.
  void make_room(std::size_t first, std::span<const std::uint32_t> ends, std::span<const PolygonAlone> alone) {
    std::int32_t* const begin = result_.triangles.get() + 3 * total();
    std::size_t more = 0, last = ends.back();
    for (const PolygonAlone& polygon : alone) more += polygon.triangles.size();
    for (auto polygon = alone.rbegin(); more != 0 && polygon != alone.rend(); ++polygon) {
      const std::size_t from = ends[polygon->number - first];
      std::copy_backward(begin + 3 * from, begin + 3 * last, begin + 3 * last + more);
      more -= polygon->triangles.size();
      last = from;
    }
  }

  void add(std::size_t polygon, PolygonStatus status, std::int32_t first, std::int32_t second, std::size_t triangles) {
    result_.status.push_back(status);
    result_.offsets.push_back(result_.offsets.back() + static_cast<std::int64_t>(triangles));
    if (status != PolygonStatus::ok) result_.problems.push_back({polygon, status, first, second});
  }
  void add(const PolygonAlone& polygon) {
    std::ranges::copy(polygon.triangles, result_.triangles.get() + 3 * total());
    add(polygon.number, polygon.status, polygon.first, polygon.second, polygon.triangles.size() / 3);
  }

  Context& ctx_;
  const Polygons& in_;
  PolygonsResult::Data& result_;
  std::size_t most_ = 0, scratch_words_ = 0;
  Allocation triangles_, packed_, scratch_;
  bool direct_ = false;  ///< kernels write to the result
  Statistics alone_;
};

}  // namespace

std::string_view to_string(PolygonStatus status) noexcept {
  constexpr std::string_view names[] = {
      "ok", "too few points", "not finite", "self-crossing", "ring crosses ring", "zero area"};
  return names[static_cast<std::size_t>(status)];
}

PolygonsResult::PolygonsResult() : data_(std::make_unique<Data>()) {}
PolygonsResult::PolygonsResult(std::unique_ptr<Data> data) : data_(std::move(data)) {}
PolygonsResult::~PolygonsResult() = default;
PolygonsResult::PolygonsResult(PolygonsResult&&) noexcept = default;
PolygonsResult& PolygonsResult::operator=(PolygonsResult&&) noexcept = default;

std::size_t PolygonsResult::size() const noexcept { return data_->status.size(); }
std::span<const std::int64_t> PolygonsResult::triangle_offsets() const noexcept { return data_->offsets; }
std::span<const std::int32_t> PolygonsResult::triangles() const noexcept {
  return {data_->triangles.get(), 3 * static_cast<std::size_t>(data_->offsets.back())};
}
std::span<const std::int32_t> PolygonsResult::triangles(std::size_t polygon) const {
  if (polygon >= size())
    throw InputError("there is no polygon " + std::to_string(polygon) + ", only " + std::to_string(size()), polygon);
  const auto begin = static_cast<std::size_t>(data_->offsets[polygon]),
             end = static_cast<std::size_t>(data_->offsets[polygon + 1]);
  return triangles().subspan(3 * begin, 3 * (end - begin));
}
std::span<const PolygonStatus> PolygonsResult::status() const noexcept { return data_->status; }
std::span<const PolygonProblem> PolygonsResult::problems() const noexcept { return data_->problems; }
const Statistics& PolygonsResult::statistics() const noexcept { return data_->statistics; }

PolygonsResult triangulate_polygons(PointsView ring_points, std::span<const std::int64_t> ring_offsets,
                                    std::span<const std::int64_t> polygon_offsets, const Options& options) {
  require_size(ring_points.size());
  require_offsets(ring_offsets, ring_points.size(), "rings", "points");
  require_offsets(polygon_offsets, ring_offsets.size() - 1, "polygons", "rings");
  if (options.tuning.watch) throw OptionError("tuning.watch", "shows one mesh; there is none in a call with polygons");
  require_legal_edges(options);
  auto result = std::make_unique<PolygonsResult::Data>();
  const CallState state(options, ring_points.size());
  query::require_doubles(*(**state).device);
  begin_call(**state, ring_points.size(), result->statistics);
  Context ctx(*(**state).device, (**state).memory, (**state).options, result->statistics);
  const Polygons input{ring_points, ring_offsets, polygon_offsets};
  PolygonsCall call(ctx, input, *result);
  call.run();
  ctx.end_phase("polygons");
  end_call(**state, ctx, false);
  add_counters(result->statistics, call.alone());
  return PolygonsResult(std::move(result));
}

}  // namespace cadt
