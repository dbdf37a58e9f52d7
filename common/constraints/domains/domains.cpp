// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/domains/domains.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "common/constraints/chains.hpp"
#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

namespace {

constexpr std::int32_t unknown = std::numeric_limits<std::int32_t>::min();

[[noreturn]] void refuse_open(Domain domain, std::uint32_t vertex) {
  const bool parity = domain == Domain::even_odd;
  const std::string at = "point " + std::to_string(vertex), counted = ", counted as often as they were given";
  throw DomainError("the segments do not bound a domain: " +
                        (parity ? "an odd number of them ends at " + at + counted + "; close the outlines"
                                : "not as many of them end at " + at + " as begin there" + counted +
                                      "; close the outlines, and give all of one the same direction"),
                    static_cast<std::int32_t>(vertex));
}

/// How much each edge counts: how often it is in a chain (even_odd), or that upwards minus downwards (nonzero).
struct EdgeWeights {
  std::vector<std::uint32_t> begins, uppers;  ///< of the edges with each lower vertex
  std::vector<std::int32_t> weights;
  bool all_one = true;

  EdgeWeights(std::span<const std::uint32_t> offsets, std::span<const std::uint32_t> vertices, Domain domain,
              std::size_t points) {
    const auto each_edge = [&](const auto& use) {
      for (std::size_t s = 0; s + 1 < offsets.size(); ++s)
        for (std::size_t i = offsets[s]; i + 1 < offsets[s + 1]; ++i) use(vertices[i], vertices[i + 1]);
    };
    std::vector<std::uint32_t> ends(points + 1);  // counts, then where the next edge of a vertex goes
    each_edge([&](std::uint32_t from, std::uint32_t to) { ++ends[std::min(from, to) + 1]; });
    for (std::size_t v = 0; v < points; ++v) ends[v + 1] += ends[v];
    std::vector<std::pair<std::uint32_t, std::int32_t>> parts(ends[points]);
    std::vector<std::uint32_t> first = ends;
    const bool directed = domain == Domain::nonzero;
    each_edge([&](std::uint32_t from, std::uint32_t to) {
      parts[ends[std::min(from, to)]++] = {std::max(from, to), directed && from > to ? -1 : 1};
    });
    begins.reserve(points + 1);
    uppers.reserve(parts.size());
    weights.reserve(parts.size());
    for (std::size_t v = 0; v < points; ++v) {
      begins.push_back(static_cast<std::uint32_t>(uppers.size()));
      std::ranges::sort(std::span(parts).subspan(first[v], first[v + 1] - first[v]));
      for (std::size_t i = first[v]; i < first[v + 1]; ++i) {
        if (i != first[v] && parts[i].first == uppers.back()) {
          weights.back() += parts[i].second;
          continue;
        }
        uppers.push_back(parts[i].first);
        weights.push_back(parts[i].second);
      }
    }
    begins.push_back(static_cast<std::uint32_t>(uppers.size()));
    all_one = !directed && uppers.size() == parts.size();
  }
};

/// The same on the device (cadt_edge_weights); null arrays if all are 1.
struct WeightTable {
  Allocation begins, uppers, weights;
  WeightTable(Context& ctx, const EdgeWeights& host) {
    if (host.all_one) return;
    begins = copy(ctx, host.begins);
    uppers = copy(ctx, host.uppers);
    weights = copy(ctx, host.weights);
  }
  WeightTable() = default;
  [[nodiscard]] auto arguments() const { return std::tie(begins, uppers, weights); }

