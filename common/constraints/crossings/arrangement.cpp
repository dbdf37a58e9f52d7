// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/crossings/arrangement.hpp"

#include "common/constraints/crossings/sweep.hpp"
#include "common/constraints/stop_check.hpp"
#include "common/platform/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>

namespace cadt::constraints {
namespace {

/// The first segment whose lower end is at or after each point.
std::vector<std::int32_t> first_at(const Arrangement& in) {
  std::vector<std::int32_t> first(in.points.size() + 1, 0);
  for (const auto& s : in.segments) ++first[static_cast<std::size_t>(s[0]) + 1];
  for (std::size_t r = 1; r < first.size(); ++r) first[r] += first[r - 1];
  return first;
}

/// Joins what slabs found. Walls go by their lowest segments in each slab, and segments connect those.
class Walls {
 public:
  explicit Walls(std::size_t segments) : parent_(segments) {
    for (std::size_t s = 0; s < segments; ++s) parent_[s] = static_cast<std::int32_t>(s);
  }
  [[nodiscard]] std::int32_t first_of(std::int32_t s) {
    std::int32_t& up = parent_[static_cast<std::size_t>(s)];
    while (up != parent_[static_cast<std::size_t>(up)]) up = parent_[static_cast<std::size_t>(up)];
    return up;
  }
  void join(std::int32_t s, std::int32_t t) {
    const auto [low, high] = std::minmax({first_of(s), first_of(t)});
    parent_[static_cast<std::size_t>(high)] = low;
  }

