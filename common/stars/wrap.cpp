// SPDX-License-Identifier: Apache-2.0
#include "common/stars/wrap.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/certify/certify.hpp"
#include "common/driver/device_text.hpp"

namespace cadt {
namespace {

using namespace device_text;

constexpr std::size_t most_teams = 4096;  // as many as a large GPU runs at the same time
constexpr std::uint32_t tree_lanes = CADT_AABB_FANOUT * CADT_WRAP_PARTS;
static_assert(2 * std::uint64_t{CADT_WRAP_MOST} * CADT_WRAP_ONE_REAL <= std::uint64_t{1} << 32);  // packed counts
constexpr std::uint32_t residual_lanes = 128;  // for the longest stars, which set the time
/// Work limit: leaves tested plus exact tests, on average a vertex, and in addition for all vertices together. The
/// residual vertices of 1M uniform points need 14.
constexpr std::uint32_t wrap_work_limit = 96, spare_work_limit = 4096;
/// On GPUs. Where many vertices have to look at many points, all on one side of the hull, they do so at once: about
/// 13,000 leaves in a microsecond. So for each point of the whole mesh this is a nanosecond or two, while insertion of
/// the residual vertices, and the flip cascades that it causes on such sides, takes several.
constexpr std::uint32_t spare_work_of_cards = 1U << 21, spare_work_of_point = 20;
constexpr std::uint32_t most_spare_work = 1U << 31, most_watched_work = 1U << 24;  // the latter: a few milliseconds

/// `all`: number of points of the mesh that the wrapped ones are part of.
std::uint32_t spare_work_limit_of(const Device& device, std::size_t all) {
  if (device.shape().contiguous) return spare_work_limit;
  const std::uint64_t limit = spare_work_of_cards + std::uint64_t{spare_work_of_point} * all;
  const std::uint32_t most = device.info().watchdog ? most_watched_work : most_spare_work;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(limit, most));
}

/// The AABB tree of the points (common/stars/aabb_tree.dev.h); each set begins a leaf and a node of its own.
struct AabbTree {
  Allocation leaves, nodes;
  [[nodiscard]] auto arguments() const { return std::tie(leaves, nodes); }

  /// Also zeroes `sizes` and `counts`, if they are given.
  AabbTree(Context& ctx, const Allocation& points, std::size_t n, const Allocation& starts, std::size_t sets,
           const Allocation& sizes, const Allocation& counts) {
    const std::size_t node_count = (n - 1) / (std::size_t{CADT_AABB_LEAF} * CADT_AABB_FANOUT) + 1 + sets;
    leaves = ctx.memory.allocate((n / CADT_AABB_LEAF + sets + 1) * sizeof(cadt_aabb));
    nodes = ctx.memory.allocate(node_count * sizeof(cadt_aabb));
    const LaunchGrid c = ctx.launcher.grid_of_teams(node_count, tree_lanes);
    ctx.launcher.run_in_groups<KernelId::cadt_build_aabb_tree>(c.items, tree_lanes, points, n, starts, sets, c, leaves,
                                                               nodes, sizes, counts);
  }
};

struct WorkLimit {
  std::uint32_t of_vertex, spare;
  [[nodiscard]] auto arguments() const { return std::tie(of_vertex, spare); }
};

/// The stars of one set of points, and its mesh.
class Wrapping {
 public:
  Wrapping(Context& ctx, const Allocation& points, std::size_t n) : ctx_(ctx), points_(points), n_(n) {}

  /// `all`: number of points of the mesh that these are part of.
  void make_stars(std::size_t all) {
    star_vertices_ = ctx_.memory.allocate(star_words() * word);
    begins_ = ctx_.memory.allocate(n_ * word);
    sizes_ = ctx_.memory.allocate(n_ * word);
    counts_ = ctx_.memory.allocate(CADT_WRAP_WORDS * word);
    wrap(spare_work_limit_of(ctx_.device, all));
    edges_ = ctx_.memory.allocate(CADT_WRAP_EDGES * sizeof(cadt_wrap_edge));
  }

