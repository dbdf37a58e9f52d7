// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/crossed_segments.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <utility>

#include "common/constraints/chains.hpp"
#include "common/constraints/crossings/crossings.hpp"
#include "common/constraints/exact/crossing_places.hpp"
#include "common/constraints/exact_mesh/exact_crossings.hpp"
#include "common/constraints/exact_mesh/exact_triangulation.hpp"
#include "common/constraints/stop_check.hpp"
#include "common/driver/triangulation_data.hpp"
#include "common/platform/parallel.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

using State = std::shared_ptr<Triangulator::State>;
using Data = ConstrainedTriangulation::Data;

std::vector<Segment> read_pairs(Device& device, const FoundCrossings& found) {
  return device.read_values<Segment>(*found.pairs, found.count);
}

/// Input points and crossings as exact places, and a mesh of them.
struct ExactPlaces {
  constraints::CrossingPlaces vertices;
  std::span<const std::int32_t> triangles, neighbors;

  /// Whether a suspect (CADT_SUSPECT) is right: counterclockwise, or a legal edge.
  [[nodiscard]] bool is_right(std::uint32_t suspect) const {
    const std::size_t t = suspect / 4, k = suspect % 4;
    std::array<std::int32_t, 4> v{};
    for (std::size_t i = 0; i < 3; ++i) v[i] = triangles[3 * t + i];
    std::size_t count = 3;
    if (k < 3) {
      const std::int32_t u = neighbors[3 * t + k];
      if (u < 0) return false;  // a crossing on the hull
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t at = 3 * static_cast<std::size_t>(u) + j;
        if (neighbors[at] == static_cast<std::int32_t>(t)) v[3] = triangles[at], count = 4;
      }
      if (count != 4) return false;
    }
    std::array<exact::Line, 8> lines;
    const exact::ImplicitPoints exact(lines);
    std::array<exact::Place, 4> at;
    for (std::size_t i = 0; i < count; ++i) at[i] = vertices.place(static_cast<std::size_t>(v[i]), 2 * i, lines, exact);
    if (count == 3) return exact.orientation(at[0], at[1], at[2]) > 0;
    return exact.incircle_perturbed(at[0], at[1], at[2], at[3]) < 0;
  }

  [[nodiscard]] bool are_right(std::span<const std::uint32_t> suspects, unsigned threads) const {
    std::atomic<bool> right{true};
    const unsigned all = platform::threads_or_all(threads);
    platform::for_each_block(suspects.size(), all, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last && right.load(std::memory_order_relaxed); ++i)
        if (!is_right(suspects[i])) right.store(false, std::memory_order_relaxed);
    });
    return right.load();
  }
};

/// The second call: points and rounded crossings, and the edges of chains. If the mesh is that of the exact places as
/// well - all triangles counterclockwise, all other edges legal -, it is the only one (docs/constrained.md).
class RoundedCall {
 public:
  RoundedCall(Device& device, std::size_t points, FoundCrossings& found) : points_(points) {
    job.segments = std::move(found.chain_edges);
    job.count = found.chain_length;
    job.rounded_places = &found.places;
    job.exact_points = points;
    places = {.x = device.handle(*found.places), .size = points + found.count};
  }
  /// False if rounded pieces cross, run through a vertex, or two crossings have the same rounded place. Duplicates are
  /// ascending.
  [[nodiscard]] bool fits(std::int32_t last_duplicate) const {
    return !job.crossed && !job.divided && job.suspects && last_duplicate < static_cast<std::int32_t>(points_);
  }

  SegmentJob job;
  DevicePoints places;

 private:
  std::size_t points_;
};

/// False if that is not the mesh: then `data` is as before.
bool constrain_rounded(const State& state, PointsView points, std::span<const Segment> segments, FoundCrossings found,
                       Data& data) {
  Device& device = *state->device;
  const std::size_t n = points.size();
  RoundedCall call(device, n, found);
  SegmentResults results;
  std::unique_ptr<Triangulation::Data> mesh = triangulate_with_segments(state, call.places, call.job, results);
  constraints::check(state->options.stop);
  if (!call.fits(mesh->duplicates.empty() ? -1 : mesh->duplicates.back().point)) return false;
  std::vector<Segment> pairs = read_pairs(device, found);
  const std::size_t indices = 3 * mesh->triangle_count;
  const ExactPlaces exact{
      {points, segments, pairs}, {mesh->triangles.get(), indices}, {mesh->neighbors.get(), indices}};
  if (!exact.are_right(*call.job.suspects, state->options.threads)) return false;
  constraints::check(state->options.stop);

  data.edge_flags = std::move(results.edge_flags);
  data.added = device.read_values<double>(*found.places, 2 * found.count, 2 * n);
  give_points(*mesh, points, state->options.keep_points, data.added);
  data.mesh = Triangulation(std::move(mesh));
  data.parents = std::move(pairs);
  const auto offsets = device.read_values(*found.chain_offsets, segments.size() + 1);
  take_chains(data, {offsets.begin(), offsets.end()},
              device.read_values<std::int32_t>(*found.chains, found.chain_length));
  constraints::check(state->options.stop);
  return true;
}