 private:
  template <class T>
  static Allocation copy(Context& ctx, const std::vector<T>& values) {
    static_assert(sizeof(T) == word);
    Allocation to = ctx.memory.allocate(values.size() * word);
    if (!values.empty()) ctx.device.write(*to, 0, values.data(), values.size() * word);
    return to;
  }
};

struct Link {
  std::uint32_t left, right, weight;
};
static_assert(sizeof(Link) == CADT_LINK_WORDS * word);

/// `room`: at least the number of links. `tree`: those of a spanning tree of `nodes` regions alone.
std::vector<Link> read_links(Context& ctx, const DomainMesh& mesh, const Allocation& region, const WeightTable& table,
                             bool tree, std::size_t nodes, std::size_t room) {
  if (room == 0) return {};
  Launcher& launch = ctx.launcher;
  Allocation roots;
  if (tree) {
    roots = ctx.memory.allocate(nodes * word);
    launch.run<KernelId::cadt_identity>(roots, launch.grid(nodes));
  }
  const Allocation counter = launch.zeros(1), links = ctx.memory.allocate(room * sizeof(Link));
  // Regions with very many edges between them, such as land and sea, are joined by a few of these first: all at once
  // would want to change the same word.
  constexpr std::size_t few = 64;
  for (std::size_t step = tree ? few : 1; step != 0; step /= few)
    launch.run<KernelId::cadt_domain_links>(mesh, mesh.triangles, step, launch.grid((mesh.triangles - 1) / step + 1),
                                            region, roots, table, counter, links, room);
  const std::size_t count = launch.read_word(counter, 0);
  if (count > room || (tree && count != nodes - 1))
    give_up("the regions have ", count, " links instead of ", tree ? nodes - 1 : room);
  return ctx.device.read_values<Link>(*links, count);
}

/// Links from both of their ends, in CSR, to walk the regions from the outside, nearest first.
class RegionGraph {
 public:
  RegionGraph(std::size_t nodes, std::span<const Link> links)
      : begins_(nodes + 1), links_(links), ends_(2 * links.size()) {
    for (const Link& link : links) ++begins_[link.left], ++begins_[link.right];
    std::size_t sum = 0;
    for (std::size_t& begin : begins_) begin = sum += begin;
    for (std::size_t i = 0; i < links.size(); ++i)
      ends_[--begins_[links[i].left]] = i, ends_[--begins_[links[i].right]] = i;
  }

  /// The value of each region: that of the outside is 0, and `across(value, weight)` that of a region which it has been
  /// reached by a link from one of that value; the weight is that of the side it has been reached on.
  template <class Across>
  [[nodiscard]] std::vector<std::int32_t> values(std::size_t outside, const Across& across) const {
    std::vector<std::int32_t> value(begins_.size() - 1, unknown);
    std::vector<std::size_t> queue = {outside};
    queue.reserve(value.size());
    value[outside] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::size_t from = queue[i];
      for (std::size_t e = begins_[from]; e < begins_[from + 1]; ++e) {
        const Link& link = links_[ends_[e]];
        const bool to_left = link.right == from;
        const std::size_t to = to_left ? link.left : link.right;
        if (value[to] != unknown) continue;
        value[to] = across(value[from], static_cast<std::int32_t>(to_left ? link.weight : 0u - link.weight));
        queue.push_back(to);
      }
    }
    return value;
  }

 private:
  std::vector<std::size_t> begins_;
  std::span<const Link> links_;
  std::vector<std::size_t> ends_;
};

/// What kernels tell of the mesh and its chains.
struct Found {
  std::size_t regions, outside;  ///< outside: its region, which may have no triangle
  std::uint32_t edges, chains, open;
};