  /// Makes the mesh; if there are no high-degree vertices, all steps are queued without waiting in between, with its
  /// certification if that is wanted. False if too many vertices have no star.
  [[nodiscard]] bool make_arrays(Mesh& mesh, MeshUse use) {
    bases_ = ctx_.memory.allocate((row() + certify_words(ctx_)) * word);
    count();  // all from n on is read at once
    mesh.all = triangles();
    mesh.vertices = make_mesh_array(ctx_, mesh.all, use);
    mesh.across = make_mesh_array(ctx_, mesh.all, use);
    write(mesh, {edges_});
    ctx_.end_phase("wrap");
    const bool certifies = use == MeshUse::whole;
    mesh.triangles = CADT_NONE;  // only the device knows them yet
    if (certifies) launch_certify(ctx_, view_of(mesh, points_), 0, mesh.all, bases_, row());
    const auto words = ctx_.device.read_values(*bases_, row() + certify_words(ctx_) - n_, n_);
    note(words);
    if (high_degree_ != 0) return add_high_degree(mesh, words[0]);
    mesh.triangles = CADT_WRAP_REAL(words[0]);
    const std::size_t found = mesh.triangles + CADT_WRAP_GHOSTS(words[0]);
    // CADT_WRAP_ONE_REAL ghosts are counted as one real triangle.
    if (found < triangles() && (triangles() - found) % (CADT_WRAP_ONE_REAL - 1) == 0) return false;
    require_all(found);
    ctx_.statistics.wrapped_stars = n_;
    if (!certifies) return true;
    read_certificate(ctx_, std::span(words).subspan(row() - n_), n_);
    ctx_.end_phase("certify");
    mesh.certified = true;
    return true;
  }

 private:
  /// Half-edges between vertices without stars; those from `first_extra` on are of triangles that no star has, so many
  /// `extra_real` without the ghost first.
  struct HighDegreeEdges {
    const Allocation& edges;
    std::uint32_t count = 0, first_extra = 0, extra_real = 0, high_degree = 0;
    [[nodiscard]] auto arguments() const { return std::tie(edges, count, first_extra, extra_real, high_degree); }
  };

  void wrap(std::uint32_t spare_work) {
    const Allocation none, todo = ctx_.memory.allocate(n_ * word),
                           arcs = ctx_.memory.allocate(n_ * CADT_WRAP_ROW * sizeof(std::uint16_t));
    const AabbTree tree(ctx_, points_, n_, none, 0, sizes_, counts_);
    const WrappedStars stars{0, star_vertices_, star_words(), begins_, sizes_, counts_};
    const LaunchGrid teams = launch_.grid_of_teams(n_, wrap_lanes);
    launch_.run_in_groups<KernelId::cadt_wrap_near>(teams.items, wrap_lanes, points_, tree, teams, stars, todo, arcs);
    // Only the device knows how many are left to do.
    const LaunchGrid residual =
        ctx_.device.shape().contiguous ? teams : launch_.grid_of_teams(std::min(n_, most_teams), residual_lanes);
    launch_.run_in_groups<KernelId::cadt_wrap_stars>(residual.items, residual_lanes, points_, tree, n_, todo, 0U, arcs,
                                                     WrappedSets{none, 0, none}, none,
                                                     WorkLimit{wrap_work_limit, spare_work}, residual.grain, stars);
  }

  void write(const Mesh& mesh, const HighDegreeEdges& of_high_degree) {
    const LaunchGrid shares = launch_.grid(n_ * CADT_WRAP_SHARES);
    launch_.run<KernelId::cadt_wrap_arrays>(shares.items, star_vertices_, begins_, sizes_, bases_, star_words(), row(),
                                            of_high_degree, n_, shares.grain, mesh.vertices, mesh.across);
  }

