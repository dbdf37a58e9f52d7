// SPDX-License-Identifier: Apache-2.0
// Edges, neighbours, half-edges: the mean length of an edge, the Euclidean minimum spanning tree, and a walk around a
// vertex.
//
// usage: example-topology [points]
#include <cadt/cadt.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <numeric>
#include <random>
#include <vector>

int main(int count, char** values) {
  try {
    const std::size_t n = count > 1 ? std::strtoul(values[1], nullptr, 10) : 10000;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> coordinate(0.0, 1.0);
    std::vector<double> xy(2 * n);
    for (double& value : xy) value = coordinate(random);
    cadt::Options options;
    options.backend = cadt::Backend::host;
    options.keep_points = cadt::KeepPoints::copy;
    const cadt::Triangulation mesh = cadt::triangulate(xy, options);

    const cadt::PointsView points = mesh.points();
    const auto length = [&](std::int32_t a, std::int32_t b) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      return std::hypot(points.x(i) - points.x(j), points.y(i) - points.y(j));
    };
    auto edges = cadt::edges(mesh);
    double sum = 0;
    for (const auto& [a, b] : edges) sum += length(a, b);
    std::cout << "edges           " << edges.size() << ", mean length " << sum / static_cast<double>(edges.size())
              << '\n';

    // Kruskal: the minimum spanning tree is part of the Delaunay triangulation.
    std::ranges::sort(edges, {}, [&](const auto& e) { return length(e[0], e[1]); });
    std::vector<std::size_t> parent(n);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::int32_t v) {
      auto at = static_cast<std::size_t>(v);
      while (parent[at] != at) at = parent[at] = parent[parent[at]];
      return at;
    };
    double tree = 0;
    for (const auto& [a, b] : edges) {
      if (root(a) == root(b)) continue;
      parent[root(a)] = root(b);
      tree += length(a, b);
    }
    std::cout << "spanning tree   " << tree << " long\n";

    const cadt::CompressedRows neighbors = cadt::vertex_neighbors(mesh);
    std::cout << "around point 0 ";
    for (const std::int32_t v : neighbors[0]) std::cout << ' ' << v;
    std::cout << "\nwith half-edges";
    // As delaunator's users do it: from an edge that starts at point 0 to the next one clockwise, back to the first.
    const std::vector<std::int64_t> twins = cadt::half_edges(mesh);
    const auto triangles = mesh.triangles();
    const auto first = std::ranges::find(triangles, 0) - triangles.begin();
    std::int64_t e = first;
    do {
      const std::int64_t next = e % 3 == 2 ? e - 2 : e + 1;
      std::cout << ' ' << triangles[static_cast<std::size_t>(next)];
      const std::int64_t twin = twins[static_cast<std::size_t>(e)];  // starts where e ends, and ends at point 0
      e = twin < 0 ? -1 : (twin % 3 == 2 ? twin - 2 : twin + 1);
    } while (e >= 0 && e != first);
    std::cout << (e < 0 ? " and the hull\n" : "\n");
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "example-topology: " << error.what() << '\n';
    return 1;
  }
}