/// Regions of all triangles and, for rules that need it, whether segments close.
Found find_regions(Context& ctx, const DomainMesh& mesh, std::size_t points, const DeviceChains& chains, Domain domain,
                   Domains& domains) {
  Launcher& launch = ctx.launcher;
  const std::size_t count = mesh.triangles;
  const LaunchGrid all = launch.grid(count);
  const Allocation words = launch.zeros(CADT_DOMAIN_WORDS), roots = ctx.memory.allocate((count + 1) * word),
                   numbers = ctx.memory.allocate((count + 1) * word);
  ctx.device.fill(*words, CADT_DOMAIN_OPEN * word, word, CADT_NONE);
  domains.region = ctx.memory.allocate((count + 1) * word);
  launch.run<KernelId::cadt_identity>(roots, launch.grid(count + 1));
  launch.run<KernelId::cadt_domain_unite>(mesh, all, roots, words);
  launch.run<KernelId::cadt_domain_roots>(roots, all, numbers);
  launch.scan(numbers, count + 1);
  launch.run<KernelId::cadt_domain_regions>(roots, numbers, all, domains.region, words);
  if (chains.count != 0 && (domain == Domain::even_odd || domain == Domain::nonzero)) {
    const Allocation balance = ctx.memory.allocate_zeros(points * word);
    launch.run<KernelId::cadt_domain_ends>(chains.offsets, chains.vertices, chains.length, launch.grid(chains.count),
                                           balance, words);
    launch.run<KernelId::cadt_domain_open>(balance, domain == Domain::even_odd ? 1U : CADT_NONE, launch.grid(points),
                                           words);
  }
  const auto found = ctx.device.read_values(*words, CADT_DOMAIN_WORDS);
  return {found[CADT_DOMAIN_REGIONS], found[CADT_DOMAIN_OUTSIDE], found[CADT_DOMAIN_EDGES], found[CADT_DOMAIN_CHAINS],
          found[CADT_DOMAIN_OPEN]};
}

WeightTable weights_of(Context& ctx, const DeviceChains& chains, Domain domain, std::size_t points) {
  const auto offsets = ctx.device.read_values(*chains.offsets, chains.count + 1),
             vertices = ctx.device.read_values(*chains.vertices, chains.length);
  return WeightTable(ctx, EdgeWeights(offsets, vertices, domain, points));
}

/// Values by crossing constrained edges from the outside.
std::vector<std::int32_t> values_by_crossing(Context& ctx, const DomainMesh& mesh, std::size_t points,
                                             const DeviceChains& chains, Domain domain, const Allocation& region,
                                             const Found& found) {
  const bool layers = domain == Domain::layers;
  WeightTable table;
  if (!layers && chains.length != 0) {
    if (found.open != CADT_NONE) refuse_open(domain, found.open);
    // Chains that have as many edges as there are have each of them once.
    const bool once = found.edges == chains.length - found.chains;
    if (domain != Domain::even_odd || !once) table = weights_of(ctx, chains, domain, points);
  }
  const std::size_t nodes = std::max(found.regions, found.outside + 1);  // with the outside, if it has no triangle
  const std::vector<Link> links =
      read_links(ctx, mesh, region, table, !layers, nodes, layers ? chains.length : nodes - 1);
  std::vector<std::int32_t> values =
      RegionGraph(nodes, links).values(found.outside, [&](std::int32_t value, std::int32_t weight) {
        return layers ? value + 1 : domain == Domain::even_odd ? (value + weight) & 1 : value + weight;
      });
  values.resize(found.regions);
  return values;
}

bool is_inside(Domain domain, std::int32_t value) {
  return domain == Domain::even_odd || domain == Domain::layers ? (value & 1) != 0 : value != 0;
}

}  // namespace

Domains find_domains(Context& ctx, const DomainMesh& mesh, std::size_t points, const DeviceChains& chains,
                     const DomainSeeds& seeds, const ConstraintOptions& options) {
  Domains domains;
  if (mesh.triangles == 0) return domains;
  const std::size_t count = mesh.triangles;
  const Found found = find_regions(ctx, mesh, points, chains, options.domain, domains);
  const std::size_t regions = found.regions, outside = found.outside;

  domains.attribute.assign(regions, 0);
  if (options.domain == Domain::even_odd || options.domain == Domain::nonzero || options.domain == Domain::layers) {
    domains.value = values_by_crossing(ctx, mesh, points, chains, options.domain, domains.region, found);
  } else {
    domains.value.assign(regions, 1);
    const bool hull = options.domain == Domain::hull;
    if (!hull && outside < regions) domains.value[outside] = 0;
    std::vector<std::uint32_t> region;
    if (!seeds.holes.empty() || !seeds.regions.empty()) region = ctx.device.read_values(*domains.region, count);
    for (const std::int32_t t : seeds.holes)
      if (t >= 0) domains.value[region[static_cast<std::size_t>(t)]] = 0;
    for (std::size_t i = seeds.regions.size(); i-- > 0;) {  // the first that lies in a region has the last word
      if (const std::int32_t t = seeds.regions[i]; t >= 0)
        domains.attribute[region[static_cast<std::size_t>(t)]] = options.regions[i].attribute;
    }
  }
  for (const std::int32_t value : domains.value) domains.inside.push_back(is_inside(options.domain, value) ? 1 : 0);
  return domains;
}

