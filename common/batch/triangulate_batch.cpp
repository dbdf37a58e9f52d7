// SPDX-License-Identifier: Apache-2.0
// Calls with several sets of points. Consecutive small sets are batched; a large set is triangulated individually, into
// the same result arrays.
#include <cadt/triangulator.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/batch/batch_mesh.hpp"
#include "common/batch/sort_batch.hpp"
#include "common/batch/triangulation_batch.hpp"
#include "common/driver/build.hpp"
#include "common/driver/choose_strategy.hpp"
#include "common/driver/registry.hpp"
#include "common/driver/session.hpp"
#include "common/driver/start_async.hpp"
#include "common/output/renumber.hpp"
#include "common/points/import.hpp"

namespace cadt {
namespace {

using device_text::word;
/// Most triangles of n points.
constexpr std::size_t most_triangles(std::size_t n) { return n < 3 ? 0 : 2 * n - 5; }

std::size_t most_triangles(std::span<const std::size_t> offsets) {
  std::size_t sum = 0;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) sum += most_triangles(offsets[s + 1] - offsets[s]);
  return sum;
}

void require_offsets(std::span<const std::size_t> offsets, std::size_t points) {
  if (offsets.empty() || offsets.front() != 0)
    throw InputError("the offsets of the sets must begin with 0: give one number more than there are sets", 0);
  for (std::size_t s = 1; s < offsets.size(); ++s)
    if (offsets[s] < offsets[s - 1])
      throw InputError("offset " + std::to_string(s) + " of the sets is " + std::to_string(offsets[s]) +
                           ", below the one before: they must not descend",
                       s);
  if (offsets.back() != points)
    throw InputError("the offsets of the sets end with " + std::to_string(offsets.back()) + ", but there are " +
                         std::to_string(points) + " points",
                     offsets.size() - 1);
}

/// `size` points from `first` on.
PointsView slice(const PointsView& points, std::size_t first, std::size_t size) { return points.subview(first, size); }

DevicePoints slice(DevicePoints points, std::size_t first, std::size_t size) {
  points.skip += first;
  points.size = size;
  return points;
}

template <class Points>
class BatchCall {
 public:
  BatchCall(Context& ctx, const Points& points, std::span<const std::size_t> offsets, std::size_t most_points,
            BatchShape& shape, const Allocation& triangles, const Allocation& neighbors)
      : ctx_(ctx),
        points_(points),
        offsets_(offsets),
        most_points_(most_points),
        shape_(shape),
        triangles_(triangles),
        neighbors_(neighbors) {}

  void run() {
    const std::size_t sets = offsets_.size() - 1;
    for (std::size_t first = 0, end = 0; first < sets; first = end) {
      end = first + 1;
      const std::size_t begin = offsets_[first];
      const bool large = offsets_[end] - begin > most_batched_;
      while (!large && end < sets && offsets_[end + 1] - begin <= most_points_ && end - first < most_sets_batched &&
             offsets_[end + 1] - offsets_[end] <= most_batched_)
        ++end;
      const std::size_t size = offsets_[end] - begin;
      if (size != 0)
        ctx_.begin_share(static_cast<double>(begin) / static_cast<double>(offsets_.back()),
                         static_cast<double>(size) / static_cast<double>(offsets_.back()));
      if (size == 0)
        add_empty(end - first);
      else if (large)
        add_individual(first, begin, size);
      else
        add_batched(first, end);
    }
  }

 private:
  void add_empty(std::size_t sets) {
    for (std::size_t s = 0; s < sets; ++s) append_set(shape_.triangles.back(), 0);
  }

  /// Appends the next set, given where its triangles end and its number of distinct points.
  void append_set(std::size_t triangles, std::size_t distinct) {
    const bool flat = triangles == shape_.triangles.back();
    shape_.triangles.push_back(triangles);
    shape_.duplicates.push_back(shape_.duplicate_list.size());
    shape_.dimensions.push_back(distinct == 0 ? -1 : distinct == 1 ? 0 : flat ? 1 : 2);
    ctx_.statistics.distinct += distinct;
  }

  [[nodiscard]] Allocation import(std::size_t begin, std::size_t size) {
    ctx_.check("sort", 0);
    Allocation input = import_points(ctx_, slice(points_, begin, size));
    ctx_.end_phase("upload");
    return input;
  }