 private:
  std::vector<std::int32_t> parent_;  // the lowest segment of a wall is its own
};

void make_walls(Arrangement& out, const std::vector<SlabFindings>& slabs) {
  const std::size_t segments = out.segments.size();
  Walls walls(segments);
  for (const SlabFindings& slab : slabs)
    for (const auto& [s, wall] : slab.parts) walls.join(s, wall);
  out.wall_of.resize(segments);
  for (std::size_t s = 0; s < segments; ++s) {
    const auto first = static_cast<std::size_t>(walls.first_of(static_cast<std::int32_t>(s)));
    if (first == s) out.wall_offsets.push_back(0);
    out.wall_of[s] = first == s ? static_cast<std::int32_t>(out.wall_offsets.size() - 1) : out.wall_of[first];
    ++out.wall_offsets[static_cast<std::size_t>(out.wall_of[s])];
  }
  out.wall_offsets.push_back(0);
  std::exclusive_scan(out.wall_offsets.begin(), out.wall_offsets.end(), out.wall_offsets.begin(), std::int64_t{0});
  std::vector<std::int64_t> at(out.wall_offsets);
  out.wall_segments.resize(segments);
  for (std::size_t s = 0; s < segments; ++s)
    out.wall_segments[static_cast<std::size_t>(at[static_cast<std::size_t>(out.wall_of[s])]++)] =
        static_cast<std::int32_t>(s);
}

/// Chains, crossings and which walls are members of these, in the order of the slabs.
void make_chains(Arrangement& out, const std::vector<SlabFindings>& slabs) {
  const std::size_t points = out.points.size();
  std::size_t crossings = 0;
  out.chain_offsets.assign(out.wall_offsets.size(), 0);
  for (const SlabFindings& slab : slabs) {
    crossings += slab.crossings.size();
    for (const auto& c : slab.contacts)
      ++out.chain_offsets[static_cast<std::size_t>(out.wall_of[static_cast<std::size_t>(c.wall)])];
  }
  std::exclusive_scan(out.chain_offsets.begin(), out.chain_offsets.end(), out.chain_offsets.begin(), std::int64_t{0});
  out.chain_vertices.resize(static_cast<std::size_t>(out.chain_offsets.back()));
  out.crossings.reserve(crossings);
  std::vector<std::int64_t> at(out.chain_offsets);
  for (const SlabFindings& slab : slabs) {
    const auto first = static_cast<std::int32_t>(out.crossings.size());
    for (const auto& c : slab.contacts) {
      const std::int32_t wall = out.wall_of[static_cast<std::size_t>(c.wall)];
      const std::int64_t position = at[static_cast<std::size_t>(wall)]++;
      std::int32_t vertex = c.vertex;
      if (vertex < 0) {
        const std::int32_t crossing = first - 1 - c.vertex;
        if (static_cast<std::size_t>(crossing) == out.member_offsets.size())
          out.member_offsets.push_back(static_cast<std::int64_t>(out.members.size()));
        out.members.push_back({wall, -1, position});
        vertex = static_cast<std::int32_t>(points) + crossing;
      }
      out.chain_vertices[static_cast<std::size_t>(position)] = vertex;
    }
    out.crossings.insert(out.crossings.end(), slab.crossings.begin(), slab.crossings.end());
  }
  out.member_offsets.push_back(static_cast<std::int64_t>(out.members.size()));
}

/// Where in its wall's chain each segment begins and ends, and for each place there the lowest input segment.
void lowest_along_wall(Arrangement& out, std::size_t wall, std::vector<std::int32_t>& lowest) {
  const auto source = [&](std::int32_t s) {
    return out.sources[static_cast<std::size_t>(out.source_offsets[static_cast<std::size_t>(s)])];
  };
  using Active = std::pair<std::int32_t, std::int32_t>;  // lowest input segment, segment
  std::priority_queue<Active, std::vector<Active>, std::greater<>> active;
  std::vector<std::pair<std::int32_t, std::int64_t>> ranks;  // of points in the chain, and where
  std::int64_t next = out.wall_offsets[wall];
  for (std::int64_t i = out.chain_offsets[wall]; i < out.chain_offsets[wall + 1]; ++i) {
    const std::int32_t vertex = out.chain_vertices[static_cast<std::size_t>(i)];
    if (static_cast<std::size_t>(vertex) < out.points.size()) {
      ranks.emplace_back(vertex, i);
      for (; next < out.wall_offsets[wall + 1]; ++next) {
        const std::int32_t s = out.wall_segments[static_cast<std::size_t>(next)];
        if (out.segments[static_cast<std::size_t>(s)][0] != vertex) break;
        active.emplace(source(s), s);
      }
    }
    while (!active.empty() && out.segments[static_cast<std::size_t>(active.top().second)][1] <= ranks.back().first)
      active.pop();
    if (!active.empty()) lowest[static_cast<std::size_t>(i)] = active.top().first;
  }
  const auto position = [&](std::int32_t rank) {
    return std::lower_bound(ranks.begin(), ranks.end(), std::pair(rank, std::int64_t{0}))->second;
  };
  for (std::int64_t i = out.wall_offsets[wall]; i < out.wall_offsets[wall + 1]; ++i) {
    const auto s = static_cast<std::size_t>(out.wall_segments[static_cast<std::size_t>(i)]);
    out.segment_first[s] = position(out.segments[s][0]);
    out.segment_last[s] = position(out.segments[s][1]);
  }
}

void find_lowest(Arrangement& out, unsigned threads) {
  out.segment_first.resize(out.segments.size());
  out.segment_last.resize(out.segments.size());
  std::vector<std::int32_t> lowest(out.chain_vertices.size());
  platform::for_each_block(out.chain_offsets.size() - 1, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t wall = first; wall < last; ++wall) lowest_along_wall(out, wall, lowest);
  });
  out.parents.resize(out.crossings.size());
  platform::for_each_block(out.crossings.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      std::int32_t low = std::numeric_limits<std::int32_t>::max(), second = low;
      for (std::int64_t i = out.member_offsets[c]; i < out.member_offsets[c + 1]; ++i) {
        Arrangement::Member& m = out.members[static_cast<std::size_t>(i)];
        m.source = lowest[static_cast<std::size_t>(m.position)];
        second = std::min(second, std::max(low, m.source));
        low = std::min(low, m.source);
      }
      out.parents[c] = {low, second};
      out.crossings[c].first = out.segment_of[static_cast<std::size_t>(low)];
      out.crossings[c].second = out.segment_of[static_cast<std::size_t>(second)];
    }
  });
}

}  // namespace

Arrangement arrange(PointsView points, std::span<const Segment> segments, unsigned threads,
                    const StopCheck& check_stop) {
  verifier::require_ieee_arithmetic();
  Arrangement out = sort_segments(points, segments);
  const std::vector<std::int32_t> starts = first_at(out);
  threads = platform::threads_or_all(threads);
  // Slabs of equally many points, some for each thread as their crossings differ; a slab starts with a sort of all that
  // enters it, so a few thousand points are the least that is worth it.
  const std::size_t n = out.points.size();
  const std::size_t slabs = threads == 1 ? 1 : std::clamp<std::size_t>(n >> 12, 1, std::size_t{4} * threads);
  std::vector<SlabFindings> found(slabs);
  std::atomic<std::size_t> vertices = n;
  if (!out.segments.empty())
    platform::for_each_task(slabs, threads, [&](std::size_t i) {
      found[i] = sweep_slab(out, starts, static_cast<std::int32_t>(n * i / slabs),
                            static_cast<std::int32_t>(n * (i + 1) / slabs), vertices, check_stop);
    });
  make_walls(out, found);
  make_chains(out, found);
  found = {};
  find_lowest(out, threads);
  return out;
}

}  // namespace cadt::constraints
