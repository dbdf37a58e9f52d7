// SPDX-License-Identifier: Apache-2.0
// Delaunay meshes some edges of which are taken for constrained, and what is found of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "common/constraints/domains/domains.hpp"
#include "common/driver/registry.hpp"
#include "tests/support/backends.hpp"

namespace cadt::test {

/// A mesh and segments that are edges of it.
struct Marked {
  std::vector<double> xy;
  Triangulation mesh;
  std::vector<std::uint32_t> flags;
  std::vector<std::int64_t> offsets = {0};
  std::vector<std::int32_t> chains;

  explicit Marked(std::vector<double> points) : xy(std::move(points)) {
    Options options;
    options.backend = Backend::host;
    options.threads = 1;
    mesh = triangulate(std::span<const double>(xy), options);
    flags.assign(mesh.number_of_triangles(), 0);
  }

  [[nodiscard]] std::size_t size() const { return flags.size(); }
  [[nodiscard]] std::int32_t vertex(std::size_t t, std::size_t k) const { return mesh.triangles()[3 * t + k % 3]; }
  [[nodiscard]] std::int32_t across(std::size_t t, std::size_t k) const { return mesh.neighbors()[3 * t + k]; }
  [[nodiscard]] bool flagged(std::size_t t, std::size_t k) const { return (flags[t] >> k & 1) != 0; }

  /// A segment along edge k of triangle t, which lies left of it if `left`.
  void add(std::size_t t, std::size_t k, bool left = true) {
    std::int32_t from = vertex(t, k + 1), to = vertex(t, k + 2);
    if (!left) std::swap(from, to);
    chains.insert(chains.end(), {from, to});
    offsets.push_back(static_cast<std::int64_t>(chains.size()));
    flags[t] |= 1U << k;
    const std::int32_t n = across(t, k);
    for (std::size_t j = 0; n >= 0 && j < 3; ++j)
      if (across(static_cast<std::size_t>(n), j) == static_cast<std::int32_t>(t))
        flags[static_cast<std::size_t>(n)] |= 1U << j;
  }
  void add_outline(std::size_t t, bool left) {
    for (std::size_t k = 0; k < 3; ++k) add(t, k, left);
  }
  /// Along the edge between two vertices.
  void add_edge(std::int32_t from, std::int32_t to) {
    for (std::size_t t = 0; t < size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        if (vertex(t, k + 1) == from && vertex(t, k + 2) == to) return add(t, k);
        if (vertex(t, k + 1) == to && vertex(t, k + 2) == from) return add(t, k, false);
      }
    FAIL() << from << " " << to << " is no edge";
  }
};

/// What the library finds on one device.
class Found {
 public:
  Found(const BackendCase& on, const Marked& marked, const ConstraintOptions& constraints)
      : options_(on.options()),
        device_(open_device(options_)),
        memory_(*device_, true),
        ctx_(*device_, memory_, options_, statistics_) {
    result = find_domains(ctx_, {marked.mesh.triangles(), marked.mesh.neighbors(), marked.flags, marked.xy, {}},
                          {marked.offsets, marked.chains}, constraints);
    pack(marked, constraints);
  }

  HostDomains result;
  std::vector<std::int32_t> triangles, neighbors;
  std::vector<std::uint32_t> flags;

 private:
  void pack(const Marked& marked, const ConstraintOptions& constraints) {
    const std::size_t count = marked.size();
    if (count == 0) return;
    const Allocation vertices = memory_.import(marked.mesh.triangles().data(), 12 * count),
                     across = memory_.import(marked.mesh.neighbors().data(), 12 * count),
                     edge_flags = memory_.import(marked.flags.data(), 4 * count);
    const DomainMesh mesh = {vertices, across, edge_flags, count};
    const DomainSeeds seeds = locate_seeds(marked.mesh.triangles(), marked.xy, {}, constraints);
    const std::vector<std::uint32_t> begins(marked.offsets.begin(), marked.offsets.end());
    const Allocation offsets = memory_.import(begins.data(), 4 * begins.size());
    Allocation along;
    if (!marked.chains.empty()) along = memory_.import(marked.chains.data(), 4 * marked.chains.size());
    const Domains domains = find_domains(ctx_, mesh, marked.xy.size() / 2,
                                         {offsets, along, begins.size() - 1, marked.chains.size()}, seeds, constraints);
    const InsideMesh packed = pack_inside(ctx_, mesh, domains);
    if (packed.triangles == 0) return;
    triangles = device_->read_values<std::int32_t>(*packed.vertices, 3 * packed.triangles);
    neighbors = device_->read_values<std::int32_t>(*packed.neighbors, 3 * packed.triangles);
    flags = device_->read_values<std::uint32_t>(*packed.edge_flags, packed.triangles);
  }

