// SPDX-License-Identifier: Apache-2.0
// Verification of meshes on a grid: points are at the centres of their cells, and segments meet those of their chains.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/constraints/exact/exact_number.hpp"
#include "common/constraints/verify/verify_checks.hpp"

namespace cadt {
namespace {

using exact::Number;
using Place = MeshPlaces::Place;

/// The number of the cell with its centre there, in each direction; NaN where there is no centre. Centres are rounded
/// multiples of the width. Below 2^25 of them the quotient is off by less than 2^-26, and larger ones are exact, or
/// refused.
Place cell_of(const Place& centre, double width) {
  Place cell;
  for (std::size_t k = 0; k < 2; ++k) {
    cell[k] = std::nearbyint(centre[k] / width);
    if (!(std::abs(cell[k]) < 0x1p52) || cell[k] * width != centre[k])
      cell[k] = std::numeric_limits<double>::quiet_NaN();
  }
  return cell;
}

/// Where a segment is in a cell: lower and upper bounds of its parameter t, as fractions, each inclusive or not.
class Parameters {
 public:
  explicit Parameters(double width) : width_(of_.number(width)) {
    bound(lower_, of_.number(0), of_.number(1), true);
    bound(upper_, of_.number(1), of_.number(1), true);
  }
  /// From the lower side of a cell, inclusive, to its upper side.
  void restrict(double from, double to, double cell) {
    const Number a = of_.number(from), d = of_.subtract(of_.number(to), a), half = of_.number(0.5);
    const Number middle = of_.subtract(of_.multiply(of_.number(cell), width_), a), side = of_.multiply(half, width_);
    const Number low = of_.subtract(middle, side), high = of_.add(middle, side);  // of t d
    if (d.sign() > 0) {
      bound(lower_, low, d, true);
      bound(upper_, high, d, false);
    } else if (d.sign() < 0) {
      bound(upper_, -low, -d, true);
      bound(lower_, -high, -d, false);
    } else if (low.sign() > 0 || high.sign() <= 0) {
      none_ = true;
    }
  }
  [[nodiscard]] bool is_empty() const {
    for (const Bound& low : lower_)
      for (const Bound& high : upper_) {
        const int order =
            exact::compare(of_.multiply(low.dividend, high.divisor), of_.multiply(high.dividend, low.divisor));
        if (order > 0 || (order == 0 && !(low.inclusive && high.inclusive))) return true;
      }
    return none_;
  }

 private:
  struct Bound {
    Number dividend, divisor;
    bool inclusive;
  };
  static void bound(std::vector<Bound>& of, const Number& dividend, const Number& divisor, bool inclusive) {
    of.push_back({dividend, divisor, inclusive});
  }

  exact::Arena arena_;
  exact::Arithmetic of_{arena_};
  Number width_;
  std::vector<Bound> lower_, upper_;
  bool none_ = false;
};

class GridCheck {
 public:
  GridCheck(PointsView points, const MeshPlaces& places, double width, Check& check)
      : points_(points), places_(places), width_(width), check_(check) {}

  void check_points() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place centre = places_.at(static_cast<std::int32_t>(i)), cell = cell_of(centre, width_);
      if (std::isnan(cell[0]) || std::isnan(cell[1])) {
        fail(i, "point " + std::to_string(i) + " is not on the grid");
      } else if (i < points_.size() &&
                 (!is_in(points_.x(i), centre[0], cell[0]) || !is_in(points_.y(i), centre[1], cell[1]))) {
        fail(i, "point " + std::to_string(i) + " has not moved to the centre of its cell");
      }
    }
  }

