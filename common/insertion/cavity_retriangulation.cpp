// SPDX-License-Identifier: Apache-2.0
#include "common/insertion/cavity_retriangulation.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace cadt {
namespace {

using namespace device_text;

constexpr std::uint32_t max_edges = 256;  // of which the opposite vertices are read
constexpr std::uint32_t min_region = 64;  // triangles: flips take less time for fewer
constexpr std::size_t least_share = 16;   // a vertex counts if one of so many illegal edges leads to it

/// Four vertices for each edge, the two opposite and its two ends; CADT_NONE if it is not illegal.
std::vector<std::uint32_t> read_quads(const LockedMesh& mesh, const Allocation& edges, std::uint32_t count) {
  const std::uint32_t read = std::min(count, max_edges);
  const Allocation quads = mesh.ctx.memory.allocate(4 * read * word);
  mesh.ctx.launcher.run<KernelId::cadt_cavity_candidates>(mesh, edges, mesh.ctx.launcher.grid(read), quads);
  return mesh.ctx.device.read_values(*quads, 4 * std::size_t{read});
}

/// The remembered vertices to which most of the edges lead.
std::vector<std::uint32_t> candidates(const std::set<std::uint32_t>& remembered,
                                      const std::vector<std::uint32_t>& quads) {
  std::map<std::uint32_t, std::size_t> counts;
  std::size_t illegal = 0;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    if (quads[i] == CADT_NONE || i % 4 > 1) continue;
    if (i % 4 == 0) ++illegal;
    if (remembered.contains(quads[i])) ++counts[quads[i]];
  }
  std::vector<std::pair<std::size_t, std::uint32_t>> ranked;
  for (const auto& [v, count] : counts)
    if (count * least_share >= illegal) ranked.emplace_back(count, v);
  std::ranges::sort(ranked, std::greater{});
  ranked.resize(std::min<std::size_t>(ranked.size(), CADT_CAVITY_CANDIDATES));
  std::vector<std::uint32_t> best;
  for (const auto& [count, v] : ranked) best.push_back(v);
  return best;
}

/// The set of the ends of the edges.
std::vector<std::uint32_t> ends_of(const std::vector<std::uint32_t>& quads) {
  std::vector<std::uint32_t> ends(CADT_CAVITY_SET_WORDS);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    if (quads[i] == CADT_NONE || i % 4 < 2) continue;
    const std::uint32_t bit = CADT_CAVITY_BIT(quads[i]);
    ends[bit >> 5] |= 1U << (bit & 31U);
  }
  return ends;
}

struct Region {
  std::uint32_t triangles, vertex;
  auto operator<=>(const Region&) const = default;
};

LaunchGrid grid_of_slots(const LockedMesh& mesh) { return mesh.ctx.launcher.grid_strided(2 * mesh.order.distinct); }

/// The large regions of these vertices, the largest first.
std::vector<Region> large_regions(const LockedMesh& mesh, const Allocation& ends,
                                  const std::vector<std::uint32_t>& vertices) {
  Launcher& launch = mesh.ctx.launcher;
  const std::size_t count = vertices.size();
  const Allocation list = mesh.ctx.memory.allocate(count * word), sums = launch.zeros(count);
  mesh.ctx.device.write(*list, 0, vertices.data(), count * word);
  launch.run<KernelId::cadt_cavity_sizes>(mesh, grid_of_slots(mesh), ends, list, count, sums);
  const std::vector<std::uint32_t> sizes = mesh.ctx.device.read_values(*sums, count);
  std::vector<Region> regions;
  for (std::size_t v = 0; v < count; ++v)
    if (sizes[v] >= min_region) regions.push_back({sizes[v], vertices[v]});
  std::ranges::sort(regions, std::greater{});
  return regions;
}

