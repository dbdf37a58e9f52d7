// SPDX-License-Identifier: Apache-2.0
#include "io/picture/sheets.hpp"

#include "io/picture/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

namespace cadt::io::picture {

namespace {

/// Neighbours of all points: those of v are at [start[v], start[v + 1]).
struct Graph {
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> to;
};

Graph graph_of(const Scene& scene) {
  Graph g;
  g.start.assign(scene.points() + 2, 0);
  for_each_edge(scene, [&](std::size_t u, std::size_t v) { ++g.start[u + 2], ++g.start[v + 2]; });
  for (std::size_t i = 2; i < g.start.size(); ++i) g.start[i] += g.start[i - 1];
  g.to.resize(g.start.back());
  for_each_edge(scene, [&](std::size_t u, std::size_t v) {
    g.to[g.start[u + 1]++] = static_cast<std::uint32_t>(v);
    g.to[g.start[v + 1]++] = static_cast<std::uint32_t>(u);
  });
  g.start.pop_back();
  return g;
}

/// Median distance of a height from the mean of its neighbours.
float roughness(const Graph& g, const std::vector<float>& h) {
  std::vector<float> off;
  for (std::size_t v = 0; v < h.size(); ++v) {
    const std::size_t degree = g.start[v + 1] - g.start[v];
    if (degree == 0) continue;
    float sum = 0.0f;
    for (std::size_t e = g.start[v]; e < g.start[v + 1]; ++e) sum += h[g.to[e]];
    off.push_back(std::fabs(h[v] - sum / static_cast<float>(degree)));
  }
  return quantile(off, 0.5);
}

}  // namespace

void show_upper_sheet(const Scene& scene, std::vector<float>& h) {
  constexpr float rough = 0.06f;           // of the range of heights; fractal terrain of 500 points has half of that
  constexpr std::size_t most_around = 64;  // neighbours and theirs: bounds the work at points of high degree
  if (h.size() < 50 || scene.hull.empty()) return;
  // Between two sheets; within one, heights of neighbours differ the more the coarser the mesh is.
  const float gap = std::clamp(3.2f / std::sqrt(static_cast<float>(h.size())), 0.02f, 0.1f);
  const Graph g = graph_of(scene);
  if (roughness(g, h) < rough) return;

  std::vector<char> hidden(h.size(), 0);
  std::vector<float> around;
  for (std::size_t v = 0; v < h.size(); ++v) {
    around.assign(1, h[v]);
    for (std::size_t e = g.start[v]; e < g.start[v + 1] && around.size() < most_around; ++e) {
      const std::size_t u = g.to[e];
      around.push_back(h[u]);
      for (std::size_t f = g.start[u]; f < g.start[u + 1] && around.size() < most_around; ++f)
        around.push_back(h[g.to[f]]);
    }
    std::sort(around.begin(), around.end(), std::greater<>());
    // The highest gap parts the sheet that faces the viewer from the rest.
    for (std::size_t i = 0; i + 1 < around.size(); ++i) {
      if (around[i] - around[i + 1] < gap) continue;
      hidden[v] = h[v] < around[i] - 0.5f * gap;
      break;
    }
  }

  // Hidden points take the mean of the visible ones around, from the borders of larger hidden patches inwards.
  constexpr int most_rounds = 8;
  std::vector<std::pair<std::size_t, float>> raised;
  for (int round = 0; round < most_rounds; ++round) {
    raised.clear();
    for (std::size_t v = 0; v < h.size(); ++v) {
      if (!hidden[v]) continue;
      float sum = 0.0f;
      int count = 0;
      for (std::size_t e = g.start[v]; e < g.start[v + 1]; ++e) {
        if (hidden[g.to[e]]) continue;
        sum += h[g.to[e]];
        ++count;
      }
      if (count != 0) raised.push_back({v, sum / static_cast<float>(count)});
    }
    if (raised.empty()) break;
    for (const auto& [v, height] : raised) {
      h[v] = height;
      hidden[v] = 0;
    }
  }

  // The side that is seen gets the whole range of colours.
  std::vector<float> seen = h;
  const float low = quantile(seen, 0.005);
  const float high = quantile(seen, 0.995);
  if (!(low < high)) return;
  for (float& v : h) v = (v - low) / (high - low);
}

}  // namespace cadt::io::picture