  /// The duplicates of `size` points just sorted.
  [[nodiscard]] std::vector<Duplicate> read_pairs(const SortedPoints& order, std::size_t size) const {
    return read_duplicates(ctx_.device, order.duplicates, order.representatives, size - order.distinct);
  }
  /// Those of one set, whose points begin at `first`.
  void add_pairs(std::span<const Duplicate> pairs, std::uint32_t first) {
    const auto begin = static_cast<std::int32_t>(first);
    for (const auto& [point, representative] : pairs)
      shape_.duplicate_list.push_back({point - begin, representative - begin});
  }

  void write(const Mesh& mesh, std::size_t size, std::size_t room) {
    ctx_.check("output", 0.9);
    if (mesh.triangles > room) give_up("there are ", mesh.triangles, " triangles instead of ", room, " at most");
    const Allocation numbers = number_triangles(ctx_, mesh, size);
    ctx_.check("output", 0.95);
    write_triangles(ctx_, mesh, numbers, place());
  }

  /// Behind what is written already.
  [[nodiscard]] ResultPlace place() const { return {triangles_, neighbors_, none_, shape_.triangles.back()}; }

  void add_individual(std::size_t set, std::size_t begin, std::size_t size) {
    const bool stars = may_use_stars(traits_of(ctx_.device), ctx_.options);
    SortedPoints order = sort_large(set, begin, size, stars);
    add_pairs(read_pairs(order, size), 0);
    ctx_.statistics.wide_arithmetic = ctx_.statistics.wide_arithmetic || order.wide;
    const std::size_t distinct = order.distinct;
    const Mesh mesh = build(ctx_, std::move(order), slice(points_, begin, size));
    if (!mesh.flat) write(mesh, size, most_triangles(size));
    ctx_.end_phase("output");
    append_set(shape_.triangles.back() + mesh.triangles, distinct);
  }

  [[nodiscard]] SortedPoints sort_large(std::size_t set, std::size_t begin, std::size_t size, bool stars) {
    try {
      return sort_spatially(ctx_, import(begin, size), size, stars);
    } catch (const InputError& error) {
      throw InputError("in set " + std::to_string(set) + ": " + error.what(), begin + error.index());
    }
  }

  void add_batched(std::size_t first_set, std::size_t end_set) {
    const std::size_t begin = offsets_[first_set], size = offsets_[end_set] - begin, sets = end_set - first_set;
    std::vector<std::uint32_t> starts(sets + 1);
    for (std::size_t s = 0; s <= sets; ++s) starts[s] = static_cast<std::uint32_t>(offsets_[first_set + s] - begin);
    const bool batched = batches_sets(traits_of(ctx_.device), ctx_.options);
    SortedBatch order = sort_batch(ctx_, import(begin, size), starts, batched ? most_batched_ : 0, begin, first_set);
    const std::vector<Duplicate> pairs = read_pairs(order.order, size);
    const BatchMesh mesh = build_batch(ctx_, order);
    const std::size_t before = shape_.triangles.back();
    write(mesh.mesh, size, most_triangles(std::span(offsets_).subspan(first_set, sets + 1)));
    renumber_within_sets(ctx_, mesh.set_starts, order.starts, place(), mesh.mesh.triangles);
    ctx_.end_phase("output");
    const std::vector<std::uint32_t> ends = ctx_.device.read_values(*mesh.set_starts, sets + 1);
    for (std::size_t s = 0; s < sets; ++s) {
      const std::size_t from = starts[s] - mesh.positions[s], to = starts[s + 1] - mesh.positions[s + 1];
      add_pairs(std::span(pairs).subspan(from, to - from), starts[s]);
      append_set(before + ends[s + 1], mesh.positions[s + 1] - mesh.positions[s]);
    }
  }