  /// \pre its ends are those of the segment, all places are on the grid
  void check_chain(std::size_t s, const Segment& segment, std::span<const std::int32_t> chain) {
    const Place a = given(segment[0]), b = given(segment[1]);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Place from = cell_of(places_.at(chain[i - 1]), width_), to = cell_of(places_.at(chain[i]), width_);
      const std::string where = "the chain of segment " + std::to_string(s) + " at vertex " + std::to_string(chain[i]);
      if (from == to || !goes_on(from[0], to[0], a[0], b[0]) || !goes_on(from[1], to[1], a[1], b[1]))
        return fail(s, where + " has another direction");
      if (i + 1 == chain.size()) break;  // the cell of its end
      Parameters inside(width_);
      inside.restrict(a[0], b[0], to[0]);
      inside.restrict(a[1], b[1], to[1]);
      if (inside.is_empty()) return fail(s, where + " is in a cell that the segment does not meet");
    }
  }

  /// Of each added point: a pair of segments that cross and go through its cell. \pre chains are right
  void check_parents(std::span<const Segment> segments, const ConstrainedTriangulation& mesh) {
    const auto parents = mesh.added_parents();
    const std::size_t given = places_.given();
    if (parents.size() != places_.size() - given)
      return fail(0, "there are pairs of segments for " + std::to_string(parents.size()) + " added points, not for " +
                         std::to_string(places_.size() - given));
    std::vector<int> chains(parents.size());  // of its two segments that have the vertex
    const auto offsets = mesh.chain_offsets();
    for (std::size_t s = 0; s < segments.size(); ++s)
      for (std::int64_t i = offsets[s]; i < offsets[s + 1]; ++i) {
        const std::int32_t v = mesh.chain_vertices()[static_cast<std::size_t>(i)];
        if (!places_.is_added(v)) continue;
        const std::size_t added = static_cast<std::size_t>(v) - given;
        chains[added] += static_cast<int>(std::ranges::count(parents[added], static_cast<std::int32_t>(s)));
      }
    for (std::size_t i = 0; i < parents.size(); ++i) {
      const auto [s, t] = parents[i];
      if (s >= t || chains[i] != 2 || (i != 0 && parents[i - 1] >= parents[i]) ||
          !cross(segments[static_cast<std::size_t>(s)], segments[static_cast<std::size_t>(t)]))
        return fail(given + i, "point " + std::to_string(given + i) + " is no crossing of its two segments");
    }
  }

 private:
  [[nodiscard]] bool cross(const Segment& s, const Segment& t) const {
    const Place a = given(s[0]), b = given(s[1]), c = given(t[0]), d = given(t[1]);
    return exact_orientation(a, b, c) * exact_orientation(a, b, d) < 0 &&
           exact_orientation(c, d, a) * exact_orientation(c, d, b) < 0;
  }
  void fail(std::size_t first, const std::string& what) { add_failure(check_, static_cast<std::int64_t>(first), what); }
  [[nodiscard]] Place given(std::int32_t i) const {
    return {points_.x(static_cast<std::size_t>(i)), points_.y(static_cast<std::size_t>(i))};
  }
  /// Whether a coordinate is in a cell: from its lower side, inclusive, to its upper one.
  [[nodiscard]] bool is_in(double v, double centre, double cell) const {
    const double off = std::abs(v - centre) + 0x1p-50 * (std::abs(v) + std::abs(centre));  // from its middle, at most
    if (width_ > 0x1p-1000 && off < 0.49 * width_) return true;
    Parameters inside(width_);
    inside.restrict(v, v, cell);
    return !inside.is_empty();
  }
  /// Cells follow each other in the direction of the segment.
  static bool goes_on(double from, double to, double a, double b) {
    if (a == b) return from == to;
    return a < b ? from <= to : from >= to;
  }

  PointsView points_;
  const MeshPlaces& places_;
  double width_;
  Check& check_;
};

}  // namespace

void check_grid(PointsView points, const MeshPlaces& places, std::span<const Segment> segments,
                const ConstrainedTriangulation& mesh, const ConstraintOptions& constraints, Check& check) {
  const bool on_grid = constraints.crossing == Crossing::grid;
  if (on_grid != places.moved()) {
    if (points.size() != 0)
      add_failure(check, -1,
                  on_grid ? "the rule is a grid, and no point has moved"
                          : "points have moved to a grid, and the rule of crossings is another");
    return;
  }
  if (!on_grid) return;
  if (!(constraints.grid > 0) || !std::isfinite(constraints.grid))
    return add_failure(check, -1, "the grid has no width above 0");
  GridCheck grid(points, places, constraints.grid, check);
  grid.check_points();
  if (check.failures != 0) return;
  const auto offsets = mesh.chain_offsets();
  for (std::size_t s = 0; s < segments.size(); ++s)
    grid.check_chain(s, segments[s],
                     mesh.chain_vertices().subspan(static_cast<std::size_t>(offsets[s]),
                                                   static_cast<std::size_t>(offsets[s + 1] - offsets[s])));
  if (check.failures == 0) grid.check_parents(segments, mesh);
}

}  // namespace cadt
