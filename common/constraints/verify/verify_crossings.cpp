// SPDX-License-Identifier: Apache-2.0
// Verification of vertices that crossings have made. Their exact places come from the ends of the segments, as
// fractions of whole numbers of any size; nothing is rounded here, and the predicates of the builder are not asked.
#include "common/constraints/verify/verify_crossings.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/constraints/exact/exact_number.hpp"

namespace cadt {
namespace {

using exact::Arena, exact::Arithmetic, exact::Number;
using Place = MeshPlaces::Place;

/// The point (at[0] / w, at[1] / w); w > 0.
struct Fractions {
  std::array<Number, 2> at;
  Number w;
};

Number magnitude(const Number& a) { return a.negative ? -a : a; }

/// Whether `value` is the double nearest to number / w, of two the even one. \pre w > 0
bool is_nearest(const Arithmetic& of, double value, const Number& number, const Number& w) {
  const Number rest = of.subtract(number, of.multiply(of.number(value), w));
  if (rest.sign() == 0) return true;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double beyond = std::nextafter(value, rest.negative ? -infinity : infinity);
  if (!std::isfinite(beyond)) return false;  // crossings lie between points
  const Number gap = of.multiply(of.subtract(of.number(beyond), of.number(value)), w);
  const int order = exact::compare(magnitude(of.add(rest, rest)), magnitude(gap));
  return order < 0 || (order == 0 && (std::bit_cast<std::uint64_t>(value) & 1) == 0);
}

class CrossingCheck {
 public:
  CrossingCheck(const MeshPlaces& places, std::span<const Segment> segments, const ConstrainedTriangulation& mesh,
                Check& check)
      : places_(places), segments_(segments), mesh_(mesh), parents_(mesh.added_parents()), check_(check) {}

  void run() {
    if (parents_.size() != places_.size() - places_.given())
      return fail(-1, "there are pairs of segments for " + std::to_string(parents_.size()) + " added points, not for " +
                          std::to_string(places_.size() - places_.given()));
    for (std::size_t i = 0; i < parents_.size(); ++i) check_place(i);
    if (check_.failures != 0) return;
    std::vector<int> chains(parents_.size());  // of its two segments that have the vertex
    for (std::size_t s = 0; s < segments_.size(); ++s) check_chain(s, chains);
    for (std::size_t i = 0; i < parents_.size(); ++i)
      if (chains[i] != 2) fail(number(i), name(i) + " is not on the chains of both of its segments");
  }

 private:
  void fail(std::int64_t first, const std::string& what) { add_failure(check_, first, what); }
  [[nodiscard]] std::int64_t number(std::size_t added) const {
    return static_cast<std::int64_t>(places_.given() + added);
  }
  [[nodiscard]] std::string name(std::size_t added) const { return "added point " + std::to_string(number(added)); }
  [[nodiscard]] std::array<Place, 2> ends(std::size_t s) const {
    return {places_.at(segments_[s][0]), places_.at(segments_[s][1])};
  }

  /// The crossing of two segments that are not parallel: a + (b - a) along / w.
  [[nodiscard]] Fractions crossing(const Arithmetic& of, std::size_t s, std::size_t t) const {
    const auto [a, b] = ends(s);
    const auto [c, d] = ends(t);
    const auto difference = [&](double to, double from) { return of.subtract(of.number(to), of.number(from)); };
    const Number ux = difference(b[0], a[0]), uy = difference(b[1], a[1]);
    const Number vx = difference(d[0], c[0]), vy = difference(d[1], c[1]);
    Number w = of.minor(ux, vy, uy, vx);
    Number along = of.minor(difference(c[0], a[0]), vy, difference(c[1], a[1]), vx);
    if (w.negative) w = -w, along = -along;
    return {{of.add(of.multiply(of.number(a[0]), w), of.multiply(ux, along)),
             of.add(of.multiply(of.number(a[1]), w), of.multiply(uy, along))},
            w};
  }
  [[nodiscard]] Fractions exact_place(const Arithmetic& of, std::int32_t v) const {
    if (places_.is_added(v)) {
      const auto& pair = parents_[static_cast<std::size_t>(v) - places_.given()];
      return crossing(of, static_cast<std::size_t>(pair[0]), static_cast<std::size_t>(pair[1]));
    }
    const Place at = places_.at(v);
    return {{of.number(at[0]), of.number(at[1])}, of.number(1)};
  }

