// SPDX-License-Identifier: Apache-2.0
#include "tiles/verify_parts.hpp"

#include <algorithm>

namespace cadt::tiles::verification {

HullOutcome check_hull(std::vector<BoundaryEdge> edges) {
  if (edges.empty()) return {};
  std::sort(edges.begin(), edges.end(), [](const BoundaryEdge& a, const BoundaryEdge& b) { return a.from < b.from; });
  std::vector<Place> loop;
  const BoundaryEdge* at = &edges.front();
  do {
    loop.push_back(at->at);
    const auto next = std::lower_bound(edges.begin(), edges.end(), at->to,
                                       [](const BoundaryEdge& e, std::uint64_t from) { return e.from < from; });
    if (next == edges.end() || next->from != at->to || loop.size() > edges.size())
      return {"it has an edge to point " + std::to_string(at->to) + " and none from there", "not examined"};
    at = &*next;
  } while (at != &edges.front());
  if (loop.size() != edges.size())
    return {std::to_string(edges.size() - loop.size()) + " of its edges are not in the loop of the first",
            "not examined"};
  // Left turns alone, and one lexicographic minimum: once around.
  std::size_t minima = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Place &a = loop[i], &b = loop[(i + 1) % loop.size()], &c = loop[(i + 2) % loop.size()];
    if (exact_orientation(a, b, c) < 0) return {{}, "it turns to the right"};
    if (b < a && b < c) ++minima;
  }
  if (minima != 1) return {{}, "it goes around " + std::to_string(minima) + " times"};
  return {};
}

}  // namespace cadt::tiles::verification
