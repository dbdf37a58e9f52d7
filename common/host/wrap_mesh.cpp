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
constexpr std::size_t most_teams = 4096;  // as many as run at the same time on a large card
constexpr std::uint32_t box_lanes = CADT_WRAP_CRATE * CADT_WRAP_PARTS;
constexpr std::uint32_t rest_lanes = 64;  // of the longest stars, which all wait for

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

/// Boxes and crates of points (common/device/wrap_boxes.h); each set begins a box and a crate of its own.
struct Boxes {
  Allocation boxes, crates;

  /// `sizes` and `found` are set to 0 besides, if they are given.
  Boxes(Run& run, const Allocation& points, std::size_t n, const Allocation& starts, std::size_t sets,
        const Allocation& sizes, const Allocation& found) {
    const std::size_t crate_count = (n - 1) / (std::size_t{CADT_WRAP_BOX} * CADT_WRAP_CRATE) + 1 + sets;
    boxes = run.memory.allocate((n / CADT_WRAP_BOX + sets + 1) * sizeof(cadt_box));
    crates = run.memory.allocate(crate_count * sizeof(cadt_box));
    const Cut c = run.launcher.cut_teams(crate_count, box_lanes);
    run.launcher.run_in_groups(KernelId::cadt_wrap_boxes, c.items, box_lanes, points, static_cast<std::uint32_t>(n),
                               starts, static_cast<std::uint32_t>(sets), static_cast<std::uint32_t>(crate_count),
                               c.grain, boxes, crates, sizes, found);
  }
};

/// All stars of one set of at most 2^15 points; `sizes` and `found` need not be 0 before.
void wrap_all(Run& run, const Allocation& points, std::size_t n, const WrappedStars& stars) {
  Launcher& launch = run.launcher;
  const Allocation none, todo = run.memory.allocate(n * word),
                         arcs = run.memory.allocate(n * CADT_WRAP_ROW * sizeof(std::uint16_t));
  const Boxes boxes(run, points, n, none, 0, stars.sizes, stars.found);
  const auto count = static_cast<std::uint32_t>(n), link_words = static_cast<std::uint32_t>(stars.link_words);
  const Cut teams = launch.cut_teams(n, wrap_lanes);
  launch.run_in_groups(KernelId::cadt_wrap_near, teams.items, wrap_lanes, points, boxes.boxes, boxes.crates, count,
                       teams.grain, stars.links, link_words, stars.begins, stars.sizes, todo, arcs, stars.found);
  // How many are left is known on the device only.
  const Cut rest = run.device.shape().contiguous ? teams : launch.cut_teams(std::min(n, most_teams), rest_lanes);
  launch.run_in_groups(KernelId::cadt_wrap_stars, rest.items, rest_lanes, points, boxes.boxes, boxes.crates, count,
                       todo, 0U, arcs, none, 0U, none, none, wrap_effort, rest.grain, 0U, stars.links, link_words,
                       stars.begins, stars.sizes, stars.found);
}

}  // namespace

std::size_t most_wrapped(const Device& device) noexcept { return device.shape().contiguous ? 2048 : 32768; }

void wrap_sets(Run& run, const Allocation& points, std::size_t n, const StarsOfSets& sets, const WrappedStars& stars) {
  const Boxes boxes(run, points, n, sets.starts, sets.count, {}, {});
  const Allocation efforts = run.launcher.zeros(sets.count), none;
  const auto listed = static_cast<std::uint32_t>(sets.list_size);
  const Cut teams = run.launcher.cut_teams(listed, wrap_lanes);
  run.launcher.run_in_groups(KernelId::cadt_wrap_stars, teams.items, wrap_lanes, points, boxes.boxes, boxes.crates,
                             static_cast<std::uint32_t>(n), sets.list, listed, none, sets.starts,
                             static_cast<std::uint32_t>(sets.count), sets.states, efforts, wrap_effort, teams.grain,
                             static_cast<std::uint32_t>(stars.row), stars.links,
                             static_cast<std::uint32_t>(stars.link_words), stars.begins, stars.sizes, stars.found);
}

std::optional<DeviceMesh> wrap_mesh(Run& run, const Allocation& points, std::size_t n) {
  if (n < 3) return std::nullopt;
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const std::size_t records = 2 * n - 2, link_words = 3 * records;  // ghosts have no star
  const Allocation links = run.memory.allocate(link_words * word), begins = run.memory.allocate(n * word);
  const Allocation sizes = run.memory.allocate(n * word), found = run.memory.allocate(CADT_WRAP_WORDS * word);
  const Cut all = launch.cut(n);
  wrap_all(run, points, n, {links, begins, sizes, found, 0, link_words});
  // Vertices without a star have size 0, so this may run before it is known whether there are too many.
  const Allocation bases = run.memory.allocate((n + 1 + CADT_WRAP_FOUND) * word);
  const Allocation edges = run.memory.allocate(CADT_WRAP_EDGES * sizeof(cadt_wrap_edge));
  launch.run(KernelId::cadt_wrap_counts, all.items, links, begins, sizes, count, all.grain, found, bases, edges);
  launch.scan(bases, n + 1);
  std::array<std::uint32_t, 1 + CADT_WRAP_FOUND> words{};  // the number of triangles, and what was found
  run.device.read(*bases, n * word, words.data(), sizeof words);
  run.statistics.exact_orientations += words[4];
  run.statistics.exact_incircles += words[5];
  run.statistics.ties += words[6];
  const std::uint32_t triangles = words[0], hubs = words[2];
  std::uint32_t edge_count = hubs != 0 ? launch.read_word(found, CADT_WRAP_FOUND) : 0;
  if (hubs > CADT_WRAP_HUBS || edge_count > CADT_WRAP_EDGES) return std::nullopt;
  const std::uint32_t first_extra = edge_count;
  if (hubs != 0 && triangles < records) {
    const std::vector<cadt_wrap_edge> extra =
        triangles_between_hubs(run, edges, edge_count, records - std::size_t{triangles});
    if (extra.empty()) return std::nullopt;
    run.device.write(*edges, edge_count * sizeof extra[0], extra.data(), extra.size() * sizeof extra[0]);
    edge_count += static_cast<std::uint32_t>(extra.size());
  } else if (triangles != records || words[1] > link_words) {
    throw InternalError("the wrapped stars have " + std::to_string(triangles) + " triangles instead of " +
                        std::to_string(records) + "; please report this with the input");
  }
  run.statistics.wrapped_stars = n - hubs;
  DeviceMesh mesh;
  mesh.slots = 2 * n;
  mesh.records = run.memory.allocate(mesh.slots * sizeof(cadt_record));
  const Cut shares = launch.cut(n * CADT_WRAP_SHARES);
  launch.run(KernelId::cadt_wrap_records, shares.items, links, begins, sizes, bases, edges, edge_count, first_extra,
             triangles, hubs, count, shares.grain, mesh.records);
  run.end_phase("wrap");
  return mesh;
}

}  // namespace cadt
