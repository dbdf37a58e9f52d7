// SPDX-License-Identifier: Apache-2.0
// Verification of domains, by searches from triangle to triangle.
#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "common/constraints/verify/verify_checks.hpp"

namespace cadt {
namespace {

constexpr std::int32_t not_reached = -1;

class RegionCheck {
 public:
  RegionCheck(const MeshPlaces& places, std::span<const Segment> segments, const ConstrainedTriangulation& mesh,
              const ConstraintOptions& constraints)
      : located_(places, segments, mesh),
        mesh_(mesh),
        constraints_(constraints),
        count_(mesh.mesh().number_of_triangles()) {}

  Check run() {
    const std::size_t regions = mesh_.number_of_regions();
    if (mesh_.region().size() != count_ || mesh_.inside().size() != count_) {
      fail(-1, "there are not as many regions of triangles as triangles");
    } else if (mesh_.region_attribute().size() != regions) {
      fail(-1, "there are not as many attributes as regions");
    } else if (check_regions()) {
      check_values();
      check_attributes();
    }
    check_.passed = check_.failures == 0;
    return check_;
  }

 private:
  void fail(std::int64_t first, const std::string& what) { add_failure(check_, first, what); }
  void fail_at(std::size_t t, const std::string& what) {
    fail(static_cast<std::int64_t>(t), "triangle " + std::to_string(t) + " " + what);
  }

  [[nodiscard]] std::int32_t across(std::size_t t, std::size_t k) const { return mesh_.mesh().neighbors()[3 * t + k]; }
  [[nodiscard]] bool constrained(std::size_t t, std::size_t k) const { return (mesh_.edge_flags()[t] >> k & 1U) != 0; }

