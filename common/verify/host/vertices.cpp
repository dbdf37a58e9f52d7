// SPDX-License-Identifier: Apache-2.0
// Checks that every input point is a vertex or equals one, and, without triangles, that all points are collinear.
#include "mark.hpp"
#include "mesh.hpp"

#include <algorithm>
#include <numeric>

namespace cadt::verifier {
namespace {

/// The caller's list of duplicates. Each listed point must have `representative` as the lowest point that it equals;
/// `is_duplicate` says which points must be listed.
template <class IsDuplicate, class IsRepresentative>
void check_list(const Mesh& mesh, std::span<const Duplicate> list, std::size_t expected, Check& check,
                const IsDuplicate& is_duplicate, const IsRepresentative& is_representative) {
  const auto points = static_cast<std::int64_t>(mesh.points.size());
  const Findings findings = reduce_each<Findings>(list.size(), mesh.threads, [&](std::size_t i, Findings& mine) {
    const auto [p, r] = list[i];
    // As many strictly ascending duplicates as there are in all are all of them.
    const bool good = p >= 0 && p < points && r >= 0 && r < p && (i == 0 || list[i - 1].point < p) &&
                      is_duplicate(static_cast<std::size_t>(p)) && equal(mesh.point(p), mesh.point(r)) &&
                      is_representative(static_cast<std::size_t>(p), static_cast<std::size_t>(r));
    if (!good) mine.fail(i);
  });
  conclude_duplicates(list, expected, findings, check);
}

bool less(const Mesh& mesh, std::int32_t a, std::int32_t b) { return lexicographic_less(mesh.point(a), mesh.point(b)); }

}  // namespace

void conclude_duplicates(std::span<const Duplicate> list, std::size_t expected, const Findings& findings,
                         Check& check) {
  if (findings.failures != 0) {
    const Duplicate& d = list[static_cast<std::size_t>(findings.first)];
    return conclude(check, findings, [&] {
      return "entry " + std::to_string(findings.first) + " of the duplicates (point " + std::to_string(d.point) +
             ", representative " + std::to_string(d.representative) + ") is wrong or out of order";
    });
  }
  if (list.size() != expected)
    return fail(check, -1,
                std::to_string(list.size()) + " duplicates are listed, there are " + std::to_string(expected));
  check.passed = true;
}

void check_vertices(const Mesh& mesh, const MeshView& view, Check& check) {
  const std::size_t unused_count = mesh.points.size() - mesh.vertices;
  // In a mesh that passes all other checks no two vertices coincide, so a representative that is a vertex and lower
  // than each of its duplicates is the lowest of them all.
  if (view.has_duplicates)
    return check_list(
        mesh, view.duplicates, unused_count, check, [&](std::size_t p) { return mesh.used[p] == 0; },
        [&](std::size_t, std::size_t r) { return mesh.used[r] != 0; });
  std::vector<std::int32_t> unused;
  unused.reserve(unused_count);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (mesh.used[i] == 0) unused.push_back(static_cast<std::int32_t>(i));
  std::sort(unused.begin(), unused.end(),
            [&](std::int32_t a, std::int32_t b) { return less(mesh, a, b) || (!less(mesh, b, a) && a < b); });
  // Each vertex marks the first of the unused points that equal it.
  std::vector<std::uint8_t> met(unused.size(), 0);
  if (!unused.empty())
    reduce_each<Findings>(mesh.points.size(), mesh.threads, [&](std::size_t i, Findings&) {
      if (mesh.used[i] == 0) return;
      const auto p = static_cast<std::int32_t>(i);
      const auto it = std::lower_bound(unused.begin(), unused.end(), p,
                                       [&](std::int32_t a, std::int32_t b) { return less(mesh, a, b); });
      if (it == unused.end() || !equal(mesh.point(*it), mesh.point(p))) return;
      mark(met[static_cast<std::size_t>(it - unused.begin())]);
    });
  Findings findings;
  for (std::size_t i = 0; i < unused.size(); ++i) {
    if (i > 0 && equal(mesh.point(unused[i]), mesh.point(unused[i - 1]))) met[i] = met[i - 1];
    if (met[i] == 0) findings.fail(static_cast<std::size_t>(unused[i]));
  }
  conclude(check, findings,
           [&] { return "point " + std::to_string(findings.first) + " is not a vertex and equals none"; });
}

void check_collinear(const Mesh& mesh, const MeshView& view, Check& check) {
  const std::size_t n = mesh.points.size();
  std::vector<std::int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  if (n > 0) {
    // A point off the line through the two extreme points makes a triangle. If these coincide, so do all points.
    const auto by_position = [&](std::int32_t a, std::int32_t b) { return less(mesh, a, b); };
    const std::int32_t low = *std::min_element(order.begin(), order.end(), by_position);
    const std::int32_t high = *std::max_element(order.begin(), order.end(), by_position);
    const Findings findings = reduce_each<Findings>(n, mesh.threads, [&](std::size_t i, Findings& mine) {
      if (orientation(mesh.point(low), mesh.point(high), mesh.point(static_cast<std::int32_t>(i))) != 0) mine.fail(i);
    });
    if (findings.failures != 0)
      return conclude(check, findings, [&] {
        return "there are no triangles, but points " + std::to_string(low) + ", " + std::to_string(high) + " and " +
               std::to_string(findings.first) + " are not collinear";
      });
  }
  if (!view.has_duplicates) {
    check.passed = true;
    return;
  }
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return less(mesh, a, b) || (!less(mesh, b, a) && a < b); });
  std::vector<std::int32_t> representative(n);
  std::size_t duplicates = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool repeated = i > 0 && equal(mesh.point(order[i]), mesh.point(order[i - 1]));
    representative[static_cast<std::size_t>(order[i])] =
        repeated ? representative[static_cast<std::size_t>(order[i - 1])] : order[i];
    duplicates += repeated ? 1 : 0;
  }
  check_list(
      mesh, view.duplicates, duplicates, check,
      [&](std::size_t p) { return representative[p] != static_cast<std::int32_t>(p); },
      [&](std::size_t p, std::size_t r) { return representative[p] == static_cast<std::int32_t>(r); });
}

}  // namespace cadt::verifier
