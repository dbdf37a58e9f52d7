// SPDX-License-Identifier: Apache-2.0
#include "common/verify/device/verify_on_device.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/driver/device_text.hpp"
#include "common/mesh/mesh.hpp"
#include "common/platform/parallel.hpp"
#include "common/verify/host/mesh.hpp"
#include "common/verify/host/outcome.hpp"

namespace cadt {
namespace {

using namespace verifier;
using namespace device_text;

constexpr std::size_t triangles_per_launch_contiguous = std::size_t{1} << 20;  // bounds the lists: 4 words a triangle
constexpr std::size_t triangles_per_launch_strided = std::size_t{1} << 23;
constexpr std::size_t strided_items = std::size_t{1} << 17;  // enough to fill a GPU; each adds to the results once
constexpr std::size_t entries_per_gather = std::size_t{1} << 18;

/// The rows of results, reduced.
struct Found {
  std::array<std::uint64_t, CADT_FOUND_WORDS> sum{};
  std::array<std::uint32_t, CADT_FOUND_WORDS> least{};

  [[nodiscard]] Findings findings(int finding) const {
    const auto at = static_cast<std::size_t>(finding);
    Findings t;
    t.examined = sum[at];
    t.failures = sum[at + 1];
    if (t.failures != 0) t.first = least[at + 2];
    return t;
  }
  [[nodiscard]] std::uint64_t count(int of) const { return sum[static_cast<std::size_t>(of)]; }
};

/// What the host decided, in the last stage.
struct Settled {
  std::uint64_t signs = 0;
  Findings orientation;  // nothing is counted as examined here: the filter has done so
  Circles circles;
  void merge(const Settled& other) {
    signs += other.signs;
    orientation.merge(other.orientation);
    circles.merge(other.circles);
  }
};

class OnDevice : private Outcome {
 public:
  OnDevice(verifier::Mesh mesh, Context& ctx, const VerifyInput& input, const VerifyOptions& options)
      : Outcome(input.number_of_points), ctx_(ctx), input_(input), options_(options), mesh_(std::move(mesh)) {
    mesh_.count = count_;
    mesh_.threads = platform::threads_or_all(options.threads);
  }

  VerifyReport run() {
    if (!examine_structure()) {
      skip({range, neighbors, orientations, vertices, boundary, euler, hull, delaunay, ties}, counts);
      return finish();
    }
    if (!passed(range)) {
      skip({neighbors, orientations, vertices, boundary, euler, hull, delaunay, ties}, range);
      return finish();
    }
    examine_signs();
    const Found found = results();
    conclude_on_host(mesh_, found.findings(CADT_FOUND_NEIGHBORS), neighbors, conclude_neighbors);
    Findings turns = found.findings(CADT_FOUND_ORIENTATION);
    turns.merge(settled_.orientation);
    report.triangles_examined = turns.examined;
    conclude_on_host(mesh_, turns, orientations, conclude_orientation);
    examine_vertices();
    if (!passed(neighbors)) {
      skip({boundary, euler, hull, delaunay, ties}, neighbors);
    } else {
      examine_boundary(found);
      if (passed(orientations)) {
        conclude_edges(found);
      } else {
        skip({delaunay, ties}, orientations);
      }
    }
    examine_counts(found);
    return finish();
  }

 private:
  /// Launch grid for kernels whose work-items add to the results once each.
  [[nodiscard]] LaunchGrid grid_for(std::size_t count) const {
    if (ctx_.device.shape().contiguous) return launch_.grid(count);
    return {static_cast<std::uint32_t>(std::min(count, strided_items)), static_cast<std::uint32_t>(count), 1};
  }

  [[nodiscard]] Found results() const {
    const auto rows = ctx_.device.read_values(*results_, std::size_t{CADT_FOUND_ROWS} * CADT_FOUND_WORDS);
    Found found;
    found.least.fill(CADT_NONE);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      found.sum[i % CADT_FOUND_WORDS] += rows[i];
      found.least[i % CADT_FOUND_WORDS] = std::min(found.least[i % CADT_FOUND_WORDS], rows[i]);
    }
    return found;
  }