  /// `known`: the packed count of the triangles of stars.
  [[nodiscard]] bool add_high_degree(Mesh& mesh, std::uint32_t known) {
    const std::uint32_t real = CADT_WRAP_REAL(known), found = real + CADT_WRAP_GHOSTS(known);
    HighDegreeEdges e{edges_};
    e.first_extra = e.count = launch_.read_word(counts_, CADT_WRAP_OPEN_EDGES);
    e.high_degree = high_degree_;
    if (high_degree_ > CADT_MOST_HIGH_DEGREE || e.first_extra > CADT_WRAP_EDGES) return false;
    if (found < triangles()) {
      if (!add_triangles_of_high_degree(e, triangles() - found)) return false;
    } else {
      require_all(found);
    }
    mesh.triangles = real + e.extra_real;
    ctx_.statistics.wrapped_stars = n_ - high_degree_;
    write(mesh, e);
    ctx_.end_phase("wrap");
    return true;
  }

  [[nodiscard]] std::size_t triangles() const noexcept { return 2 * n_ - 2; }
  [[nodiscard]] std::size_t star_words() const noexcept { return 3 * triangles(); }  // the ghost has no star

  /// Where the words of certification begin, behind the first triangles, their total and the counts.
  [[nodiscard]] std::size_t row() const noexcept {
    return (n_ + CADT_WRAP_DRIVER_WORDS) / CADT_COUNTER_STRIDE * CADT_COUNTER_STRIDE + CADT_COUNTER_STRIDE;
  }

  /// First triangles of the vertices; behind them the total, the counts, and zeros. Vertices without a star have size
  /// 0, so this may run before it is known whether there are too many.
  void count() {
    const std::size_t zeros = row() + certify_words(ctx_) - (n_ + 1 + CADT_WRAP_DRIVER_WORDS);
    launch_.run<KernelId::cadt_wrap_counts>(star_vertices_, begins_, sizes_, launch_.grid(n_), counts_, bases_, zeros,
                                            edges_);
    launch_.scan(bases_, n_ + 1);
  }

  /// Takes over the total and the counts.
  void note(std::span<const std::uint32_t> words) {
    used_words_ = words[1 + CADT_WRAP_OVERFLOWED];
    high_degree_ = words[1 + CADT_WRAP_FAILED];
    note_exact(words.subspan(1 + CADT_WRAP_EXACT_ORIENTATIONS, 3));
  }

  /// Adds the exact tests since the last call to the statistics.
  void note_exact(std::span<const std::uint32_t> words) {
    ctx_.statistics.exact_orientations += words[0] - exact_[0];
    ctx_.statistics.exact_incircles += words[1] - exact_[1];
    ctx_.statistics.ties += words[2] - exact_[2];
    std::ranges::copy(words, exact_.begin());
  }

