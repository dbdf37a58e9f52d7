// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "common/constraints/constrained_data.hpp"
#include "common/constraints/constraints.hpp"
#include "common/constraints/crossed_segments.hpp"
#include "common/constraints/domains.hpp"
#include "common/constraints/snap_rounding.hpp"
#include "common/constraints/tasks.hpp"
#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/driver/thread_state.hpp"

namespace cadt {
namespace {

using Data = ConstrainedTriangulation::Data;

std::int32_t representative(const Triangulation& mesh, std::int32_t point) {
  const std::int32_t other = mesh.duplicate_of(static_cast<std::size_t>(point));
  return other < 0 ? point : other;
}

/// Chains of segments between points on a line, where there are no triangles.
void chain_on_line(PointsView points, std::span<const Segment> segments, Data& data) {
  const auto n = static_cast<std::int32_t>(points.size());
  const auto at = [&](std::int32_t i) {
    const auto k = static_cast<std::size_t>(i);
    return std::pair(points.x(k), points.y(k));
  };
  std::vector<std::int32_t> order;
  for (std::int32_t i = 0; i < n; ++i)
    if (representative(data.mesh, i) == i) order.push_back(i);
  std::ranges::sort(order, {}, at);
  std::vector<std::int32_t> rank(points.size());
  for (std::size_t r = 0; r < order.size(); ++r)
    rank[static_cast<std::size_t>(order[r])] = static_cast<std::int32_t>(r);
  for (std::size_t s = 0; s < segments.size(); ++s) {
    std::array<std::int32_t, 2> ends{};
    for (std::size_t e = 0; e < 2; ++e) {
      if (segments[s][e] < 0 || segments[s][e] >= n)
        throw InputError(
            "segment " + std::to_string(s) + " has an end that is none of the " + std::to_string(n) + " points", s);
      ends[e] = rank[static_cast<std::size_t>(representative(data.mesh, segments[s][e]))];
    }
    const std::int32_t step = ends[0] < ends[1] ? 1 : -1;
    for (std::int32_t r = ends[0]; ends[0] != ends[1]; r += step) {
      data.chain_vertices.push_back(order[static_cast<std::size_t>(r)]);
      if (r == ends[1]) break;
    }
    data.chain_offsets.push_back(static_cast<std::int64_t>(data.chain_vertices.size()));
  }
}

using State = std::shared_ptr<Triangulator::State>;

/// False if segments cross: then the data has no mesh.
bool constrain_uncrossed(const State& state, PointsView points, std::span<const Segment> segments, SegmentJob& job,
                         Data& data) {
  job.on_host = segments;
  job.count = segments.size();
  job.wants_chains = true;
  SegmentResults results;
  data.mesh = triangulate_with_segments(state, points, job, results);
  if (job.crossed) return false;
  if (data.mesh.number_of_triangles() == 0) {
    chain_on_line(points, segments, data);
    take_chains(data, std::move(data.chain_offsets), std::move(data.chain_vertices));
  } else {
    data.edge_flags = std::move(results.edge_flags);
    take_chains(data, {results.chain_offsets.begin(), results.chain_offsets.end()},
                {results.chains.begin(), results.chains.end()});
  }
  return true;
}

void constrain_on_grid(const State& state, PointsView points, std::span<const Segment> segments, double grid,
                       Data& data) {
  const constraints::SnappedSegments snapped =
      constraints::snap_segments(points, segments, grid, state->options.threads, state->options.stop);
  const std::vector<Segment> pieces = polyline_segments(snapped.offsets, snapped.vertices);
  Data divided;
  SegmentJob job;
  if (!constrain_uncrossed(state, snapped.xy, pieces, job, divided))
    throw InternalError("segments still cross after snap rounding");
  data.mesh = std::move(divided.mesh);
  data.edge_flags = std::move(divided.edge_flags);
  data.parents = snapped.parents;
  const auto moved = snapped.xy.begin() + static_cast<std::ptrdiff_t>(2 * points.size());
  data.moved.assign(snapped.xy.begin(), moved);
  data.added.assign(moved, snapped.xy.end());
  // The chain of a segment: those of its pieces, which end where the next one begins.
  std::vector<std::int64_t> offsets = {0};
  std::vector<std::int32_t> vertices;
  std::size_t piece = 0;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    for (std::int64_t i = snapped.offsets[s] + 1; i < snapped.offsets[s + 1]; ++i, ++piece) {
      for (auto at = static_cast<std::size_t>(divided.chain_offsets[piece]);
           at < static_cast<std::size_t>(divided.chain_offsets[piece + 1]); ++at) {
        const std::int32_t v = divided.chain_vertices[at];
        if (static_cast<std::int64_t>(vertices.size()) == offsets.back() || vertices.back() != v) vertices.push_back(v);
      }
    }
    offsets.push_back(static_cast<std::int64_t>(vertices.size()));
  }
  take_chains(data, std::move(offsets), std::move(vertices));
}

void add_domains(const State& state, PointsView points, const ConstraintOptions& constraints, Data& data) {
  Statistics none;
  Context ctx(*state->device, state->memory, state->options, none);
  HostDomains found =
      find_domains(ctx, {data.mesh.triangles(), data.mesh.neighbors(), data.edge_flags, points, data.added},
                   {data.chain_offsets, data.chain_vertices}, constraints);
  data.inside = std::move(found.inside);
  data.number_inside = found.number_inside;
  data.region = std::move(found.region);
  data.region_value = std::move(found.region_value);
  data.region_attribute = std::move(found.region_attribute);
}

ConstrainedTriangulation constrain_on(const State& state, PointsView points, std::span<const Segment> segments,
                                      const ConstraintOptions& constraints) {
  require_size(points.size());
  require_segments(segments.size());
  auto data = std::make_shared<Data>();
  SegmentJob job;
  job.wants_crossings = constraints.crossing == Crossing::exact ? FindCrossings::places : FindCrossings::pairs;
  if (constraints.crossing == Crossing::grid) {
    constrain_on_grid(state, points, segments, constraints.grid, *data);
    points = data->moved;
  } else if (!constrain_uncrossed(state, points, segments, job, *data)) {
    if (constraints.crossing == Crossing::error) refuse_crossings(state, points, segments, job.crossings);
    constrain_exactly(state, points, segments, std::move(job.crossings), *data);
  }
  add_domains(state, points, constraints, *data);
  constraints::check(state->options.stop);
  return ConstrainedTriangulation(std::move(data));
}

}  // namespace

