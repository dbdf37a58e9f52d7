// SPDX-License-Identifier: Apache-2.0
// Neighbours: the caller's are checked; missing ones are derived by grouping edges by their lower end.
#include "mesh.hpp"

#include <algorithm>
#include <atomic>

namespace cadt::verifier {

void check_neighbors(const Mesh& mesh, Check& check, std::uint64_t& examined) {
  const Findings findings = reduce_each<Findings>(mesh.count, mesh.threads, [&](std::size_t t, Findings& mine) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++mine.examined;
      const std::int32_t s = mesh.neighbors[3 * t + k];
      if (s < 0) continue;
      const auto other = static_cast<std::size_t>(s);
      // The three vertices of a triangle differ, so at most one of its edges is this one reversed.
      bool mutual = false;
      for (std::size_t j = 0; j < 3 && other != t; ++j)
        mutual = mutual || (mesh.vertex(other, next3(j)) == mesh.vertex(t, previous3(k)) &&
                            mesh.vertex(other, previous3(j)) == mesh.vertex(t, next3(k)) &&
                            mesh.neighbors[3 * other + j] == static_cast<std::int32_t>(t) &&
                            mesh.constrained(other, j) == mesh.constrained(t, k));
      if (!mutual) mine.fail(3 * t + k);
    }
  });
  examined = findings.examined;
  conclude_neighbors(mesh, findings, check);
}

void conclude_neighbors(const Mesh& mesh, const Findings& findings, Check& check) {
  conclude(check, findings, [&] {
    return mesh.describe_edge(findings.first) + ", is not shared with triangle " +
           std::to_string(mesh.neighbors[static_cast<std::size_t>(findings.first)]) + " in the opposite direction";
  });
}

namespace {

/// A half-edge grouped by its lower end. `half` is 3 * triangle + k (below 2^32: see `verify`).
struct Half {
  std::int32_t upper;
  std::uint32_t half;
  bool rising;  // runs from the lower to the upper index
};

}  // namespace

void derive_neighbors(Mesh& mesh, Check& check, std::uint64_t& examined) {
  mesh.derived.assign(3 * mesh.count, -1);
  const auto lower_end = [&](std::size_t t, std::size_t k) {
    return static_cast<std::size_t>(std::min(mesh.vertex(t, next3(k)), mesh.vertex(t, previous3(k))));
  };
  // Counting sort by the lower end; each group is sorted afterwards.
  std::vector<std::size_t> place(mesh.points.size() + 1, 0);
  for (std::size_t t = 0; t < mesh.count; ++t)
    for (std::size_t k = 0; k < 3; ++k) ++place[lower_end(t, k) + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  std::vector<Half> halves(3 * mesh.count);
  {
    std::vector<std::size_t> next(place.begin(), place.end() - 1);
    for (std::size_t t = 0; t < mesh.count; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t from = mesh.vertex(t, next3(k)), to = mesh.vertex(t, previous3(k));
        halves[next[lower_end(t, k)]++] = {std::max(from, to), static_cast<std::uint32_t>(3 * t + k), from < to};
      }
  }
  const Findings findings = reduce_each<Findings>(mesh.points.size(), mesh.threads, [&](std::size_t v, Findings& mine) {
    const auto group_end = halves.begin() + static_cast<std::ptrdiff_t>(place[v + 1]);
    auto at = halves.begin() + static_cast<std::ptrdiff_t>(place[v]);
    std::sort(at, group_end,
              [](const Half& a, const Half& b) { return a.upper != b.upper ? a.upper < b.upper : a.half < b.half; });
    while (at != group_end) {
      const auto same = std::find_if(at, group_end, [&](const Half& h) { return h.upper != at->upper; });
      const auto users = same - at;
      mine.examined += static_cast<std::uint64_t>(users);
      if (users == 2 && at[0].rising != at[1].rising) {
        mesh.derived[at[0].half] = static_cast<std::int32_t>(at[1].half / 3);
        mesh.derived[at[1].half] = static_cast<std::int32_t>(at[0].half / 3);
      } else if (users != 1) {
        mine.fail(at[0].half);
      }
      at = same;
    }
  });
  examined = findings.examined;
  mesh.neighbors = mesh.derived;
  conclude(check, findings, [&] {
    return mesh.describe_edge(findings.first) + ", is used by more than two triangles or by two in the same direction";
  });
}

}  // namespace cadt::verifier
