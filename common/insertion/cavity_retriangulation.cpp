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

}  // namespace

CavityRetriangulation::CavityRetriangulation(const LockedMesh& mesh)
    : mesh_(mesh),
      ctx_(mesh.ctx),
      launch_(ctx_.launcher),
      slots_(static_cast<std::uint32_t>(2 * mesh.order.distinct)) {}

/// Four vertices for each edge, the two opposite and its two ends; CADT_NONE if it is not illegal.
std::vector<std::uint32_t> CavityRetriangulation::read_quads(const Allocation& edges, std::uint32_t count) {
  const std::uint32_t read = std::min(count, max_edges);
  const Allocation quads = ctx_.memory.allocate(4 * read * word);
  launch_.run<KernelId::cadt_cavity_candidates>(mesh_, edges, launch_.grid(read), quads);
  return ctx_.device.read_values(*quads, 4 * std::size_t{read});
}

void CavityRetriangulation::remember(const Allocation& edges, std::uint32_t count) {
  remembered_.clear();
  const std::vector<std::uint32_t> quads = read_quads(edges, count);
  for (std::size_t i = 0; i < quads.size(); ++i)
    if (i % 4 < 2 && quads[i] != CADT_NONE) remembered_.insert(quads[i]);
}

/// The remembered vertices to which most of the edges lead.
std::vector<std::uint32_t> CavityRetriangulation::candidates(const std::vector<std::uint32_t>& quads) {
  std::map<std::uint32_t, std::size_t> counts;
  std::size_t illegal = 0;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    if (quads[i] == CADT_NONE || i % 4 > 1) continue;
    if (i % 4 == 0) ++illegal;
    if (remembered_.contains(quads[i])) ++counts[quads[i]];
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

void CavityRetriangulation::write_ends(const std::vector<std::uint32_t>& quads) {
  std::vector<std::uint32_t> ends(CADT_CAVITY_SET_WORDS);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    if (quads[i] == CADT_NONE || i % 4 < 2) continue;
    const std::uint32_t bit = CADT_CAVITY_BIT(quads[i]);
    ends[bit >> 5] |= 1U << (bit & 31U);
  }
  if (!ends_) ends_ = ctx_.memory.allocate(ends.size() * word);
  ctx_.device.write(*ends_, 0, ends.data(), ends.size() * word);
}

/// The large regions of these vertices, the largest first.
std::vector<CavityRetriangulation::Region> CavityRetriangulation::large_regions(
    const std::vector<std::uint32_t>& vertices) {
  const std::size_t count = vertices.size();
  const Allocation list = ctx_.memory.allocate(count * word), sums = launch_.zeros(count);
  ctx_.device.write(*list, 0, vertices.data(), count * word);
  launch_.run<KernelId::cadt_cavity_sizes>(mesh_, launch_.grid_strided(slots_), ends_, list, count, sums);
  const std::vector<std::uint32_t> sizes = ctx_.device.read_values(*sums, count);
  std::vector<Region> regions;
  for (std::size_t v = 0; v < count; ++v)
    if (sizes[v] >= min_region) regions.push_back({sizes[v], vertices[v]});
  std::ranges::sort(regions, std::greater{});
  return regions;
}

/// Retriangulates the region as far as possible. False if nothing is.
bool CavityRetriangulation::retriangulate_region(const Region& region) {
  const std::uint32_t w = region.vertex, capacity = region.triangles + region.triangles / 4 + 64;
  const std::size_t bytes = capacity * word;
  if (!ctx_.memory.allows((CADT_CAVITY_SCRATCH + 4) * bytes)) return false;
  const Allocation list = ctx_.memory.allocate(bytes), kept = ctx_.memory.allocate(bytes),
                   scratch = ctx_.memory.allocate(CADT_CAVITY_SCRATCH * bytes),
                   spokes = ctx_.memory.allocate(2 * bytes), found = launch_.zeros(CADT_CAVITY_WORDS);
  launch_.run<KernelId::cadt_cavity_conflicts>(mesh_, launch_.grid_strided(slots_), ends_, w, list, capacity, found);
  const std::uint32_t conflicts = std::min(launch_.read_word(found, CADT_CAVITY_LISTED), capacity);
  launch_.run<KernelId::cadt_cavity_star>(mesh_, launch_.grid(conflicts), w, list, capacity, found);
  // If the list has no room for all conflicts, it has some of them: cadt_cavity_check sees which components are usable.
  const std::uint32_t listed = std::min(launch_.read_word(found, CADT_CAVITY_LISTED), capacity);
  LaunchGrid c = launch_.grid(listed);
  launch_.run<KernelId::cadt_cavity_roots>(mesh_.locked, c, list, scratch, capacity);
  launch_.run<KernelId::cadt_cavity_join>(mesh_.locked, c, list, scratch);
  launch_.run<KernelId::cadt_cavity_check>(mesh_, c, w, list, scratch, capacity);
  launch_.run<KernelId::cadt_cavity_keep>(mesh_.locked, c, list, scratch, capacity, kept, found);
  const std::uint32_t count = launch_.read_word(found, CADT_CAVITY_KEPT);
  if (count == 0) return false;
  const Allocation& sides = scratch;  // the components are not read any more
  launch_.run<KernelId::cadt_cavity_boundary>(mesh_, launch_.grid(count), w, kept, sides, spokes, capacity, found);
  const std::vector<std::uint32_t> words = ctx_.device.read_values(*found, CADT_CAVITY_WORDS);
  const std::uint32_t spoke_count = words[CADT_CAVITY_SPOKES];
  if (words[CADT_CAVITY_SIDES] != count || spoke_count > capacity)
    give_up("the region of a vertex has ", count, " triangles, ", words[CADT_CAVITY_SIDES], " sides and ", spoke_count,
            " spokes");
  c = launch_.grid(std::size_t{count} + spoke_count);
  launch_.run<KernelId::cadt_cavity_fill>(c.items, mesh_, count, spoke_count, c.grain, w, kept, sides, spokes);
  c = launch_.grid(2 * std::size_t{count} + spoke_count);
  launch_.run<KernelId::cadt_cavity_release>(c.items, mesh_, count, spoke_count, c.grain, kept, sides, spokes);
  return true;
}

std::size_t CavityRetriangulation::retriangulate(const Allocation& edges, std::uint32_t count) {
  const std::vector<std::uint32_t> quads = read_quads(edges, count), vertices = candidates(quads);
  remembered_.clear();
  if (vertices.empty()) return 0;
  write_ends(quads);
  std::size_t regions = 0;
  for (const Region& region : large_regions(vertices)) {
    if (!retriangulate_region(region)) break;  // smaller regions are not likely to do better
    ++regions;
  }
  return regions;
}

}  // namespace cadt