InsideMesh pack_inside(Context& ctx, const DomainMesh& mesh, const Domains& domains) {
  InsideMesh packed;
  if (mesh.triangles == 0) return packed;
  Launcher& launch = ctx.launcher;
  const LaunchGrid all = launch.grid(mesh.triangles);
  const std::size_t regions = domains.inside.size();
  const Allocation of_regions = ctx.memory.allocate(regions * word),
                   places = ctx.memory.allocate((mesh.triangles + 1) * word);
  packed.inside = ctx.memory.allocate((mesh.triangles + 1) * word);
  ctx.device.write(*of_regions, 0, domains.inside.data(), regions * word);
  launch.run<KernelId::cadt_domain_flags>(domains.region, of_regions, all, packed.inside);
  launch.run<KernelId::cadt_domain_flags>(domains.region, of_regions, all, places);
  launch.scan(places, mesh.triangles + 1);
  packed.triangles = launch.read_word(places, mesh.triangles);
  if (packed.triangles == 0) return packed;
  packed.vertices = ctx.memory.allocate(3 * packed.triangles * word);
  packed.neighbors = ctx.memory.allocate(3 * packed.triangles * word);
  packed.edge_flags = ctx.memory.allocate(packed.triangles * word);
  launch.run<KernelId::cadt_domain_pack>(mesh, all, places, packed.vertices, packed.neighbors, packed.edge_flags);
  return packed;
}

HostDomains find_domains(Context& ctx, const HostDomainMesh& mesh, const SegmentChains& chains,
                         const ConstraintOptions& options) {
  HostDomains host;
  const std::size_t count = mesh.edge_flags.size();
  const DomainSeeds seeds = locate_seeds(mesh.triangles, mesh.points, mesh.added, options, ctx.options.stop);
  if (count == 0) return host;
  const Allocation vertices = ctx.memory.import(mesh.triangles.data(), 3 * count * word),
                   neighbors = ctx.memory.import(mesh.neighbors.data(), 3 * count * word),
                   flags = ctx.memory.import(mesh.edge_flags.data(), count * word);
  require_chain_length(chains.vertices.size());
  const std::vector<std::uint32_t> offsets(chains.offsets.begin(), chains.offsets.end());
  const Allocation begins = ctx.memory.import(offsets.data(), offsets.size() * word);
  Allocation along;
  if (!chains.vertices.empty()) along = ctx.memory.import(chains.vertices.data(), chains.vertices.size() * word);
  Domains domains =
      find_domains(ctx, {vertices, neighbors, flags, count}, mesh.points.size() + mesh.added.xy.size() / 2,
                   {begins, along, chains.offsets.size() - 1, chains.vertices.size()}, seeds, options);
  host.region = ctx.device.read_values<std::int32_t>(*domains.region, count);
  host.region_value = std::move(domains.value);
  host.region_attribute = std::move(domains.attribute);
  host.inside.reserve(count);
  for (const std::int32_t region : host.region) {
    const std::uint32_t inside = domains.inside[static_cast<std::size_t>(region)];
    host.inside.push_back(static_cast<std::uint8_t>(inside));
    host.number_inside += inside;
  }
  return host;
}

}  // namespace cadt
