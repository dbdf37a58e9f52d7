// SPDX-License-Identifier: Apache-2.0
// Checks that the boundary is the convex hull, with the points on its edges in order, and is wound exactly once.
#include "mesh.hpp"

#include <algorithm>

namespace cadt::verifier {
namespace {

/// Direction of an edge by comparisons only: differences of doubles may round or overflow, comparisons do not.
struct Direction {
  int x, y;
};

Direction direction(const Point& a, const Point& b) { return {(b.x > a.x) - (b.x < a.x), (b.y > a.y) - (b.y < a.y)}; }

bool upper_half(const Direction& d) { return d.y > 0 || (d.y == 0 && d.x > 0); }

}  // namespace

void check_hull(const Mesh& mesh, std::span<const std::int32_t> given, Check& check) {
  std::vector<Point> corners;
  corners.reserve(mesh.loop.size());
  for (const std::int32_t v : mesh.loop) corners.push_back(mesh.point(v));
  check_hull(mesh.loop, corners, given, mesh.threads, check);
}

void check_hull(std::span<const std::int32_t> loop, std::span<const Point> corners, std::span<const std::int32_t> given,
                unsigned threads, Check& check) {
  const std::size_t h = loop.size();
  struct Turns : Findings {
    std::uint64_t half_turns = 0;
    void merge(const Turns& other) {
      Findings::merge(other);
      half_turns += other.half_turns;
    }
  };
  const Turns turns = reduce_each<Turns>(h, threads, [&](std::size_t i, Turns& mine) {
    const Point &a = corners[i == 0 ? h - 1 : i - 1], &b = corners[i], &c = corners[i + 1 == h ? 0 : i + 1];
    const Direction in = direction(a, b), out = direction(b, c);
    const int turn = orientation(a, b, c);
    // Collinear points must continue in the same direction; for parallel edges the signs decide.
    const bool good = turn > 0 || (turn == 0 && in.x == out.x && in.y == out.y && (in.x != 0 || in.y != 0));
    if (!good) mine.fail(static_cast<std::size_t>(loop[i]));
    if (upper_half(in) != upper_half(out)) ++mine.half_turns;
  });
  if (turns.failures != 0)
    return conclude(check, turns,
                    [&] { return "the boundary turns right or back at point " + std::to_string(turns.first); });
  // A closed chain of left turns changes between the upper and the lower half plane twice per winding.
  if (turns.half_turns != 2)
    return fail(check, -1, "the boundary winds " + std::to_string(turns.half_turns / 2) + " times around");
  if (!given.empty() && !std::ranges::equal(given, loop)) {
    const auto where = std::ranges::mismatch(given, loop).in1 - given.begin();
    return fail(check, where,
                "entry " + std::to_string(where) + " of the hull differs from the boundary, which has " +
                    std::to_string(h) + " points and starts at its smallest index");
  }
  check.passed = true;
}

}  // namespace cadt::verifier
