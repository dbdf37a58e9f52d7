// SPDX-License-Identifier: Apache-2.0
#include "small_delaunay.hpp"

#include "truth.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <random>

void TestMesh::complete() {
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> edge;
  for (std::size_t e = 0; e < triangles.size(); ++e)
    edge[{triangles[e - e % 3 + (e + 1) % 3], triangles[e - e % 3 + (e + 2) % 3]}] = e;
  neighbors.assign(triangles.size(), -1);
  hull.clear();
  std::map<std::int32_t, std::int32_t> next;
  for (const auto& [ends, e] : edge) {
    const auto other = edge.find({ends.second, ends.first});
    if (other != edge.end()) {
      neighbors[e] = static_cast<std::int32_t>(other->second / 3);
    } else {
      next[ends.first] = ends.second;
    }
  }
  if (!next.empty())
    for (std::int32_t v = next.begin()->first; hull.empty() || v != hull.front(); v = next[v]) hull.push_back(v);
  duplicates.clear();
  std::map<std::pair<double, double>, std::int32_t> lowest;
  for (std::size_t i = 0; i < xy.size() / 2; ++i) {
    const auto p = static_cast<std::int32_t>(i);
    const auto [it, fresh] = lowest.insert({{xy[2 * i], xy[2 * i + 1]}, p});
    if (!fresh) duplicates.push_back({p, it->second});
  }
}

TestMesh brute_force_delaunay(std::vector<double> xy) {
  TestMesh mesh;
  mesh.xy = std::move(xy);
  mesh.complete();
  std::vector<std::int32_t> used;
  std::vector<truth::Point> p;
  for (std::size_t i = 0; i < mesh.xy.size() / 2; ++i) {
    p.push_back({mesh.xy[2 * i], mesh.xy[2 * i + 1]});
    const auto k = static_cast<std::int32_t>(i);
    if (std::ranges::none_of(mesh.duplicates, [&](const cadt::Duplicate& d) { return d.point == k; }))
      used.push_back(k);
  }
  const auto at = [&](std::int32_t i) { return p[static_cast<std::size_t>(i)]; };
  for (std::size_t i = 0; i < used.size(); ++i)
    for (std::size_t j = i + 1; j < used.size(); ++j)
      for (std::size_t k = j + 1; k < used.size(); ++k) {
        const std::int32_t a = used[i];
        std::int32_t b = used[j], c = used[k];
        const int turn = truth::orientation(at(a), at(b), at(c));
        if (turn == 0) continue;
        if (turn < 0) std::swap(b, c);
        const bool empty = std::ranges::all_of(used, [&](std::int32_t d) {
          return d == a || d == b || d == c || truth::incircle_perturbed(at(a), at(b), at(c), at(d)) < 0;
        });
        if (empty) mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
      }
  mesh.complete();
  return mesh;
}

TestMesh lattice(int columns, int rows, double step) {
  TestMesh mesh;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) mesh.xy.insert(mesh.xy.end(), {step * i, step * j});
  const auto at = [&](int i, int j) { return static_cast<std::int32_t>(i * rows + j); };
  for (int i = 0; i + 1 < columns; ++i)
    for (int j = 0; j + 1 < rows; ++j)
      mesh.triangles.insert(mesh.triangles.end(), {at(i, j), at(i + 1, j), at(i, j + 1),  //
                                                   at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  mesh.complete();
  return mesh;
}

TestMesh hub(int n) {
  TestMesh mesh;
  mesh.xy = {0, 0};
  for (std::int32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    mesh.xy.insert(mesh.xy.end(), {std::cos(angle), std::sin(angle)});
    mesh.triangles.insert(mesh.triangles.end(), {0, 1 + i, 1 + (i + 1) % n});
  }
  mesh.complete();
  return mesh;
}

std::vector<double> random_points(int n, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<double> xy;
  for (int i = 0; i < 2 * n; ++i) xy.push_back(std::ldexp(static_cast<double>(engine() >> 11), -53));
  return xy;
}
