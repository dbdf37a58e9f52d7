// SPDX-License-Identifier: Apache-2.0
// The checks of a mesh in nodes. They look at the arrays alone: what the builder says of itself is compared in the end.
#include "tiles/mesh_directory.hpp"

#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>

#include "tiles/verify_parts.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace cadt::tiles {
namespace {

using namespace verification;

constexpr std::size_t next3(std::size_t k) { return k == 2 ? 0 : k + 1; }
constexpr std::size_t previous3(std::size_t k) { return k == 0 ? 2 : k - 1; }

/// What a thread finds out about triangles.
struct Triangles {
  Findings range, neighbors, orientation, delaunay, ties;
  std::uint64_t edges = 0, cocircular = 0;
  std::vector<BoundaryEdge> boundary;
  void merge(Triangles&& other) {
    range.merge(other.range), neighbors.merge(other.neighbors), orientation.merge(other.orientation);
    delaunay.merge(other.delaunay), ties.merge(other.ties);
    edges += other.edges, cocircular += other.cocircular;
    boundary.insert(boundary.end(), other.boundary.begin(), other.boundary.end());
  }
};

class Verification {
 public:
  Verification(const NodeMesh& mesh, const VerifyOptions& options)
      : mesh_(mesh), tree_(mesh.tree()), options_(options), used_(tree_.number_of_points()), seen_(used_) {
    for (std::uint32_t i = 0; i < tree_.size(); ++i) {
      nodes_.push_back(mesh.node(i));
      base_.push_back(triangles_);
      triangles_ += nodes_.back().number_of_triangles();
    }
  }

  /// Checks are added to `report`.
  void operator()(VerifyReport& report) {
    report.points = tree_.number_of_points();
    check_range();
    add(report, "range", found_.range, "has a vertex that is no point of its node, or one twice");
    if (found_.range.failures == 0) check_triangles();
    add(report, "neighbors", found_.neighbors, "has a neighbour across an edge that does not have it, or another edge");
    add(report, "orientation", found_.orientation, "is not counterclockwise");
    check_vertices();
    report.checks.push_back(points_.conclude("vertices"));
    const bool sound = found_.range.failures + found_.neighbors.failures + found_.orientation.failures == 0;
    check_boundary(report, sound);
    check_euler(report);
    add(report, "delaunay", found_.delaunay, "has the vertex across an edge inside its circle");
    add(report, "ties", found_.ties, "has an edge of cocircular points that the symbolic perturbation does not choose");
    if (!options_.canonical_ties) report.checks.back().passed = true;
    report.triangles_examined = triangles_;
    report.edges_examined = found_.edges;
    report.ties = found_.cocircular;
    report.unusual_ties = found_.ties.failures;
  }

  [[nodiscard]] std::uint64_t distinct() const noexcept { return tree_.number_of_points() - duplicates_; }
  [[nodiscard]] std::uint64_t triangles() const noexcept { return triangles_; }
  [[nodiscard]] std::uint64_t duplicates() const noexcept { return duplicates_; }

 private:
  void add(VerifyReport& report, const char* name, const Findings& findings, const char* what) const {
    Check check{.name = name,
                .passed = findings.failures == 0,
                .failures = findings.failures,
                .first = findings.first,
                .what = {}};
    if (!check.passed) check.what = describe(findings.first) + " " + what;
    report.checks.push_back(std::move(check));
  }
  [[nodiscard]] std::string describe(std::int64_t dense) const {
    const auto node =
        std::upper_bound(base_.begin(), base_.end(), static_cast<std::uint64_t>(dense)) - base_.begin() - 1;
    return "triangle " + std::to_string(static_cast<std::uint64_t>(dense) - base_[static_cast<std::size_t>(node)]) +
           " of " + node_name(static_cast<std::uint32_t>(node));
  }
  [[nodiscard]] static Place place(const NodeArrays& node, std::int32_t v) {
    return {node.xy[2 * static_cast<std::size_t>(v)], node.xy[2 * static_cast<std::size_t>(v) + 1]};
  }
  /// Of the point in the input, from 0 on; number_of_points() if it is none of it.
  [[nodiscard]] std::uint64_t index(std::uint64_t id) const {
    id -= mesh_.first_id();
    return std::min(id, tree_.number_of_points());
  }

  template <class Body>
  void each_triangle(const Body& body) {
    for (std::uint32_t i = 0; i < tree_.size(); ++i) {
      found_.merge(reduce<Triangles>(nodes_[i].number_of_triangles(), options_.threads,
                                     [&](std::size_t t, Triangles& mine) { body(i, t, mine); }));
    }
  }

