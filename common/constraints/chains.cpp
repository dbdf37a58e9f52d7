// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/chains.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace cadt {
namespace {

using Data = ConstrainedTriangulation::Data;

std::int32_t representative(const Triangulation& mesh, std::int32_t point) {
  const std::int32_t other = mesh.duplicate_of(static_cast<std::size_t>(point));
  return other < 0 ? point : other;
}

}  // namespace

void take_chains(Data& data, std::vector<std::int64_t> offsets, std::vector<std::int32_t> vertices) {
  data.chain_offsets = std::move(offsets);
  data.chain_vertices = std::move(vertices);
  for (std::size_t s = 0; s + 1 < data.chain_offsets.size(); ++s)
    if (data.chain_offsets[s] == data.chain_offsets[s + 1]) data.degenerate.push_back(static_cast<std::int32_t>(s));
}

void refuse_segment(std::size_t s, const Segment& segment, std::size_t points) {
  const bool first = segment[0] < 0 || static_cast<std::size_t>(segment[0]) >= points;
  throw InputError("segment " + std::to_string(s) + " ends at point " + std::to_string(segment[first ? 0 : 1]) +
                       ", but there are " + std::to_string(points) + " points",
                   s);
}

void require_chain_length(std::size_t length) {
  constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
  if (length > most)
    throw LimitError("the chains of all segments have " + std::to_string(length) + " vertices, more than " +
                         std::to_string(most) + ": many segments overlap; leave out those that repeat others",
                     length, most);
}

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
  std::vector<std::int64_t> offsets = {0};
  std::vector<std::int32_t> vertices;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    std::array<std::int32_t, 2> ends{};
    for (std::size_t e = 0; e < 2; ++e) {
      if (segments[s][e] < 0 || segments[s][e] >= n) refuse_segment(s, segments[s], points.size());
      ends[e] = rank[static_cast<std::size_t>(representative(data.mesh, segments[s][e]))];
    }
    const std::int32_t step = ends[0] < ends[1] ? 1 : -1;
    for (std::int32_t r = ends[0]; ends[0] != ends[1]; r += step) {
      vertices.push_back(order[static_cast<std::size_t>(r)]);
      if (r == ends[1]) break;
    }
    offsets.push_back(static_cast<std::int64_t>(vertices.size()));
  }
  take_chains(data, std::move(offsets), std::move(vertices));
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

}  // namespace cadt