  void check_place(std::size_t i) {
    const auto [s, t] = parents_[i];
    if (s < 0 || s >= t || static_cast<std::size_t>(t) >= segments_.size())
      return fail(number(i), name(i) + " has no pair of segments");
    if (i != 0 && parents_[i - 1] >= parents_[i])
      return fail(number(i), name(i) + " is not in the order of the pairs of segments");
    const auto [a, b] = ends(static_cast<std::size_t>(s));
    const auto [c, d] = ends(static_cast<std::size_t>(t));
    const std::string pair = "segments " + std::to_string(s) + " and " + std::to_string(t);
    if (exact_orientation(a, b, c) * exact_orientation(a, b, d) >= 0 ||
        exact_orientation(c, d, a) * exact_orientation(c, d, b) >= 0)
      return fail(number(i), name(i) + " is one of " + pair + ", which do not cross");
    Arena arena;
    const Arithmetic of(arena);
    const Fractions exact = crossing(of, static_cast<std::size_t>(s), static_cast<std::size_t>(t));
    const Place at = places_.at(static_cast<std::int32_t>(number(i)));
    for (std::size_t axis = 0; axis < 2; ++axis)
      if (!is_nearest(of, at[axis], exact.at[axis], exact.w))
        return fail(number(i), name(i) + " is not where " + pair + " cross");
  }

  /// Whether an added point lies on a segment, in its exact place.
  [[nodiscard]] bool is_on(std::int32_t v, std::size_t s) const {
    const auto& pair = parents_[static_cast<std::size_t>(v) - places_.given()];
    if (std::cmp_equal(pair[0], s) || std::cmp_equal(pair[1], s)) return true;
    Arena arena;
    const Arithmetic of(arena);
    const Fractions p = exact_place(of, v);
    const auto ab = ends(s);
    const auto from_a = [&](std::size_t axis) {
      return of.subtract(p.at[axis], of.multiply(of.number(ab[0][axis]), p.w));
    };
    const auto along = [&](std::size_t axis) { return of.subtract(of.number(ab[1][axis]), of.number(ab[0][axis])); };
    return of.minor(along(0), from_a(1), along(1), from_a(0)).sign() == 0;
  }

  /// Whether v comes before w on the way along a segment, of which both are points.
  [[nodiscard]] bool is_before(std::int32_t v, std::int32_t w, std::size_t s) const {
    Arena arena;
    const Arithmetic of(arena);
    const Fractions p = exact_place(of, v), q = exact_place(of, w);
    const auto [a, b] = ends(s);
    const std::size_t axis = a[0] != b[0] ? 0 : 1;
    const int order = exact::compare(of.multiply(p.at[axis], q.w), of.multiply(q.at[axis], p.w));
    return a[axis] < b[axis] ? order < 0 : order > 0;
  }

  void check_chain(std::size_t s, std::vector<int>& chains) {
    const auto offsets = mesh_.chain_offsets();
    const auto chain = mesh_.chain_vertices().subspan(static_cast<std::size_t>(offsets[s]),
                                                      static_cast<std::size_t>(offsets[s + 1] - offsets[s]));
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const bool added = places_.is_added(chain[k]);
      if (added) {
        const std::size_t i = static_cast<std::size_t>(chain[k]) - places_.given();
        if (!is_on(chain[k], s))
          return fail(number(i), name(i) + " is on the chain of a segment that it does not lie on");
        for (const std::int32_t parent : parents_[i])
          if (std::cmp_equal(parent, s)) ++chains[i];
      }
      if (k != 0 && (added || places_.is_added(chain[k - 1])) && !is_before(chain[k - 1], chain[k], s))
        return fail(chain[k],
                    "the chain of segment " + std::to_string(s) + " turns back at vertex " + std::to_string(chain[k]));
    }
  }

  const MeshPlaces& places_;
  const std::span<const Segment> segments_;
  const ConstrainedTriangulation& mesh_;
  const std::span<const std::array<std::int32_t, 2>> parents_;
  Check& check_;
};

}  // namespace

void check_crossings(const MeshPlaces& places, std::span<const Segment> segments, const ConstrainedTriangulation& mesh,
                     Check& check) {
  CrossingCheck(places, segments, mesh, check).run();
  check.passed = check.failures == 0;
}

}  // namespace cadt