  void check_range() {
    each_triangle([&](std::uint32_t i, std::size_t t, Triangles& mine) {
      const std::int32_t* v = &nodes_[i].triangles[3 * t];
      const auto n = static_cast<std::int64_t>(nodes_[i].number_of_points());
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0] || std::min({v[0], v[1], v[2]}) < 0 ||
          std::max({v[0], v[1], v[2]}) >= n)
        mine.range.fail(base_[i] + t);
    });
  }

  void check_triangles() {
    each_triangle([&](std::uint32_t i, std::size_t t, Triangles& mine) {
      const NodeArrays& node = nodes_[i];
      const std::int32_t* v = &node.triangles[3 * t];
      const std::uint64_t dense = base_[i] + t;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t at = index(node.ids[static_cast<std::size_t>(v[k])]);
        if (at < used_.size()) used_.set(at);
      }
      if (exact_orientation(place(node, v[0]), place(node, v[1]), place(node, v[2])) <= 0) {
        mine.orientation.fail(dense);
        return;
      }
      for (std::size_t k = 0; k < 3; ++k) check_edge(i, t, k, mine);
    });
    for (std::uint32_t i = 0; i < tree_.size(); ++i) check_rows(i);
  }

  void check_edge(std::uint32_t i, std::size_t t, std::size_t k, Triangles& mine) const {
    const NodeArrays& node = nodes_[i];
    const std::int32_t* v = &node.triangles[3 * t];
    const std::uint64_t from = node.ids[static_cast<std::size_t>(v[next3(k)])],
                        to = node.ids[static_cast<std::size_t>(v[previous3(k)])];
    const std::uint64_t dense = base_[i] + t;
    const std::int32_t n = node.neighbors[3 * t + k];
    const auto is_outside = [&] { mine.boundary.push_back({from, to, place(node, v[next3(k)]), dense}); };
    std::uint32_t j = i;
    std::uint64_t other = 0;
    if (n == -1) return is_outside();
    if (n >= 0) {
      other = static_cast<std::uint64_t>(n);
    } else {
      const auto row = static_cast<std::size_t>(-2 - std::int64_t{n});
      if (row >= node.links.size()) return mine.neighbors.fail(dense);
      if (node.links[row] == outside_hull) return is_outside();
      j = node_of(node.links[row]), other = local_of(node.links[row]);
    }
    if (j >= tree_.size() || other >= nodes_[j].number_of_triangles()) return mine.neighbors.fail(dense);
    const NodeArrays& across = nodes_[j];
    const std::int32_t* w = &across.triangles[3 * other];
    std::size_t m = 0;
    const auto id = [&](std::size_t corner) { return across.ids[static_cast<std::size_t>(w[corner])]; };
    while (m < 3 && !(id(next3(m)) == to && id(previous3(m)) == from)) ++m;
    if (m == 3 || !leads_back(j, across.neighbors[3 * other + m], i, t)) return mine.neighbors.fail(dense);
    if (std::pair(i, std::uint64_t{t}) > std::pair(j, other)) return;
    ++mine.edges;
    const Place a = place(node, v[0]), b = place(node, v[1]), c = place(node, v[2]), d = place(across, w[m]);
    const int side = exact_in_circle(a, b, c, d);
    if (side > 0) mine.delaunay.fail(dense);
    if (side != 0) return;
    ++mine.cocircular;
    if (exact_in_circle_of_tie(a, b, c, d) > 0) mine.ties.fail(dense);
  }

  /// Whether neighbour `n` of a triangle of node j is triangle t of node i.
  [[nodiscard]] bool leads_back(std::uint32_t j, std::int32_t n, std::uint32_t i, std::uint64_t t) const {
    if (n >= 0) return i == j && static_cast<std::uint64_t>(n) == t;
    const auto row = static_cast<std::size_t>(-2 - std::int64_t{n});
    return n != -1 && row < nodes_[j].links.size() && nodes_[j].links[row] == triangle_id(i, t);
  }

  /// Each row of the links belongs to one edge.
  void check_rows(std::uint32_t i) {
    std::vector<bool> told(nodes_[i].links.size());
    for (std::size_t e = 0; e < nodes_[i].neighbors.size(); ++e) {
      const std::int64_t row = -2 - std::int64_t{nodes_[i].neighbors[e]};
      if (row < 0 || static_cast<std::size_t>(row) >= told.size()) continue;
      if (told[static_cast<std::size_t>(row)]) found_.neighbors.fail(base_[i] + e / 3);
      told[static_cast<std::size_t>(row)] = true;
    }
    if (std::find(told.begin(), told.end(), false) != told.end()) found_.neighbors.fail(base_[i]);
  }

  void check_vertices() {
    for (const std::uint32_t i : tree_.leaves()) check_leaf(i);
    for (std::uint32_t i = 0; i < tree_.size(); ++i)
      if (!tree_.node(i).is_leaf()) check_join_points(i);
    for (std::uint64_t p = 0; p < tree_.number_of_points(); ++p)
      if (!seen_.get(p)) points_.fail(p, "is in no leaf");
  }

  void check_leaf(std::uint32_t i) {
    const NodeArrays& node = nodes_[i];
    if (node.number_of_points() != tree_.node(i).points)
      points_.fail(0, "may be missing: " + node_name(i) + " has not as many points as the tree says");
    std::size_t d = 0;
    for (std::size_t p = 0; p < node.number_of_points(); ++p) {
      const std::uint64_t id = node.ids[p], at = index(id);
      const double x = node.xy[2 * p], y = node.xy[2 * p + 1];
      if (at >= seen_.size()) {
        points_.fail(at, "is not one of the input");
        continue;
      }
      if (p != 0 && node.ids[p - 1] >= id) points_.fail(at, "does not follow a lower one");
      if (seen_.get(at)) points_.fail(at, "is there twice");
      seen_.set(at);
      if (!std::isfinite(x) || !std::isfinite(y) || !tree_.node(i).box.contains(x, y))
        points_.fail(at, "is not in the box of its leaf");
      const bool duplicate = d < node.duplicates.size() && node.duplicates[d].point == id;
      if (duplicate) check_duplicate(node, node.duplicates[d++], x, y, at);
      if (triangles_ != 0 && duplicate == used_.get(at))
        points_.fail(at, duplicate ? "is a vertex, though it equals another one" : "is no vertex");
    }
    if (d != node.duplicates.size()) points_.fail(0, "is no duplicate of " + node_name(i) + ", though one is listed");
    duplicates_ += d;
    if (triangles_ == 0) check_collinear(node);
  }

  void check_duplicate(const NodeArrays& node, const DuplicateId& d, double x, double y, std::uint64_t at) {
    const auto found = std::lower_bound(node.ids.begin(), node.ids.end(), d.representative);
    const auto r = static_cast<std::size_t>(found - node.ids.begin());
    if (d.representative >= d.point || found == node.ids.end() || *found != d.representative || node.xy[2 * r] != x ||
        node.xy[2 * r + 1] != y || is_duplicate(node, d.representative))
      points_.fail(at, "does not equal its representative, or that is no vertex");
  }
  static bool is_duplicate(const NodeArrays& node, std::uint64_t id) {
    const auto found = std::lower_bound(node.duplicates.begin(), node.duplicates.end(), id,
                                        [](const DuplicateId& d, std::uint64_t point) { return d.point < point; });
    return found != node.duplicates.end() && found->point == id;
  }

  /// Without triangles all points are on a line.
  void check_collinear(const NodeArrays& node) {
    for (std::size_t p = 0; p < node.number_of_points(); ++p) {
      if (is_duplicate(node, node.ids[p])) continue;
      const Place at{node.xy[2 * p], node.xy[2 * p + 1]};
      if (line_.size() < 2) {
        line_.push_back(at);
      } else if (exact_orientation(line_[0], line_[1], at) != 0) {
        points_.fail(index(node.ids[p]), "is on no line with the others, and there are no triangles");
      }
    }
  }

  /// The points of a join are those of its leaves.
  void check_join_points(std::uint32_t i) {
    const NodeArrays& node = nodes_[i];
    for (std::size_t p = 0; p < node.number_of_points(); ++p) {
      const double x = node.xy[2 * p], y = node.xy[2 * p + 1];
      const NodeArrays& leaf = nodes_[tree_.leaf_of(x, y)];
      const auto found = std::lower_bound(leaf.ids.begin(), leaf.ids.end(), node.ids[p]);
      const auto r = static_cast<std::size_t>(found - leaf.ids.begin());
      if (found == leaf.ids.end() || *found != node.ids[p] || leaf.xy[2 * r] != x || leaf.xy[2 * r + 1] != y)
        points_.fail(index(node.ids[p]), "of " + node_name(i) + " is not that of its leaf");
    }
  }

  void check_boundary(VerifyReport& report, bool sound) {
    report.hull_vertices = found_.boundary.size();
    const HullOutcome outcome =
        sound ? check_hull(std::move(found_.boundary)) : HullOutcome{"not examined", "not examined"};
    report.checks.push_back(
        {"boundary", outcome.boundary.empty(), outcome.boundary.empty() ? 0U : 1U, -1, outcome.boundary});
    report.checks.push_back({"hull", outcome.hull.empty(), outcome.hull.empty() ? 0U : 1U, -1, outcome.hull});
  }

  void check_euler(VerifyReport& report) const {
    const std::uint64_t expected = triangles_ == 0 ? 0 : 2 * distinct() - 2 - report.hull_vertices;
    Check check{.name = "euler",
                .passed = triangles_ == expected,
                .failures = triangles_ == expected ? 0U : 1U,
                .first = -1,
                .what = {}};
    if (!check.passed) {
      check.what = std::to_string(triangles_) + " triangles, and " + std::to_string(distinct()) + " vertices with " +
                   std::to_string(report.hull_vertices) + " on the hull make " + std::to_string(expected);
    }
    report.checks.push_back(std::move(check));
  }

  const NodeMesh& mesh_;
  const TileTree& tree_;
  const VerifyOptions& options_;
  std::vector<NodeArrays> nodes_;
  std::vector<std::uint64_t> base_;
  std::uint64_t triangles_ = 0, duplicates_ = 0;
  Bits used_, seen_;
  Triangles found_;
  PointFindings points_;
  std::vector<Place> line_;
};