  void clear_results() {
    std::vector<std::uint32_t> rows(static_cast<std::size_t>(CADT_FOUND_ROWS) * CADT_FOUND_WORDS, 0);
    for (std::size_t row = 0; row < rows.size(); row += CADT_FOUND_WORDS)
      for (const int finding : {CADT_FOUND_RANGE, CADT_FOUND_NEIGHBORS, CADT_FOUND_POINTS, CADT_FOUND_DUPLICATES,
                                CADT_FOUND_ORIENTATION, CADT_FOUND_EDGES, CADT_FOUND_TIES})
        rows[row + static_cast<std::size_t>(finding) + 2] = CADT_NONE;
    results_ = ctx_.memory.allocate(rows.size() * word);
    ctx_.device.write(*results_, 0, rows.data(), rows.size() * word);
  }

  /// Fetches the mesh, only if something has failed: messages quote it, and a search needs all of it.
  void fetch_mesh() {
    if (!mesh_.triangles.empty()) return;
    fetched_ = ctx_.device.read_values<std::int32_t>(*input_.mesh.vertices, 3 * count_);
    mesh_.derived = ctx_.device.read_values<std::int32_t>(*input_.mesh.across, 3 * count_);
    mesh_.triangles = fetched_;
    mesh_.neighbors = mesh_.derived;
  }

  template <class Conclude>
  void conclude_on_host(const verifier::Mesh& mesh, const Findings& findings, Name name, const Conclude& to) {
    if (findings.failures != 0) fetch_mesh();
    to(mesh, findings, begin(name));
  }

  /// Returns false if not everything was examined: then indices must not be followed.
  [[nodiscard]] bool examine_structure() {
    clear_results();
    used_ = launch_.zeros(n_);
    const LaunchGrid all = grid_for(count_);
    launch_.run<KernelId::cadt_verify_structure>(all.items, input_.mesh, n_, all.grain, used_, results_);
    launch_.run<KernelId::cadt_verify_points>(input_.mesh.points, grid_for(n_), used_, results_);
    const Found found = results();
    if (const Findings finite = found.findings(CADT_FOUND_POINTS); finite.failures != 0) refuse_point(finite.first);
    mesh_.vertices = static_cast<std::size_t>(found.count(CADT_FOUND_USED));
    const Findings triangles = found.findings(CADT_FOUND_RANGE);
    const std::uint64_t points_examined = found.findings(CADT_FOUND_POINTS).examined;
    begin(counts).passed = true;
    if (triangles.examined != count_ || points_examined != n_) {
      fail(begin(counts), -1,
           std::to_string(triangles.examined) + " triangles and " + std::to_string(points_examined) +
               " points were examined, there are " + std::to_string(count_) + " and " + std::to_string(n_));
      return false;
    }
    conclude_on_host(mesh_, triangles, range, conclude_range);
    symmetric_ = found.findings(CADT_FOUND_NEIGHBORS).failures == 0;
    ctx_.check("verify", 0.2);
    return true;
  }

  /// Orientations and, if neighbours are symmetric, edges: filter, exact sums, and the host for what is left.
  void examine_signs() {
    const std::size_t most =
        ctx_.device.shape().contiguous ? triangles_per_launch_contiguous : triangles_per_launch_strided;
    const LaunchGrid c = grid_for(std::min(count_, most));  // for a smaller last launch too: then some lists stay empty
    const std::size_t room = 4 * std::max((c.count + c.items - 1) / c.items, c.grain);
    lists_ = ctx_.memory.allocate(c.items * room * word);
    sizes_ = launch_.zeros(c.items + std::size_t{1});
    deferred_ = launch_.zeros(1);
    for (std::size_t at = 0; at < count_; at += most) {
      const std::size_t size = std::min(most, count_ - at);
      launch_.run<KernelId::cadt_verify_filter>(c.items, input_.mesh, at, size, symmetric_, c.grain, c.items, lists_,
                                                sizes_, room, results_);
      launch_.run<KernelId::cadt_verify_exact>(c.items, input_.mesh, at, c.items, lists_, sizes_, room, deferred_,
                                               results_);
      if (const std::uint32_t left = launch_.read_word(deferred_, 0); left != 0) {
        ctx_.device.fill(*deferred_, 0, word, 0);
        settle_on_host(at, c.items, room, left);
      }
      ctx_.check("verify", 0.2 + 0.7 * static_cast<double>(at + size) / static_cast<double>(count_));
    }
    lists_.release();
    sizes_.release();
  }