  Options options_;
  std::unique_ptr<Device> device_;
  Memory memory_;
  Statistics statistics_;
  Context ctx_;
};

/// Regions, triangle by triangle, and the fewest constrained edges to the outside.
struct Searched {
  std::vector<std::int32_t> region, depth;
  std::int32_t regions = 0;

  explicit Searched(const Marked& m) : region(m.size(), -1), depth(m.size(), -1) {
    for (std::size_t t = 0; t < m.size(); ++t) {
      if (region[t] >= 0) continue;
      std::vector<std::size_t> stack = {t};
      region[t] = regions;
      while (!stack.empty()) {
        const std::size_t at = stack.back();
        stack.pop_back();
        for (std::size_t k = 0; k < 3; ++k) visit(m, at, k, stack);
      }
      ++regions;
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t t = 0; t < m.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t n = m.across(t, k), beyond = n < 0 ? 0 : depth[static_cast<std::size_t>(n)];
          const std::int32_t reached = beyond + (m.flagged(t, k) ? 1 : 0);
          if (beyond < 0 || (depth[t] >= 0 && depth[t] <= reached)) continue;
          depth[t] = reached;
          changed = true;
        }
    }
  }

 private:
  /// Across edge k; one may go around the hull.
  void visit(const Marked& m, std::size_t t, std::size_t k, std::vector<std::size_t>& stack) {
    if (m.flagged(t, k)) return;
    for (std::size_t n = 0; n < m.size(); ++n) {
      const bool beside = m.across(t, k) == static_cast<std::int32_t>(n), around = m.across(t, k) < 0 && open(m, n);
      if (region[n] >= 0 || !(beside || around)) continue;
      region[n] = region[t];
      stack.push_back(n);
    }
  }
  static bool open(const Marked& m, std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k)
      if (m.across(t, k) < 0 && !m.flagged(t, k)) return true;
    return false;
  }
};

inline std::vector<double> random_points(std::size_t n, std::uint64_t seed, bool lattice) {
  std::mt19937_64 random(seed);
  std::vector<double> xy;
  for (std::size_t i = 0; i < 2 * n; ++i)
    xy.push_back(lattice ? static_cast<double>(random() % 23) : static_cast<double>(random() >> 11) * 0x1p-53);
  return xy;
}

/// Squares 0..3, 4..7, 8..11, ..., each in the one before and a quarter of its size, so that their sides are Delaunay
/// edges, with the given directions. Square i cuts the x axis at half_width(i).
inline double half_width(std::size_t i) { return std::ldexp(1024, -2 * static_cast<int>(i)); }
inline Marked nested_squares(const std::vector<bool>& counterclockwise) {
  std::vector<double> xy;
  for (std::size_t i = 0; i < counterclockwise.size(); ++i) {
    const double r = half_width(i);
    xy.insert(xy.end(), {-r, -r, r, -r, r, r, -r, r});
  }
  xy.insert(xy.end(), {-9000, 1, 0, -9001, 9002, 0, 0, 9003});
  Marked marked(xy);
  for (std::size_t i = 0; i < counterclockwise.size(); ++i)
    for (std::int32_t k = 0; k < 4; ++k) {
      const auto first = static_cast<std::int32_t>(4 * i), a = first + k, b = first + (k + 1) % 4;
      counterclockwise[i] ? marked.add_edge(a, b) : marked.add_edge(b, a);
    }
  return marked;
}

/// The triangle that has the place inside.
inline std::size_t triangle_at(const Marked& m, double x, double y) {
  const auto side = [&](std::int32_t a, std::int32_t b) {
    const double* p = &m.xy[2 * static_cast<std::size_t>(a)];
    const double* q = &m.xy[2 * static_cast<std::size_t>(b)];
    return (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
  };
  for (std::size_t t = 0; t < m.size(); ++t)
    if (side(m.vertex(t, 0), m.vertex(t, 1)) > 0 && side(m.vertex(t, 1), m.vertex(t, 2)) > 0 &&
        side(m.vertex(t, 2), m.vertex(t, 0)) > 0)
      return t;
  ADD_FAILURE() << "no triangle at " << x << " " << y;
  return 0;
}

}  // namespace cadt::test