/// Retriangulates the region as far as possible. False if nothing is.
bool retriangulate_region(const LockedMesh& mesh, const Allocation& ends, const Region& region) {
  Launcher& launch = mesh.ctx.launcher;
  Memory& memory = mesh.ctx.memory;
  const std::uint32_t w = region.vertex, capacity = region.triangles + region.triangles / 4 + 64;
  const std::size_t bytes = capacity * word;
  if (!memory.allows((CADT_CAVITY_SCRATCH + 4) * bytes)) return false;
  const Allocation list = memory.allocate(bytes), kept = memory.allocate(bytes),
                   scratch = memory.allocate(CADT_CAVITY_SCRATCH * bytes), spokes = memory.allocate(2 * bytes),
                   found = launch.zeros(CADT_CAVITY_WORDS);
  launch.run<KernelId::cadt_cavity_conflicts>(mesh, grid_of_slots(mesh), ends, w, list, capacity, found);
  const std::uint32_t conflicts = std::min(launch.read_word(found, CADT_CAVITY_LISTED), capacity);
  launch.run<KernelId::cadt_cavity_star>(mesh, launch.grid(conflicts), w, list, capacity, found);
  // If the list has no room for all conflicts, it has some of them: cadt_cavity_check sees which components are usable.
  const std::uint32_t listed = std::min(launch.read_word(found, CADT_CAVITY_LISTED), capacity);
  LaunchGrid c = launch.grid(listed);
  launch.run<KernelId::cadt_cavity_roots>(mesh.locked, c, list, scratch, capacity);
  launch.run<KernelId::cadt_cavity_join>(mesh.locked, c, list, scratch);
  launch.run<KernelId::cadt_cavity_check>(mesh, c, w, list, scratch, capacity);
  launch.run<KernelId::cadt_cavity_keep>(mesh.locked, c, list, scratch, capacity, kept, found);
  const std::uint32_t count = launch.read_word(found, CADT_CAVITY_KEPT);
  if (count == 0) return false;
  const Allocation& sides = scratch;  // the components are not read any more
  launch.run<KernelId::cadt_cavity_boundary>(mesh, launch.grid(count), w, kept, sides, spokes, capacity, found);
  const std::vector<std::uint32_t> words = mesh.ctx.device.read_values(*found, CADT_CAVITY_WORDS);
  const std::uint32_t spoke_count = words[CADT_CAVITY_SPOKES];
  if (words[CADT_CAVITY_SIDES] != count || spoke_count > capacity)
    give_up("the region of a vertex has ", count, " triangles, ", words[CADT_CAVITY_SIDES], " sides and ", spoke_count,
            " spokes");
  c = launch.grid(std::size_t{count} + spoke_count);
  launch.run<KernelId::cadt_cavity_fill>(c.items, mesh, count, spoke_count, c.grain, w, kept, sides, spokes);
  c = launch.grid(2 * std::size_t{count} + spoke_count);
  launch.run<KernelId::cadt_cavity_release>(c.items, mesh, count, spoke_count, c.grain, kept, sides, spokes);
  return true;
}

}  // namespace

void CavityRetriangulation::remember(const Allocation& edges, std::uint32_t count) {
  remembered_.clear();
  const std::vector<std::uint32_t> quads = read_quads(mesh_, edges, count);
  for (std::size_t i = 0; i < quads.size(); ++i)
    if (i % 4 < 2 && quads[i] != CADT_NONE) remembered_.insert(quads[i]);
}

std::size_t CavityRetriangulation::retriangulate(const Allocation& edges, std::uint32_t count) {
  const std::vector<std::uint32_t> quads = read_quads(mesh_, edges, count), vertices = candidates(remembered_, quads);
  remembered_.clear();
  if (vertices.empty()) return 0;
  const std::vector<std::uint32_t> ends = ends_of(quads);
  if (!ends_) ends_ = mesh_.ctx.memory.allocate(ends.size() * word);
  mesh_.ctx.device.write(*ends_, 0, ends.data(), ends.size() * word);
  std::size_t regions = 0;
  for (const Region& region : large_regions(mesh_, ends_, vertices)) {
    if (!retriangulate_region(mesh_, ends_, region)) break;  // smaller regions are not likely to do better
    ++regions;
  }
  return regions;
}

}  // namespace cadt