  void settle_on_host(std::size_t at, std::uint32_t items, std::size_t room, std::uint32_t left) {
    ctx_.device.fill(*sizes_, items * word, word, 0);
    launch_.scan(sizes_, std::size_t{items} + 1);
    const std::size_t most = std::min<std::size_t>(left, entries_per_gather);
    Allocation entries = ctx_.memory.allocate(most * word), corners = ctx_.memory.allocate(most * 4 * sizeof(Point));
    std::vector<std::uint32_t> entry(most);
    std::vector<std::array<Point, 4>> quad(most);
    for (std::size_t from = 0; from < left; from += most) {
      const std::size_t size = std::min(most, left - from);
      ctx_.device.fill(*entries, 0, size * word, CADT_NONE);  // shows which are written
      launch_.run<KernelId::cadt_verify_gather>(items, input_.mesh, at, items, lists_, sizes_, room, from, from + size,
                                                entries, corners);
      ctx_.device.read(*entries, 0, entry.data(), size * word);
      ctx_.device.read(*corners, 0, quad.data(), size * sizeof quad[0]);
      settled_.merge(reduce_each<Settled>(size, mesh_.threads,
                                          [&](std::size_t i, Settled& mine) { settle(at, entry[i], quad[i], mine); }));
    }
  }

  static void settle(std::size_t at, std::uint32_t entry, const std::array<Point, 4>& q, Settled& mine) {
    if (entry == CADT_NONE) return;
    ++mine.signs;
    const std::size_t t = at + entry / CADT_OPEN_A_TRIANGLE, k = entry % CADT_OPEN_A_TRIANGLE;
    if (k == CADT_OPEN_ORIENTATION) {
      if (orientation(q[0], q[1], q[2]) <= 0) mine.orientation.fail(t);
      return;
    }
    mine.circles.examine(3 * t + k, q[0], q[1], q[2], q[3]);
  }

  void examine_vertices() {
    const std::size_t unused = n_ - std::min(n_, mesh_.vertices);
    Check& check = begin(vertices);
    if (input_.has_duplicates) {
      const std::span<const Duplicate> list = input_.duplicates;
      if (!list.empty()) {
        const Allocation pairs = ctx_.memory.import(list.data(), list.size_bytes());
        launch_.run<KernelId::cadt_verify_duplicates>(input_.mesh.points, n_, used_, pairs, grid_for(list.size()),
                                                      results_);
      }
      const Findings findings = results().findings(CADT_FOUND_DUPLICATES);
      duplicates_examined_ = findings.examined;
      return conclude_duplicates(list, unused, findings, check);
    }
    if (unused == 0) {
      check.passed = true;
      return;
    }
    // The host finds the vertex that an unused point equals.
    const std::vector<std::uint32_t> used = ctx_.device.read_values(*used_, n_);
    mesh_.used.assign(used.begin(), used.end());
    if (mesh_.points.size() == 0) {
      fetched_points_ = ctx_.device.read_values<double>(*input_.mesh.points, 2 * n_);
      mesh_.points = fetched_points_;
    }
    check_vertices(mesh_, MeshView{}, check);
  }