/// The same on the device; null if that is not the mesh.
DeviceMesh constrain_rounded(const State& state, std::size_t n, const SegmentJob& first, FoundCrossings& found) {
  Device& device = *state->device;
  RoundedCall call(device, n, found);
  auto data = triangulate_on_device(state, call.places, &call.job);
  const std::size_t duplicates = data->duplicate_count;
  if (!call.fits(
          duplicates == 0 ? -1 : device.read_values<std::int32_t>(*data->duplicate_points, 1, duplicates - 1).front()))
    return nullptr;
  if (!call.job.suspects->empty()) {
    const auto xy = device.read_values<double>(*found.places, 2 * n);
    const auto segments = device.read_values<Segment>(*first.segments, first.count), pairs = read_pairs(device, found);
    const auto triangles = device.read_values<std::int32_t>(*data->triangles, 3 * data->triangle_count),
               neighbors = device.read_values<std::int32_t>(*data->neighbors, 3 * data->triangle_count);
    const ExactPlaces exact{{xy, segments, pairs}, triangles, neighbors};
    if (!exact.are_right(*call.job.suspects, state->options.threads)) return nullptr;
  }
  data->added = found.count;
  data->places = std::move(found.places);
  data->added_parents = std::move(found.pairs);
  data->segments = first.count;
  data->chain_offsets = std::move(found.chain_offsets);
  data->chains = std::move(found.chains);
  data->chain_length = found.chain_length;
  return data;
}

bool suits_device(Device& device, const constraints::DividedSegments& divided) {
  constexpr std::size_t most = std::size_t{1} << 30;  // segments of a call
  return !takes_floats_only(device) && !divided.parents.empty() && divided.vertices.size() < most;
}

/// What the sweep has found, as the device finds it.
FoundCrossings upload_crossings(Memory& memory, PointsView points, const constraints::DividedSegments& divided) {
  FoundCrossings found;
  found.count = divided.parents.size();
  found.pairs = memory.upload(std::span(divided.parents));
  std::vector<double> xy(2 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) xy[2 * i] = points.x(i), xy[2 * i + 1] = points.y(i);
  xy.insert(xy.end(), divided.added_xy.begin(), divided.added_xy.end());
  found.places = memory.upload(std::span(std::as_const(xy)));
  const std::vector<std::uint32_t> offsets(divided.offsets.begin(), divided.offsets.end());
  found.chain_offsets = memory.upload(std::span(offsets));
  found.chains = memory.upload(std::span(divided.vertices));
  found.chain_length = divided.vertices.size();
  std::vector<Segment> edges(divided.vertices.size());
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i)
      edges[i] = {divided.vertices[i], divided.vertices[std::min<std::size_t>(i + 1, offsets[s + 1] - 1)]};
  }
  found.chain_edges = memory.upload(std::span(std::as_const(edges)));
  return found;
}

/// With crossings that the host finds. `tries_rounded`: whether a mesh of rounded places may be the one. If the device
/// has no memory for it, it is not tried: the host inserts with its own.
void constrain_by_sweep(const State& state, PointsView points, std::span<const Segment> segments, bool tries_rounded,
                        Data& data) {
  const unsigned threads = state->options.threads;
  const constraints::StopCheck check_stop(state->options, 1);
  const constraints::Arrangement in = constraints::arrange(points, segments, threads, check_stop);
  constraints::DividedSegments divided = constraints::divide_segments(in, segments);
  if (tries_rounded && suits_device(*state->device, divided)) try {
      if (constrain_rounded(state, points, segments, upload_crossings(state->memory, points, divided), data)) return;
    } catch (const OutOfMemory&) {
    }
  const Triangulation delaunay = triangulate_on_host(state, points);
  const constraints::ExactMesh exact =
      constraints::triangulate_with_crossings(in, divided.number, delaunay, threads, check_stop);
  data.mesh = triangulation_of(delaunay, exact, divided.added_xy, data.edge_flags);
  data.added = std::move(divided.added_xy);
  data.parents = std::move(divided.parents);
  data.rounded_valid = exact.rounded_valid;
  take_chains(data, std::move(divided.offsets), std::move(divided.vertices));
}

}  // namespace

void refuse_crossings(const State& state, PointsView points, std::span<const Segment> segments,
                      const std::optional<FoundCrossings>& found) {
  const Options& options = state->options;
  const constraints::StopCheck check_stop(options, 1);
  std::vector<Segment> pairs =
      found ? read_pairs(*state->device, *found)
            : constraints::crossing_pairs(constraints::arrange(points, segments, options.threads, check_stop),
                                          check_stop);
  constraints::check(options.stop);
  if (pairs.empty()) throw InternalError("segments were found to cross, but no pair of them does");
  std::string message =
      std::to_string(pairs.size()) + (pairs.size() == 1 ? " pair of segments crosses: " : " pairs of segments cross: ");
  const std::size_t shown = std::min<std::size_t>(pairs.size(), 3);
  for (std::size_t i = 0; i < shown; ++i)
    message += (i == 0 ? "" : ", ") + std::to_string(pairs[i][0]) + " and " + std::to_string(pairs[i][1]);
  if (shown < pairs.size()) message += ", ...";
  message += "; repair them, or take Crossing::exact or Crossing::grid";
  constraints::check(options.stop);
  throw CrossingError(message, std::move(pairs));
}

void constrain_exactly(const State& state, PointsView points, std::span<const Segment> segments,
                       std::optional<FoundCrossings> found, Data& data) {
  const bool placed = found && found->places;  // by the device
  if (placed && constrain_rounded(state, points, segments, std::move(*found), data)) return;
  constrain_by_sweep(state, points, segments, !placed, data);
}

DeviceMesh constrain_exactly(const State& state, const DevicePoints& points, SegmentJob job) {
  const bool placed = job.crossings && job.crossings->places;
  if (placed) {
    FoundCrossings found = std::move(*job.crossings);
    if (DeviceMesh mesh = constrain_rounded(state, points.size, job, found)) return mesh;
  }
  const CopiedSegments copied = copy_segments(state, points, job);
  Data mesh;
  constrain_by_sweep(state, copied.points(), copied.segments, !placed, mesh);
  return upload_mesh(state, copied.doubles(), mesh);
}

}  // namespace cadt