  /// Triangles beside an edge of the hull that is not constrained: they meet outside.
  [[nodiscard]] std::vector<std::size_t> open_to_outside() const {
    std::vector<std::size_t> open;
    for (std::size_t t = 0; t < count_; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (across(t, k) < 0 && !constrained(t, k)) open.push_back(t);
    return open;
  }

  /// All triangles that can be reached from those in `found` without crossing a constrained edge get its value.
  void spread(std::vector<std::size_t>& found, std::vector<std::int32_t>& values) const {
    bool outside = false;
    while (!found.empty()) {
      const std::size_t t = found.back();
      found.pop_back();
      const auto reach = [&](std::size_t other) {
        if (values[other] != not_reached) return;
        values[other] = values[t];
        found.push_back(other);
      };
      for (std::size_t k = 0; k < 3; ++k) {
        if (constrained(t, k)) continue;
        if (const std::int32_t other = across(t, k); other >= 0)
          reach(static_cast<std::size_t>(other));
        else if (!std::exchange(outside, true))
          std::ranges::for_each(open_to_outside(), reach);
      }
    }
  }

  bool check_regions() {
    std::vector<std::int32_t> expected(count_, not_reached);
    std::vector<std::size_t> found;
    std::int32_t regions = 0;
    for (std::size_t t = 0; t < count_; ++t) {
      if (expected[t] != not_reached) continue;
      expected[t] = regions++;
      found.push_back(t);
      spread(found, expected);
    }
    for (std::size_t t = 0; t < count_; ++t)
      if (mesh_.region()[t] != expected[t])
        fail_at(t, "is in region " + std::to_string(mesh_.region()[t]) + ", not in " + std::to_string(expected[t]));
    if (mesh_.number_of_regions() != static_cast<std::size_t>(regions))
      fail(-1, "there are " + std::to_string(mesh_.number_of_regions()) + " regions, not " + std::to_string(regions));
    return check_.failures == 0;
  }

  /// How much a step across edge k into triangle t counts.
  [[nodiscard]] std::int32_t weight(std::size_t t, std::size_t k) const {
    if (!constrained(t, k)) return 0;
    if (constraints_.domain == Domain::layers) return 1;
    const auto triangles = mesh_.mesh().triangles();
    const std::int32_t from = triangles[3 * t + (k + 1) % 3], to = triangles[3 * t + (k + 2) % 3];
    const Segment edge = {std::min(from, to), std::max(from, to)};
    const auto edges = mesh_.constrained_edges();
    const auto e = static_cast<std::size_t>(std::ranges::lower_bound(edges, edge) - edges.begin());
    std::int32_t sum = 0;
    for (auto i = static_cast<std::size_t>(mesh_.source_offsets()[e]);
         i < static_cast<std::size_t>(mesh_.source_offsets()[e + 1]); ++i)
      sum += (mesh_.edge_sources()[i] >= 0) == (from < to) ? 1 : -1;
    if (constraints_.domain == Domain::nonzero) return sum;
    return static_cast<std::int32_t>((mesh_.source_offsets()[e + 1] - mesh_.source_offsets()[e]) & 1);
  }

  /// Values by steps from outside: fewest segments first for layers; else each step must lead to the same.
  [[nodiscard]] std::vector<std::int32_t> values_by_steps() {
    struct Step {
      std::size_t triangle;
      std::int32_t value;
    };
    const Domain domain = constraints_.domain;
    std::vector<std::int32_t> values(count_);
    std::vector<std::uint8_t> known(count_);
    std::deque<Step> steps;
    const auto go = [&](std::size_t t, std::size_t k, std::int32_t before) {
      const std::int32_t own = weight(t, k);
      const std::int32_t value = domain == Domain::even_odd ? (before + own) & 1 : before + own;
      if (domain == Domain::layers && own == 0)
        steps.push_front({t, value});
      else
        steps.push_back({t, value});
    };
    for (std::size_t t = 0; t < count_; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (across(t, k) < 0) go(t, k, 0);
    while (!steps.empty()) {
      const Step step = steps.front();
      steps.pop_front();
      const std::size_t t = step.triangle;
      if (known[t] != 0) {
        if (domain != Domain::layers && values[t] != step.value)
          fail_at(t, "has different values on different ways from outside: the segments do not close");
        continue;
      }
      known[t] = 1;
      values[t] = step.value;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t other = across(t, k);
        if (other < 0) continue;
        const auto u = static_cast<std::size_t>(other);
        std::size_t j = 0;
        while (across(u, j) != static_cast<std::int32_t>(t)) ++j;
        go(u, j, step.value);
      }
    }
    return values;
  }

  /// 1, but 0 for what is reached from outside, or from holes.
  [[nodiscard]] std::vector<std::int32_t> values_by_reach() const {
    std::vector<std::int32_t> values(count_, not_reached);
    std::vector<std::size_t> found;
    const auto add = [&](std::size_t t) {
      if (values[t] == not_reached) found.push_back(t);
      values[t] = 0;
    };
    if (constraints_.domain != Domain::hull) std::ranges::for_each(open_to_outside(), add);
    if (constraints_.domain == Domain::seeds)
      for (const std::int32_t t : located_.of(constraints_.holes))
        if (t >= 0) add(static_cast<std::size_t>(t));
    spread(found, values);
    std::ranges::replace(values, not_reached, 1);
    return values;
  }

  void check_values() {
    const Domain domain = constraints_.domain;
    const bool by_steps = domain == Domain::even_odd || domain == Domain::nonzero || domain == Domain::layers;
    const std::vector<std::int32_t> values = by_steps ? values_by_steps() : values_by_reach();
    std::size_t inside = 0;
    for (std::size_t t = 0; t < count_; ++t) {
      const std::int32_t value = mesh_.region_value()[static_cast<std::size_t>(mesh_.region()[t])];
      if (value != values[t])
        fail_at(t, "is in a region of value " + std::to_string(value) + ", not " + std::to_string(values[t]));
      const bool expected = domain == Domain::layers ? (values[t] & 1) != 0 : values[t] != 0;
      if ((mesh_.inside()[t] != 0) != expected) fail_at(t, expected ? "is not inside" : "is inside");
      inside += expected ? 1 : 0;
    }
    if (mesh_.number_inside() != inside)
      fail(-1,
           "there are " + std::to_string(inside) + " triangles inside, not " + std::to_string(mesh_.number_inside()));
  }

  void check_attributes() {
    std::vector<MeshPlaces::Place> wanted;
    if (constraints_.domain == Domain::seeds)
      for (const Region& region : constraints_.regions) wanted.push_back({region.x, region.y});
    const std::vector<std::int32_t> found = located_.of(wanted);
    std::vector<double> attributes(mesh_.number_of_regions());
    for (std::size_t i = found.size(); i-- > 0;)  // the first that lies in a region has the last word
      if (found[i] >= 0)
        attributes[static_cast<std::size_t>(mesh_.region()[static_cast<std::size_t>(found[i])])] =
            constraints_.regions[i].attribute;
    for (std::size_t r = 0; r < attributes.size(); ++r)
      if (const double found_there = mesh_.region_attribute()[r];
          found_there != attributes[r] && !(std::isnan(found_there) && std::isnan(attributes[r])))
        fail(-1, "region " + std::to_string(r) + " has another attribute than its seed");
  }

  const SeedTriangles located_;
  const ConstrainedTriangulation& mesh_;
  const ConstraintOptions& constraints_;
  const std::size_t count_;
  Check check_{"regions", false, 0, -1, {}};
};

}  // namespace

Check check_regions(const MeshPlaces& places, std::span<const Segment> segments, const ConstrainedTriangulation& mesh,
                    const ConstraintOptions& constraints) {
  return RegionCheck(places, segments, mesh, constraints).run();
}

}  // namespace cadt