void require_segments(std::size_t count) {
  constexpr std::size_t most = (std::size_t{1} << 30) - 1;
  if (count > most)
    throw LimitError("there are " + std::to_string(count) + " segments, more than " + std::to_string(most), count,
                     most);
}

ConstrainedEdges edges_of_chains(std::span<const std::int64_t> offsets, std::span<const std::int32_t> vertices) {
  struct Part {
    Segment edge;
    std::int32_t source;
  };
  std::vector<Part> parts;
  parts.reserve(vertices.size());
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    for (auto i = static_cast<std::size_t>(offsets[s]); i + 1 < static_cast<std::size_t>(offsets[s + 1]); ++i) {
      const std::int32_t from = vertices[i], to = vertices[i + 1], source = static_cast<std::int32_t>(s);
      parts.push_back(from < to ? Part{{from, to}, source} : Part{{to, from}, -1 - source});
    }
  }
  std::ranges::sort(parts, {}, [](const Part& p) { return std::tuple(p.edge[0], p.edge[1], p.source); });
  ConstrainedEdges result;
  for (const Part& part : parts) {
    if (result.edges.empty() || result.edges.back() != part.edge) {
      result.edges.push_back(part.edge);
      result.offsets.push_back(static_cast<std::int64_t>(result.sources.size()));
    }
    result.sources.push_back(part.source);
  }
  result.offsets.push_back(static_cast<std::int64_t>(result.sources.size()));
  return result;
}

const ConstrainedEdges& Data::edges() const {
  std::call_once(made_, [&] { edges_ = edges_of_chains(chain_offsets, chain_vertices); });
  return edges_;
}

ConstrainedTriangulation triangulate_constrained(PointsView points, std::span<const Segment> segments,
                                                 const ConstraintOptions& constraints, const Options& options) {
  const CallState state(options, points.size());
  return constrain_on(*state, points, segments, constraints);
}