  Context& ctx_;
  const Points& points_;
  std::span<const std::size_t> offsets_;
  std::size_t most_points_, most_batched_ = most_points_of_batched_set(traits_of(ctx_.device));
  BatchShape& shape_;
  const Allocation& triangles_;
  const Allocation& neighbors_;
  const Allocation none_;
};

/// Most points of a batch. \throws OutOfMemory before any work
std::size_t plan_call_of_batch(Triangulator::State& state, std::span<const std::size_t> offsets, std::size_t results) {
  return plan_batch(state.memory, state.options, state.device->info(), offsets,
                    most_points_of_batched_set(traits_of(*state.device)), results, state.known);
}

/// \throws OptionError, InputError, LimitError
void require_batch(const Options& options, std::span<const std::size_t> offsets, std::size_t points) {
  require_size(points);
  require_offsets(offsets, points);
  if (options.tuning.watch)
    throw OptionError("tuning.watch", "shows one mesh; there is none in a call with several sets");
}

template <class Points>
void run_batch(Triangulator::State& state, Context& ctx, const Points& points, std::span<const std::size_t> offsets,
               std::size_t most_points, BatchShape& shape, const Allocation& triangles, const Allocation& neighbors) {
  shape.points.assign(offsets.begin(), offsets.end());
  shape.statistics.sets = offsets.size() - 1;
  BatchCall<Points>(ctx, points, offsets, most_points, shape, triangles, neighbors).run();
  if (state.options.max_memory == 0)
    state.known.batch = std::max(state.known.batch, std::min(offsets.back(), most_points));
}

TriangulationBatch batch_to_host(Triangulator::State& state, PointsView points, std::span<const std::size_t> offsets) {
  require_batch(state.options, offsets, points.size());
  auto result = std::make_unique<TriangulationBatch::Data>();
  BatchShape& shape = result->shape;
  begin_call(state, points.size(), shape.statistics);
  const std::size_t values = 3 * most_triangles(offsets), bytes = values * word;
  const std::size_t most = plan_call_of_batch(state, offsets, is_host(*state.device) ? 0 : 2 * bytes);
  Context ctx(*state.device, state.memory, state.options, shape.statistics);
  result->triangles = make_words(values);
  result->neighbors = make_words(values);
  Allocation triangles, neighbors;
  if (bytes != 0) {
    triangles = ctx.memory.export_to(result->triangles.get(), bytes);
    neighbors = ctx.memory.export_to(result->neighbors.get(), bytes);
  }
  const bool direct = bytes == 0 || (triangles && neighbors);
  if (!direct) {
    triangles = ctx.memory.allocate(bytes);
    neighbors = ctx.memory.allocate(bytes);
  }
  run_batch(state, ctx, points, offsets, most, shape, triangles, neighbors);
  if (const std::size_t used = 3 * shape.triangles.back() * word; !direct && used != 0) {
    ctx.device.read(*triangles, 0, result->triangles.get(), used);
    ctx.device.read(*neighbors, 0, result->neighbors.get(), used);
  }
  ctx.end_phase("copy");
  ctx.begin_share(0, 1);
  end_call(state, ctx, false);
  return TriangulationBatch(std::move(result));
}

DeviceTriangulationBatch batch_to_device(const std::shared_ptr<Triangulator::State>& state, const DevicePoints& points,
                                         std::span<const std::size_t> offsets) {
  require_batch(state->options, offsets, points.size);
  auto data = std::make_unique<DeviceTriangulationBatch::Data>();
  data->state = state;
  BatchShape& shape = data->shape;
  begin_call(*state, points.size, shape.statistics);
  const std::size_t bytes = 3 * most_triangles(offsets) * word;
  const std::size_t most = plan_call_of_batch(*state, offsets, 2 * bytes + offsets.size() * word);
  Context ctx(*state->device, state->memory, state->options, shape.statistics);
  if (bytes != 0) {
    data->triangles = ctx.memory.allocate(bytes);
    data->neighbors = ctx.memory.allocate(bytes);
  }
  data->offsets = ctx.memory.allocate(offsets.size() * word);
  run_batch(*state, ctx, points, offsets, most, shape, data->triangles, data->neighbors);
  const std::vector<std::uint32_t> words(shape.triangles.begin(), shape.triangles.end());
  ctx.device.write(*data->offsets, 0, words.data(), words.size() * word);
  ctx.end_phase("output");
  ctx.begin_share(0, 1);
  end_call(*state, ctx, true);
  return DeviceTriangulationBatch(std::move(data));
}

}  // namespace

TriangulationBatch Triangulator::triangulate_batch(PointsView points, std::span<const std::size_t> offsets) {
  return batch_to_host(*state_, points, offsets);
}

DeviceTriangulationBatch Triangulator::triangulate_batch(const DevicePoints& points,
                                                         std::span<const std::size_t> offsets) {
  return batch_to_device(state_, points, offsets);
}

std::future<TriangulationBatch> Triangulator::triangulate_batch_async(PointsView points,
                                                                      std::span<const std::size_t> offsets) {
  return start_async([state = state_, points, offsets] { return batch_to_host(*state, points, offsets); });
}

std::future<DeviceTriangulationBatch> Triangulator::triangulate_batch_async(const DevicePoints& points,
                                                                            std::span<const std::size_t> offsets) {
  return start_async([state = state_, points, offsets] { return batch_to_device(state, points, offsets); });
}

TriangulationBatch triangulate_batch(PointsView points, std::span<const std::size_t> offsets, const Options& options) {
  require_batch(options, offsets, points.size());
  Triangulator::State state(options, open_device(options), false);
  return batch_to_host(state, points, offsets);
}

}  // namespace cadt
