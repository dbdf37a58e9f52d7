// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact_mesh/exact_crossings.hpp"

#include "common/constraints/chains.hpp"
#include "common/constraints/exact_mesh/mesh_editor.hpp"
#include "common/constraints/stop_check.hpp"
#include "common/platform/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <compare>
#include <numeric>
#include <random>

namespace cadt::constraints {
namespace {

/// The place of a point of a grid of 2^16 x 2^16 along Hilbert's curve.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  std::uint32_t index = 0;
  for (std::uint32_t bit = 1U << 15; bit != 0; bit >>= 1) {
    const std::uint32_t right = (x & bit) != 0, up = (y & bit) != 0;
    index = index * 4 + ((3 * right) ^ up);
    if (up == 0) {
      if (right != 0) x = ~x, y = ~y;
      std::swap(x, y);
    }
  }
  return index;
}

/// Crossings in random rounds, each about twice as large as those before it together, so that a few that are spread
/// first part what the others, one behind the other along a segment, would all change in turn; in a round each near the
/// one before (N. Amenta, S. Choi, G. Rote, "Incremental constructions con BRIO", 2003). The same in each run.
std::vector<std::int32_t> insertion_order(const Arrangement& in) {
  double left = 0, right = 0, bottom = 0, top = 0;
  for (std::size_t c = 0; c < in.crossings.size(); ++c) {
    const double x = in.crossings[c].x, y = in.crossings[c].y;
    if (c == 0) left = right = x, bottom = top = y;
    left = std::min(left, x), right = std::max(right, x), bottom = std::min(bottom, y), top = std::max(top, y);
  }
  // halves do not overflow
  const auto scaled = [](double v, double low, double high) {
    const double width = high / 2 - low / 2;
    return width > 0 ? static_cast<std::uint32_t>((v / 2 - low / 2) / width * 65535) : 0U;
  };
  struct Key {
    int later;  // rounds
    std::uint32_t place;
    std::int32_t crossing;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys(in.crossings.size());
  std::mt19937 random(1);
  for (std::size_t c = 0; c < keys.size(); ++c) {
    const exact::Place& p = in.crossings[c];
    keys[c] = {-std::countr_zero(random() | 1U << 31),
               hilbert_index(scaled(p.x, left, right), scaled(p.y, bottom, top)), static_cast<std::int32_t>(c)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::int32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].crossing;
  return order;
}

/// A random order, the same in each run: edges that are next to each other, such as the spokes of a wheel, would all
/// cross the same triangles one after the other; so each has those between its neighbours alone.
std::vector<std::size_t> order_of_walls(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(1);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

MeshEditor edit(const Arrangement& in, const Triangulation& delaunay, const StopCheck& check_stop) {
  const auto triangles = delaunay.triangles(), neighbors = delaunay.neighbors();
  std::vector<std::int32_t> ranks(triangles.size());
  for (std::size_t i = 0; i < ranks.size(); ++i) ranks[i] = in.rank[static_cast<std::size_t>(triangles[i])];
  return MeshEditor(in, std::move(ranks), {neighbors.begin(), neighbors.end()}, check_stop);
}

}  // namespace

DividedSegments divide_segments(const Arrangement& in, std::span<const Segment> segments) {
  const std::size_t points = in.rank.size(), ranks = in.points.size(), crossings = in.crossings.size();
  DividedSegments out;
  // Added vertices in the order of their pairs
  std::vector<std::int32_t> order(crossings);
  out.number.resize(ranks + crossings);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return in.parents[static_cast<std::size_t>(a)] < in.parents[static_cast<std::size_t>(b)];
  });
  std::copy(in.representative.begin(), in.representative.end(), out.number.begin());
  for (const std::int32_t c : order) {
    const auto i = static_cast<std::size_t>(c);
    out.number[ranks + i] = static_cast<std::int32_t>(points + out.parents.size());
    out.added_xy.insert(out.added_xy.end(), {in.crossings[i].x, in.crossings[i].y});
    out.parents.push_back(in.parents[i]);
  }

  std::size_t length = 0;
  for (const std::int32_t s : in.segment_of)
    if (s >= 0)
      length += static_cast<std::size_t>(in.segment_last[static_cast<std::size_t>(s)] -
                                         in.segment_first[static_cast<std::size_t>(s)] + 1);
  require_chain_length(length);
  out.vertices.reserve(length);
  out.offsets.assign(segments.size() + 1, 0);
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (in.segment_of[s] >= 0) {
      const auto same = static_cast<std::size_t>(in.segment_of[s]);
      const auto first = out.vertices.size();
      for (std::int64_t i = in.segment_first[same]; i <= in.segment_last[same]; ++i)
        out.vertices.push_back(out.number[static_cast<std::size_t>(in.chain_vertices[static_cast<std::size_t>(i)])]);
      if (in.rank[static_cast<std::size_t>(segments[s][0])] != in.segments[same][0])
        std::reverse(out.vertices.begin() + static_cast<std::ptrdiff_t>(first), out.vertices.end());
    }
    out.offsets[s + 1] = static_cast<std::int64_t>(out.vertices.size());
  }
  return out;
}

ExactMesh triangulate_with_crossings(const Arrangement& in, std::span<const std::int32_t> number,
                                     const Triangulation& delaunay, unsigned threads, const StopCheck& check_stop) {
  MeshEditor mesh = edit(in, delaunay, check_stop);
  for (const std::int32_t c : insertion_order(in)) {
    check_stop();
    mesh.insert_vertex(static_cast<std::int32_t>(in.points.size()) + c);
  }
  for (const std::size_t wall : order_of_walls(mesh.triangles().empty() ? 0 : in.chain_offsets.size() - 1)) {
    mesh.insert_chain(std::span(in.chain_vertices.data() + in.chain_offsets[wall],
                                in.chain_vertices.data() + in.chain_offsets[wall + 1]));
  }

  ExactMesh out;
  out.neighbors = mesh.neighbors();
  out.edge_flags.assign(mesh.flags().begin(), mesh.flags().end());
  out.triangles.resize(mesh.triangles().size());
  std::atomic<bool> valid{true};
  const unsigned all = platform::threads_or_all(threads);
  platform::for_each_block(out.edge_flags.size(), all, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t) {
      std::array<exact::Place, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t v = mesh.triangles()[3 * t + k];
        p[k] = in.place(v);
        out.triangles[3 * t + k] = number[static_cast<std::size_t>(v)];
      }
      if (!(p[0].is_double() && p[1].is_double() && p[2].is_double()) &&
          verifier::orientation(p[0].rounded(), p[1].rounded(), p[2].rounded()) <= 0)
        valid.store(false, std::memory_order_relaxed);
    }
  });
  out.rounded_valid = valid.load();
  return out;
}

}  // namespace cadt::constraints
