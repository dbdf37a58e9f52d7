// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/certified_crossings.hpp"

#include <array>
#include <atomic>
#include <utility>

#include "common/constraints/implicit_point.hpp"
#include "common/constraints/tasks.hpp"
#include "common/driver/device_text.hpp"

namespace cadt {
namespace {

/// Input points and crossings as exact places.
class ExactPlaces {
 public:
  ExactPlaces(PointsView points, std::span<const Segment> segments, std::span<const Segment> pairs)
      : points_(points), segments_(segments), pairs_(pairs) {}

  /// Whether a suspect (CADT_SUSPECT) is right: counterclockwise, or a legal edge.
  [[nodiscard]] bool is_right(const Triangulation& mesh, std::uint32_t suspect) const {
    const std::size_t t = suspect / 4, k = suspect % 4;
    std::array<std::int32_t, 4> v{};
    for (std::size_t i = 0; i < 3; ++i) v[i] = mesh.triangles()[3 * t + i];
    std::size_t count = 3;
    if (k < 3) {
      const std::int32_t u = mesh.neighbors()[3 * t + k];
      if (u < 0) return false;  // a crossing on the hull
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t at = 3 * static_cast<std::size_t>(u) + j;
        if (mesh.neighbors()[at] == static_cast<std::int32_t>(t)) v[count = 3] = mesh.triangles()[at], count = 4;
      }
      if (count != 4) return false;
    }
    std::array<exact::Line, 8> lines;
    const exact::ImplicitPoints exact(lines);
    std::array<exact::Place, 4> at;
    for (std::size_t i = 0; i < count; ++i) at[i] = place(static_cast<std::size_t>(v[i]), 2 * i, lines, exact);
    if (count == 3) return exact.orientation(at[0], at[1], at[2]) > 0;
    return exact.incircle_perturbed(at[0], at[1], at[2], at[3]) < 0;
  }

 private:
  [[nodiscard]] exact::Point point(std::int32_t i) const {
    return {points_.x(static_cast<std::size_t>(i)), points_.y(static_cast<std::size_t>(i))};
  }
  [[nodiscard]] exact::Place place(std::size_t v, std::size_t first, std::array<exact::Line, 8>& lines,
                                   const exact::ImplicitPoints& exact) const {
    if (v < points_.size()) return exact::explicit_place(point(static_cast<std::int32_t>(v)));
    for (std::size_t i = 0; i < 2; ++i) {
      const Segment& s = segments_[static_cast<std::size_t>(pairs_[v - points_.size()][i])];
      lines[first + i] = {point(s[0]), point(s[1])};
    }
    return exact.crossing(static_cast<std::int32_t>(first), static_cast<std::int32_t>(first + 1));
  }

  PointsView points_;
  std::span<const Segment> segments_, pairs_;
};

}  // namespace

void take_chains(ConstrainedTriangulation::Data& data, std::vector<std::int64_t> offsets,
                 std::vector<std::int32_t> vertices) {
  data.chain_offsets = std::move(offsets);
  data.chain_vertices = std::move(vertices);
  for (std::size_t s = 0; s + 1 < data.chain_offsets.size(); ++s)
    if (data.chain_offsets[s] == data.chain_offsets[s + 1]) data.degenerate.push_back(static_cast<std::int32_t>(s));
}

std::vector<Segment> read_pairs(Device& device, const FoundCrossings& found) {
  return device.read_values<Segment>(*found.pairs, found.count);
}

bool constrain_rounded(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                       std::span<const Segment> segments, FoundCrossings found,
                       ConstrainedTriangulation::Data& data) {
  Device& device = *state->device;
  const std::size_t n = points.size();
  SegmentJob job;
  job.segments = std::move(found.chain_edges);
  job.count = found.chain_length;
  job.rounded_places = &found.places;
  job.exact_points = n;
  SegmentResults results;
  const DevicePoints places{.x = device.handle(*found.places), .size = n + found.count};
  Triangulation mesh = triangulate_with_segments(state, places, job, results);
  // Rounded pieces cross, run through a vertex, or two crossings have the same rounded place.
  if (job.crossed || job.divided || !job.suspects) return false;
  for (const Duplicate& duplicate : mesh.duplicates())
    if (static_cast<std::size_t>(duplicate.point) >= n) return false;

  const std::vector<Segment> pairs = read_pairs(device, found);
  const ExactPlaces exact(points, segments, pairs);
  std::atomic<bool> right{true};
  constraints::for_each_block(job.suspects->size(), constraints::threads_or_all(state->options.threads),
                              [&](std::size_t first, std::size_t last) {
                                for (std::size_t i = first; i < last && right.load(std::memory_order_relaxed); ++i)
                                  if (!exact.is_right(mesh, (*job.suspects)[i]))
                                    right.store(false, std::memory_order_relaxed);
                              });
  if (!right.load()) return false;

  data.mesh = std::move(mesh);
  data.edge_flags = std::move(results.edge_flags);
  data.added = device.read_values<double>(*found.places, 2 * found.count, 2 * n);
  data.parents = pairs;
  const auto offsets = device.read_values(*found.chain_offsets, segments.size() + 1);
  take_chains(data, {offsets.begin(), offsets.end()},
              device.read_values<std::int32_t>(*found.chains, found.chain_length));
  return true;
}

}  // namespace cadt