ConstrainedTriangulation Triangulator::triangulate_constrained(PointsView points, std::span<const Segment> segments,
                                                               const ConstraintOptions& constraints) {
  return constrain_on(state_, points, segments, constraints);
}

ConstrainedTriangulation::ConstrainedTriangulation() : data_(std::make_shared<Data>()) {}
ConstrainedTriangulation::~ConstrainedTriangulation() = default;
ConstrainedTriangulation::ConstrainedTriangulation(const ConstrainedTriangulation&) noexcept = default;
ConstrainedTriangulation& ConstrainedTriangulation::operator=(const ConstrainedTriangulation&) noexcept = default;
ConstrainedTriangulation::ConstrainedTriangulation(ConstrainedTriangulation&&) noexcept = default;
ConstrainedTriangulation& ConstrainedTriangulation::operator=(ConstrainedTriangulation&&) noexcept = default;
ConstrainedTriangulation::ConstrainedTriangulation(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

const Triangulation& ConstrainedTriangulation::mesh() const noexcept { return data_->mesh; }
std::span<const std::uint32_t> ConstrainedTriangulation::edge_flags() const noexcept { return data_->edge_flags; }
bool ConstrainedTriangulation::is_constrained(std::size_t triangle, std::size_t k) const {
  (void)data_->mesh.neighbor(triangle, k);  // refuses what is not there
  return (data_->edge_flags[triangle] >> k & 1U) != 0;
}
std::span<const std::int64_t> ConstrainedTriangulation::chain_offsets() const noexcept { return data_->chain_offsets; }
std::span<const std::int32_t> ConstrainedTriangulation::chain_vertices() const noexcept {
  return data_->chain_vertices;
}
std::span<const Segment> ConstrainedTriangulation::constrained_edges() const { return data_->edges().edges; }
std::span<const std::int64_t> ConstrainedTriangulation::source_offsets() const { return data_->edges().offsets; }
std::span<const std::int32_t> ConstrainedTriangulation::edge_sources() const { return data_->edges().sources; }
std::span<const std::int32_t> ConstrainedTriangulation::degenerate_segments() const noexcept {
  return data_->degenerate;
}
std::span<const std::uint8_t> ConstrainedTriangulation::inside() const noexcept { return data_->inside; }
std::size_t ConstrainedTriangulation::number_inside() const noexcept { return data_->number_inside; }
std::span<const std::int32_t> ConstrainedTriangulation::region() const noexcept { return data_->region; }
std::size_t ConstrainedTriangulation::number_of_regions() const noexcept { return data_->region_value.size(); }
std::span<const std::int32_t> ConstrainedTriangulation::region_value() const noexcept { return data_->region_value; }
std::span<const double> ConstrainedTriangulation::region_attribute() const noexcept { return data_->region_attribute; }
std::vector<std::int32_t> ConstrainedTriangulation::triangles_inside() const {
  std::vector<std::int32_t> result;
  result.reserve(3 * data_->number_inside);
  const auto all = data_->mesh.triangles();
  for (std::size_t t = 0; t < data_->inside.size(); ++t)
    if (data_->inside[t] != 0) result.insert(result.end(), {all[3 * t], all[3 * t + 1], all[3 * t + 2]});
  return result;
}
std::span<const double> ConstrainedTriangulation::added_points() const noexcept { return data_->added; }
std::span<const std::array<std::int32_t, 2>> ConstrainedTriangulation::added_parents() const noexcept {
  return data_->parents;
}
bool ConstrainedTriangulation::rounded_valid() const noexcept { return data_->rounded_valid; }
std::span<const double> ConstrainedTriangulation::moved_points() const noexcept { return data_->moved; }
const Statistics& ConstrainedTriangulation::statistics() const noexcept { return data_->mesh.statistics(); }

Hash128 ConstrainedTriangulation::hash() const {
  using namespace device_text;
  const Hash128 mesh = data_->mesh.hash();
  cadt_hash hash = {mesh.high, mesh.low};
  for (const Segment& edge : constrained_edges())
    cadt_hash_add(&hash, CADT_HASH_CONSTRAINED, static_cast<std::uint64_t>(edge[0]),
                  static_cast<std::uint64_t>(edge[1]), 0);
  return {hash.high, hash.low};
}

}  // namespace cadt
