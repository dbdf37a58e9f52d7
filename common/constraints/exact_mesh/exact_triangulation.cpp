// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact_mesh/exact_triangulation.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <utility>

#include "common/driver/triangulation_data.hpp"
#include "common/output/renumber.hpp"

namespace cadt {

Triangulation triangulation_of(const Triangulation& delaunay, const constraints::ExactMesh& mesh,
                               std::span<const double> added_xy, std::vector<std::uint32_t>& edge_flags) {
  const std::size_t count = mesh.triangles.size() / 3;
  const auto corner = [&](std::size_t t, std::size_t k) { return mesh.triangles[3 * t + k % 3]; };
  // Where the smallest vertex of each triangle is, and the triangles in order.
  std::vector<std::uint8_t> first(count);
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t k = 1; k < 3; ++k)
      if (corner(t, k) < corner(t, first[t])) first[t] = static_cast<std::uint8_t>(k);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t t) {
    const std::size_t k = first[t];
    return std::array{corner(t, k), corner(t, k + 1), corner(t, k + 2)};
  });
  std::vector<std::int32_t> place(count);
  for (std::size_t i = 0; i < count; ++i) place[order[i]] = static_cast<std::int32_t>(i);

  auto data = std::make_unique<Triangulation::Data>();
  data->points = delaunay.number_of_points() + added_xy.size() / 2;
  data->triangle_count = count;
  data->constrained = true;
  data->triangles = make_words(3 * count);
  data->neighbors = make_words(3 * count);
  edge_flags.assign(count, 0);
  std::vector<std::array<std::uint32_t, 2>> boundary;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t t = order[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = (first[t] + k) % 3;
      const std::int32_t across = mesh.neighbors[3 * t + from];
      data->triangles[3 * i + k] = mesh.triangles[3 * t + from];
      data->neighbors[3 * i + k] = across < 0 ? -1 : place[static_cast<std::size_t>(across)];
      edge_flags[i] |= (mesh.edge_flags[t] >> from & 1U) << k;
      if (across < 0)
        boundary.push_back(
            {static_cast<std::uint32_t>(corner(t, from + 1)), static_cast<std::uint32_t>(corner(t, from + 2))});
    }
  }
  data->hull = chain_loop(std::move(boundary), data->points);
  data->duplicates.assign(delaunay.duplicates().begin(), delaunay.duplicates().end());
  data->dimension = delaunay.dimension();
  data->statistics = delaunay.statistics();
  if (const PointsView kept = delaunay.points(); kept.size() != 0) give_points(*data, kept, KeepPoints::copy, added_xy);
  return Triangulation(std::move(data));
}

}  // namespace cadt