  /// Adds the triangles of three vertices without stars, each as its three half-edges behind the known ones, those
  /// without the ghost first. False if that does not fill all gaps.
  [[nodiscard]] bool add_triangles_of_high_degree(HighDegreeEdges& all, std::size_t wanted) {
    const std::uint32_t known = all.first_extra;
    if (known + 3 * wanted > CADT_WRAP_EDGES || known == 0) return false;
    const auto edges = ctx_.device.read_values<cadt_wrap_edge>(*edges_, known);
    using HalfEdge = std::pair<std::uint32_t, std::uint32_t>;
    std::set<HalfEdge> sides;  // half-edges whose triangle is known
    for (const cadt_wrap_edge& e : edges) sides.emplace(e.from, e.to);
    std::vector<cadt_wrap_edge> real, ghosts;  // half-edges of the new triangles
    const Allocation high_degree = ctx_.memory.allocate(high_degree_ * word), listed = launch_.zeros(1);
    launch_.run<KernelId::cadt_list_high_degree>(sizes_, launch_.grid(n_), high_degree, listed);
    for (std::size_t round = 0; round < wanted; ++round) {
      // Edges to the ghost need no search: the hull edges lead to all of its triangles.
      std::vector<cadt_wrap_edge> open;
      for (const auto& [from, to] : sides)
        if (from != CADT_GHOST && to != CADT_GHOST && !sides.contains({to, from})) open.push_back({to, from, 0});
      if (open.empty()) break;
      find_apexes(open, high_degree);
      for (const auto& [a, b, c] : open) {
        if (sides.contains({a, b})) continue;  // of a triangle that another edge has led to
        if (known + real.size() + ghosts.size() + 3 > CADT_WRAP_EDGES) return false;
        for (const cadt_wrap_edge& e : {cadt_wrap_edge{a, b, c}, {b, c, a}, {c, a, b}}) {
          (c == CADT_GHOST ? ghosts : real).push_back(e);
          sides.emplace(e.from, e.to);
        }
      }
    }
    note_exact(ctx_.device.read_values(*counts_, 3, CADT_WRAP_EXACT_ORIENTATIONS));
    const bool closed = std::ranges::all_of(sides, [&](HalfEdge e) { return sides.contains({e.second, e.first}); });
    all.extra_real = static_cast<std::uint32_t>(real.size() / 3);
    real.insert(real.end(), ghosts.begin(), ghosts.end());
    if (!closed || real.size() != 3 * wanted || sides.size() != known + real.size()) return false;
    all.count = static_cast<std::uint32_t>(known + real.size());
    ctx_.device.write(*edges_, known * sizeof real[0], real.data(), real.size() * sizeof real[0]);
    return true;
  }

  /// The apex to the left of edges between two high-degree vertices.
  void find_apexes(std::vector<cadt_wrap_edge>& edges, const Allocation& high_degree) {
    const std::size_t bytes = edges.size() * sizeof edges[0];
    const Allocation list = ctx_.memory.allocate(bytes);
    ctx_.device.write(*list, 0, edges.data(), bytes);
    launch_.run<KernelId::cadt_apex_of_high_degree>(points_, high_degree, high_degree_,
                                                    launch_.grid_spread(edges.size()), list, counts_);
    ctx_.device.read(*list, 0, edges.data(), bytes);
  }

  void require_all(std::size_t found) const {
    if (found == triangles() && used_words_ <= star_words()) return;
    give_up("the wrapped stars have ", found, " triangles instead of ", triangles());
  }

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  const Allocation& points_;
  std::size_t n_;
  Allocation star_vertices_, begins_, sizes_, counts_, edges_, bases_;
  std::uint32_t used_words_ = 0, high_degree_ = 0;
  std::array<std::uint32_t, 3> exact_{};  // exact orientations, incircles, ties already in the statistics
};

}  // namespace

void wrap_batch(Context& ctx, const Allocation& points, std::size_t n, const Allocation& list, std::size_t list_size,
                const WrappedSets& sets, const WrappedStars& stars) {
  const AabbTree tree(ctx, points, n, sets.starts, sets.count, {}, {});
  const Allocation work_done = ctx.launcher.zeros(sets.count), none;
  const LaunchGrid teams = ctx.launcher.grid_of_teams(list_size, wrap_lanes);
  ctx.launcher.run_in_groups<KernelId::cadt_wrap_stars>(teams.items, wrap_lanes, points, tree, n, list, list_size, none,
                                                        sets, work_done, WorkLimit{wrap_work_limit, spare_work_limit},
                                                        teams.grain, stars);
}

std::optional<Mesh> wrap_mesh(Context& ctx, const Allocation& points, std::size_t n, std::size_t all, MeshUse use) {
  if (n < 3) return std::nullopt;
  Wrapping wrapping(ctx, points, n);
  wrapping.make_stars(all);
  Mesh mesh;
  if (!wrapping.make_arrays(mesh, use)) return std::nullopt;
  return mesh;
}

}  // namespace cadt