  void examine_boundary(const Found& found) {
    const auto h = static_cast<std::size_t>(found.count(CADT_FOUND_BOUNDARY));
    using Edge = std::array<std::uint32_t, 3>;
    std::vector<Edge> edges;
    std::vector<Point> starts;
    if (h != 0) {
      const Allocation list = ctx_.memory.allocate(h * sizeof(Edge));
      const Allocation corners = ctx_.memory.allocate(h * sizeof(Point));
      const Allocation written = launch_.zeros(1);
      const LaunchGrid c = grid_for(count_);
      launch_.run<KernelId::cadt_verify_boundary>(c.items, input_.mesh, c.grain, list, corners, written, h);
      boundary_written_ = launch_.read_word(written, 0);
      if (boundary_written_ != h) return skip({boundary, euler, hull}, counts);
      edges = ctx_.device.read_values<Edge>(*list, h);
      starts = ctx_.device.read_values<Point>(*corners, h);
    }
    for (const auto& [edge, from, to] : edges)
      mesh_.boundary.push_back({static_cast<std::int32_t>(from), static_cast<std::int32_t>(to), edge});
    report.hull_vertices = h;
    link_boundary(mesh_, begin(boundary));
    check_euler_formula(mesh_, begin(euler));
    // With counterclockwise triangles one boundary cycle implies one component (docs/verification.md); else components
    // must be counted.
    if (passed(euler) && !(passed(boundary) && passed(orientations))) {
      fetch_mesh();
      check_connected(mesh_, begin(euler));
    }
    if (!passed(boundary)) {
      if (mesh_.triangles.empty()) {  // once more, with the mesh to quote from
        fetch_mesh();
        mesh_.loop.clear();
        link_boundary(mesh_, begin(boundary));
      }
      return skip({hull}, boundary);
    }
    std::vector<std::pair<std::int32_t, Point>> place(h);
    for (std::size_t i = 0; i < h; ++i) place[i] = {static_cast<std::int32_t>(edges[i][1]), starts[i]};
    const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::sort(place.begin(), place.end(), before);
    std::vector<Point> corners;
    corners.reserve(h);
    for (const std::int32_t v : mesh_.loop)
      corners.push_back(std::lower_bound(place.begin(), place.end(), std::pair{v, Point{}}, before)->second);
    check_hull(mesh_.loop, corners, input_.hull, mesh_.threads, begin(hull));
  }

  void conclude_edges(const Found& found) {
    Circles circles;
    circles.illegal = found.findings(CADT_FOUND_EDGES);
    circles.unusual = found.findings(CADT_FOUND_TIES);
    circles.ties = circles.unusual.examined;
    circles.merge(settled_.circles);
    if (circles.illegal.failures + circles.unusual.failures != 0) fetch_mesh();
    Check& check = begin(delaunay);
    conclude_delaunay(mesh_, circles, check, begin(ties), options_, report);
  }

  /// Checks the counts of the kernels against what had to be examined.
  void examine_counts(const Found& found) {
    const std::uint64_t edges = found.findings(CADT_FOUND_EDGES).examined, open = found.count(CADT_FOUND_OPEN);
    report.signs_exact = found.count(CADT_FOUND_EXACT);
    report.signs_on_host = settled_.signs;
    report.signs_filtered = report.triangles_examined + edges - std::min(report.triangles_examined + edges, open);
    const auto require = [&](std::uint64_t examined, std::uint64_t there, const std::string& of) {
      if (examined != there)
        fail(begin(counts), -1, std::to_string(examined) + of + " were examined, there are " + std::to_string(there));
    };
    require(found.findings(CADT_FOUND_NEIGHBORS).examined, 3 * count_, " sides of triangles");
    require(report.triangles_examined, count_, " triangles");
    require(report.signs_exact + settled_.signs, open, " signs that the filter left open");
    require(duplicates_examined_, input_.has_duplicates ? input_.duplicates.size() : 0, " duplicates");
    if (!passed(neighbors)) return;
    require(boundary_written_, found.count(CADT_FOUND_BOUNDARY), " boundary edges");
    require(2 * edges, 3 * count_ - found.count(CADT_FOUND_BOUNDARY), " sides of interior edges");
  }

  Context& ctx_;
  Launcher& launch_ = ctx_.launcher;
  const VerifyInput& input_;
  const VerifyOptions& options_;
  std::size_t n_ = input_.number_of_points, count_ = input_.mesh.triangles;
  verifier::Mesh mesh_;
  std::vector<std::int32_t> fetched_;
  std::vector<double> fetched_points_;
  Allocation results_, used_, lists_, sizes_, deferred_;
  bool symmetric_ = false;
  Settled settled_;
  std::uint64_t duplicates_examined_ = 0, boundary_written_ = 0;
};

}  // namespace

VerifyReport verify_on_device(Context& ctx, const VerifyInput& input, const VerifyOptions& options,
                              verifier::Mesh known) {
  require_ieee_arithmetic();
  return OnDevice(std::move(known), ctx, input, options).run();
}

}  // namespace cadt
