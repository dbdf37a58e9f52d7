// SPDX-License-Identifier: Apache-2.0
// Heights and other values where segments cross.
#include <cadt/constrained.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace cadt {
namespace {

using Place = std::array<double, 2>;

/// How far p is along the segment from a to b: 0 at a, 1 at b.
double part_along(Place a, Place b, Place p) {
  // Powers of two change no digit: half of what is very large, so that differences do not overflow, and the longer side
  // of the box between 1/2 and 1, so that squares do not either, nor vanish.
  const double most = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(b[0]), std::abs(b[1])});
  const double scale = most > 0x1p1000 ? 0.5 : 1;
  double ux = b[0] * scale - a[0] * scale, uy = b[1] * scale - a[1] * scale;
  double vx = p[0] * scale - a[0] * scale, vy = p[1] * scale - a[1] * scale;
  int exponent = 0;
  std::frexp(std::max(std::abs(ux), std::abs(uy)), &exponent);
  for (double* side : {&ux, &uy, &vx, &vy}) *side = std::ldexp(*side, -exponent);
  const double square = ux * ux + uy * uy;
  return std::clamp((vx * ux + vy * uy) / (square > 0 ? square : 1), 0.0, 1.0);
}

}  // namespace

std::vector<double> values_at_crossings(PointsView points, std::span<const double> values, std::size_t columns,
                                        const ConstrainedTriangulation& mesh) {
  const auto added = mesh.added_points(), moved = mesh.moved_points();
  const std::size_t n = points.size(), count = added.size() / 2;
  if (mesh.mesh().number_of_points() != n + count)
    throw InputError("the mesh has " + std::to_string(mesh.mesh().number_of_points() - count) +
                         " input points, and there are " + std::to_string(n),
                     n);
  if (n == 0 ? !values.empty() : values.size() % n != 0 || values.size() / n != columns)
    throw InputError("there are " + std::to_string(values.size()) + " values, and not " + std::to_string(columns) +
                         " for each of " + std::to_string(n) + " points",
                     n);
  std::vector<double> result(values.begin(), values.end());
  if (count == 0) return result;
  result.resize((n + count) * columns, std::numeric_limits<double>::quiet_NaN());
  const auto place = [&](std::size_t v) -> Place {
    if (v >= n) return {added[2 * (v - n)], added[2 * (v - n) + 1]};
    if (!moved.empty()) return {moved[2 * v], moved[2 * v + 1]};
    return {points.x(v), points.y(v)};
  };
  const auto offsets = mesh.chain_offsets();
  const auto chains = mesh.chain_vertices();
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    // Chains begin and end with input points; `before` is the place of the last one in the chain.
    auto before = static_cast<std::size_t>(offsets[s]);
    for (std::size_t behind = before; behind < static_cast<std::size_t>(offsets[s + 1]); ++behind) {
      if (static_cast<std::size_t>(chains[behind]) >= n) continue;
      const auto from = static_cast<std::size_t>(chains[before]), to = static_cast<std::size_t>(chains[behind]);
      for (std::size_t i = before + 1; i < behind; ++i) {
        const auto v = static_cast<std::size_t>(chains[i]);
        if (mesh.added_parents()[v - n][0] != static_cast<std::int32_t>(s)) continue;
        const double part = part_along(place(from), place(to), place(v));
        for (std::size_t j = 0; j < columns; ++j) {
          const double a = values[from * columns + j], b = values[to * columns + j];
          result[v * columns + j] = a == b ? a : (1 - part) * a + part * b;  // rounding leaves what is level so
        }
      }
      before = behind;
    }
  }
  return result;
}

}  // namespace cadt