void conclude(VerifyReport& report) {
  report.ok = std::all_of(report.checks.begin(), report.checks.end(), [](const Check& c) { return c.passed; });
}

Check check_files(const MeshDirectory& mesh) {
  Check check{.name = "files", .passed = true, .failures = 0, .first = -1, .what = {}};
  for (const NodeRecord& node : mesh.manifest().nodes) {
    for (const FileRecord& file : node.files) {
      const std::string what = difference(mesh.path() + "/" + file.name, file);
      if (what.empty()) continue;
      if (check.failures++ == 0) check.what = mesh.path() + "/" + file.name + " " + what;
    }
  }
  check.passed = check.failures == 0;
  return check;
}

/// What the manifest claims.
Check check_manifest(const MeshDirectory& mesh, const Verification& found, const VerifyReport& report) {
  const NodeSums& whole = mesh.manifest().whole;
  std::uint64_t base = 0;
  std::string what;
  // Else indices must not be followed.
  const bool sound = std::ranges::all_of(report.checks, [](const Check& check) { return check.passed; });
  const auto compare = [&](const char* of, std::uint64_t claimed, std::uint64_t counted) {
    if (claimed != counted && what.empty()) {
      what = "the manifest says " + std::to_string(claimed) + " " + of + ", and there are " + std::to_string(counted);
    }
  };
  compare("points", whole.points, mesh.tree().number_of_points());
  compare("distinct points", whole.distinct, found.distinct());
  compare("triangles", whole.triangles, found.triangles());
  compare("hull edges", whole.hull_edges, report.hull_vertices);
  compare("open vertices of the whole mesh", mesh.manifest().nodes.back().open, 0);
  for (std::uint32_t i = 0; i < mesh.tree().size(); ++i) {
    const NodeArrays node = mesh.node(i);
    compare("triangles in a node", mesh.manifest().nodes[i].triangles, node.number_of_triangles());
    compare("points in a node", mesh.manifest().nodes[i].points, node.number_of_points());
    compare("triangles before a node", mesh.manifest().base[i], base);
    compare("links of a node", mesh.manifest().nodes[i].links, node.links.size());
    compare("duplicates in a node", mesh.manifest().nodes[i].duplicates, node.duplicates.size());
    if (const TreeNode& at = mesh.tree().node(i); !at.is_leaf()) {  // its points are what is open in its children
      const std::vector<NodeRecord>& nodes = mesh.manifest().nodes;
      compare("open vertices below a join", nodes[at.left].open + nodes[at.right].open, node.number_of_points());
    }
    base += node.number_of_triangles();
    // Those of all nodes are what it says of the mesh (read_manifest).
    if (sound && what.empty() &&
        hash_of(node.ids, node.triangles, node.duplicates) != mesh.manifest().nodes[i].sums.hash)
      what = "the manifest's hash of " + node_name(i) + " is not that of its triangles and duplicates";
  }
  return {"manifest", what.empty(), what.empty() ? 0U : 1U, -1, what};
}

}  // namespace

VerifyReport verify(const NodeMesh& mesh, const VerifyOptions& options) {
  VerifyReport report;
  Verification(mesh, options)(report);
  conclude(report);
  return report;
}

VerifyReport verify(const MeshDirectory& mesh, const VerifyOptions& options) {
  VerifyReport report;
  report.checks.push_back(check_files(mesh));
  report.ok = false;
  if (!report.checks.front().passed) return report;
  Verification found(mesh, options);
  found(report);
  report.checks.push_back(check_manifest(mesh, found, report));
  conclude(report);
  return report;
}

}  // namespace cadt::tiles
