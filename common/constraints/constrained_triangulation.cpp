// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "common/constraints/chains.hpp"
#include "common/constraints/constrained_data.hpp"
#include "common/constraints/constraints.hpp"
#include "common/constraints/crossed_segments.hpp"
#include "common/constraints/domains/domains.hpp"
#include "common/constraints/grid/snap_rounding.hpp"
#include "common/constraints/stop_check.hpp"
#include "common/driver/device_text.hpp"
#include "common/driver/session.hpp"
#include "common/driver/thread_state.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

using Data = ConstrainedTriangulation::Data;
using State = std::shared_ptr<Triangulator::State>;

/// False if segments cross: then the data has no mesh.
bool constrain_uncrossed(const State& state, PointsView points, std::span<const Segment> segments, SegmentJob& job,
                         KeepPoints keep, Data& data) {
  job.on_host = segments;
  job.count = segments.size();
  job.wants_chains = true;
  SegmentResults results;
  data.mesh = triangulate_with_segments(state, points, job, results, keep);
  if (job.crossed) return false;
  if (data.mesh.number_of_triangles() == 0) {
    chain_on_line(points, segments, data);
  } else {
    data.edge_flags = std::move(results.edge_flags);
    take_chains(data, {results.chain_offsets.begin(), results.chain_offsets.end()},
                {results.chains.begin(), results.chains.end()});
  }
  return true;
}

void add_domains(const State& state, PointsView points, std::span<const Segment> segments,
                 const ConstraintOptions& constraints, Data& data) {
  Statistics none;
  Context ctx(*state->device, state->memory, state->options, none);
  AddedPlaces added{data.added, segments, data.parents};
  if (constraints.crossing == Crossing::grid) added.pairs = {};  // these are on the grid
  HostDomains found = find_domains(ctx, {data.mesh.triangles(), data.mesh.neighbors(), data.edge_flags, points, added},
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
  require_valid(constraints);
  require_legal_edges(state->options);
  auto data = std::make_shared<Data>();
  SegmentJob job;
  job.wants_crossings = constraints.crossing == Crossing::exact ? FindCrossings::places : FindCrossings::pairs;
  if (constraints.crossing == Crossing::grid) {
    constrain_on_grid(state, points, segments, constraints.grid, *data);
    points = data->moved;
  } else if (!constrain_uncrossed(state, points, segments, job, state->options.keep_points, *data)) {
    if (constraints.crossing == Crossing::error) refuse_crossings(state, points, segments, job.crossings);
    constrain_exactly(state, points, segments, std::move(job.crossings), *data);
  }
  add_domains(state, points, segments, constraints, *data);
  constraints::check(state->options.stop);
  return ConstrainedTriangulation(std::move(data));
}

}  // namespace

void constrain_on_grid(const State& state, PointsView points, std::span<const Segment> segments, double grid,
                       Data& data) {
  if (takes_floats_only(*state->device))
    throw OptionError("crossing",
                      "a grid has places that are no floats, and this device takes no doubles: choose another "
                      "device, or the back end host",
                      "ConstraintOptions::");
  const constraints::SnappedSegments snapped = constraints::snap_segments(
      points, segments, grid, state->options.threads, constraints::StopCheck(state->options, 0));
  const std::vector<Segment> pieces = polyline_segments(snapped.offsets, snapped.vertices);
  require_segments(pieces.size());
  Data divided;
  SegmentJob job;
  const KeepPoints kept = state->options.keep_points;
  // A view would be one of `snapped`.
  const KeepPoints keep = kept == KeepPoints::view ? KeepPoints::copy : kept;
  if (!constrain_uncrossed(state, snapped.xy, pieces, job, keep, divided))
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

void require_segments(std::size_t count) {
  constexpr std::size_t most = (std::size_t{1} << 30) - 1;
  if (count > most)
    throw LimitError("there are " + std::to_string(count) + " segments, more than " + std::to_string(most), count,
                     most);
}

void require_valid(const ConstraintOptions& options) {
  const auto require = [](const char* name, int number, int last) {
    if (number < 0 || number > last)
      throw OptionError(name, "there is no constant of the number " + std::to_string(number), "ConstraintOptions::");
  };
  require("crossing", static_cast<int>(options.crossing), static_cast<int>(Crossing::grid));
  require("domain", static_cast<int>(options.domain), static_cast<int>(Domain::seeds));
  if (options.domain == Domain::seeds || (options.holes.empty() && options.regions.empty())) return;
  throw OptionError(options.holes.empty() ? "regions" : "holes",
                    "these are for Domain::seeds: set it as the domain, or leave them out", "ConstraintOptions::");
}

void require_legal_edges(const Options& options) {
  if (options.tuning.stabilize == Stabilize::paper)
    throw OptionError("tuning.stabilize",
                      "paper leaves edges that are not legal, and meshes with segments have none: take off or defer");
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
