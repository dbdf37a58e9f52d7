// SPDX-License-Identifier: Apache-2.0
#include "common/host/wrap_mesh.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/host/device_constants.hpp"

namespace cadt {
namespace {

using namespace device_constants;

constexpr std::size_t word = sizeof(std::uint32_t);

/// The triangles of three vertices without stars, each as its three half-edges. `edge_count` half-edges between two of
/// them are known from the other side. Empty if they are not `wanted` triangles with nothing but known edges.
std::vector<cadt_wrap_edge> triangles_between_hubs(Run& run, const Allocation& edges, std::size_t edge_count,
                                                   std::size_t wanted) {
  std::vector<cadt_wrap_edge> known(edge_count);
  if (edge_count + 3 * wanted > CADT_WRAP_EDGES || edge_count == 0) return {};
  run.device.read(*edges, 0, known.data(), edge_count * sizeof known[0]);
  std::set<std::pair<std::uint32_t, std::uint32_t>> open;  // half-edges that the triangles must have
  for (const cadt_wrap_edge& e : known) open.emplace(e.to, e.from);
  for (const cadt_wrap_edge& e : known) open.erase({e.from, e.to});
  std::vector<cadt_wrap_edge> found;
  while (!open.empty()) {
    const auto [a, b] = *open.begin();
    std::uint32_t c = CADT_NONE;
    bool closed = false;
    for (auto next = open.lower_bound({b, 0}); !closed && next != open.end() && next->first == b; ++next) {
      c = next->second;
      closed = open.contains({c, a});
    }
    if (!closed) return {};
    for (const cadt_wrap_edge& e : {cadt_wrap_edge{a, b, c}, {b, c, a}, {c, a, b}}) {
      found.push_back(e);
      open.erase({e.from, e.to});
    }
  }
  return found.size() == 3 * wanted ? found : std::vector<cadt_wrap_edge>{};
}

}  // namespace

std::size_t most_wrapped(const Device& device) noexcept { return device.shape().contiguous ? 2048 : 32768; }

std::optional<DeviceMesh> wrap_mesh(Run& run, const Allocation& points, std::size_t n) {
  if (n < 3) return std::nullopt;
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const std::size_t records = 2 * n - 2, link_words = 3 * records;  // ghosts have no star
  const auto box_count = (count - 1) / CADT_WRAP_BOX + 1, crate_count = (box_count - 1) / CADT_WRAP_CRATE + 1;
  const Allocation boxes = run.memory.allocate(box_count * sizeof(cadt_box));
  const Allocation crates = run.memory.allocate(crate_count * sizeof(cadt_box));
  const Allocation links = run.memory.allocate(link_words * word), begins = run.memory.allocate(n * word);
  const Allocation sizes = run.memory.allocate_zeros(n * word), found = launch.zeros(7);
  const Cut of_crates = launch.cut_teams(crate_count, wrap_lanes), teams = launch.cut_teams(n, wrap_lanes),
            all = launch.cut(n);
  const Allocation all_points;  // no sets, no list
  launch.run_in_groups(KernelId::cadt_wrap_boxes, of_crates.items, wrap_lanes, points, count, all_points, 0U,
                       crate_count, of_crates.grain, boxes, crates);
  launch.run_in_groups(KernelId::cadt_wrap_stars, teams.items, wrap_lanes, points, boxes, crates, count, all_points,
                       count, all_points, 0U, all_points, all_points, wrap_effort, teams.grain, 0U, links,
                       static_cast<std::uint32_t>(link_words), begins, sizes, found);
  // Vertices without a star have size 0, so this may run before it is known whether there are too many.
  const Allocation bases = run.memory.allocate((n + 1) * word);
  const Allocation edges = run.memory.allocate(CADT_WRAP_EDGES * sizeof(cadt_wrap_edge));
  launch.run(KernelId::cadt_wrap_counts, all.items, links, begins, sizes, count, all.grain, found, bases, edges);
  launch.scan(bases, n + 1);
  std::array<std::uint32_t, 7> words{};
  run.device.read(*found, 0, words.data(), sizeof words);
  run.statistics.exact_orientations += words[3];
  run.statistics.exact_incircles += words[4];
  run.statistics.ties += words[5];
  const std::uint32_t hubs = words[1], triangles = launch.read_word(bases, n);
  if (hubs > CADT_WRAP_HUBS || words[6] > CADT_WRAP_EDGES) return std::nullopt;
  const std::uint32_t first_extra = words[6];
  std::uint32_t edge_count = first_extra;
  if (hubs != 0 && triangles < records) {
    const std::vector<cadt_wrap_edge> extra =
        triangles_between_hubs(run, edges, edge_count, records - std::size_t{triangles});
    if (extra.empty()) return std::nullopt;
    run.device.write(*edges, edge_count * sizeof extra[0], extra.data(), extra.size() * sizeof extra[0]);
    edge_count += static_cast<std::uint32_t>(extra.size());
  } else if (triangles != records || words[0] > link_words) {
    throw InternalError("the wrapped stars have " + std::to_string(triangles) + " triangles instead of " +
                        std::to_string(records) + "; please report this with the input");
  }
  run.statistics.wrapped_stars = n - hubs;
  DeviceMesh mesh;
  mesh.slots = 2 * n;
  mesh.records = run.memory.allocate(mesh.slots * sizeof(cadt_record));
  run.device.fill(*mesh.records, records * sizeof(cadt_record), (mesh.slots - records) * sizeof(cadt_record), 0);
  const Cut shares = launch.cut(n * CADT_WRAP_SHARES);
  launch.run(KernelId::cadt_wrap_records, shares.items, links, begins, sizes, bases, edges, edge_count, first_extra,
             triangles, hubs, count, shares.grain, mesh.records);
  run.end_phase("wrap");
  return mesh;
}

}  // namespace cadt
