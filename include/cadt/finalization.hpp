// SPDX-License-Identifier: Apache-2.0
// One mesh of more points than a device or a memory takes: each tile of the plane is triangulated alone, what is final
// leaves for good, and the few vertices that are still open go up a tree of boxes (docs/scale.md).
#pragma once

#include <cadt/export.hpp>
#include <cadt/points.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/triangulator.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace cadt {

/// A tile of the plane: the points with min_x <= x < max_x and min_y <= y < max_y. By default the whole plane.
struct CADT_API TileBox {
  double min_x = -std::numeric_limits<double>::infinity(), min_y = -std::numeric_limits<double>::infinity();
  double max_x = std::numeric_limits<double>::infinity(), max_y = std::numeric_limits<double>::infinity();
  /// Whether nothing lies outside: the box of the root.
  [[nodiscard]] bool is_plane() const noexcept;
  [[nodiscard]] bool contains(double x, double y) const noexcept {
    return min_x <= x && x < max_x && min_y <= y && y < max_y;
  }
  friend bool operator==(const TileBox&, const TileBox&) = default;
};

/// A triangle of the whole mesh: the node of the tree that made it final, and its number there.
using TriangleId = std::uint64_t;
/// Outside of the convex hull of all points.
inline constexpr TriangleId outside_hull = ~std::uint64_t{0};
/// Not known yet: a later node will tell.
inline constexpr TriangleId pending_triangle = ~std::uint64_t{0} - 1;
inline constexpr unsigned node_bits = 24, local_bits = 40;
[[nodiscard]] constexpr TriangleId triangle_id(std::uint32_t node, std::uint64_t local) noexcept {
  return std::uint64_t{node} << local_bits | local;
}
[[nodiscard]] constexpr std::uint32_t node_of(TriangleId id) noexcept {
  return static_cast<std::uint32_t>(id >> local_bits);
}
[[nodiscard]] constexpr std::uint64_t local_of(TriangleId id) noexcept {
  return id & ((std::uint64_t{1} << local_bits) - 1);
}

/// An edge between open vertices with a final triangle on one side alone.
struct OpenSide {
  std::uint32_t from = 0, to = 0;  ///< indices of Open::ids; the final triangle is on the left of the line between them
  double apex_x = 0, apex_y = 0;   ///< the third vertex of that triangle
  TriangleId triangle = 0;
  std::uint32_t row = 0;  ///< of the links of its node: what lies across is written there
  friend bool operator==(const OpenSide&, const OpenSide&) = default;
};

/// What a node passes to its parent.
struct Open {
  std::vector<double> xy;          ///< of the open vertices: x0 y0 x1 y1 ...
  std::vector<std::uint64_t> ids;  ///< input indices, ascending
  std::vector<OpenSide> sides;
};

/// What lies across an edge of an earlier node: links[row] of node_of(triangle) becomes `across`.
struct Link {
  TriangleId triangle = 0;
  std::uint32_t row = 0;
  TriangleId across = 0;
  friend bool operator==(const Link&, const Link&) = default;
};

/// Input indices of equal points: the representative is the lowest, and the vertex.
struct DuplicateId {
  std::uint64_t point = 0, representative = 0;
  friend bool operator==(const DuplicateId&, const DuplicateId&) = default;
};

/// The final triangles of a node in the memory of the host.
struct Part {
  std::vector<std::int32_t> triangles;  ///< n x 3, indices of the node's points, counterclockwise
  /// n x 3; the k-th is opposite vertex k: a triangle of the same part, -1 outside of the hull, or -2 - k: what
  /// links[k] says.
  std::vector<std::int32_t> neighbors;
};

/// The final triangles of a node in device memory. Handles as those of a DeviceTriangulation, with the same lifetime;
/// they may outlive the call, but hold device memory.
class CADT_API DevicePart {
 public:
  DevicePart();
  ~DevicePart();
  DevicePart(DevicePart&&) noexcept;
  DevicePart& operator=(DevicePart&&) noexcept;

  /// Points of the node: of the leaf, or the open vertices of its children in the order of their ids.
  [[nodiscard]] std::size_t number_of_points() const noexcept;
  [[nodiscard]] std::size_t number_of_triangles() const noexcept;
  /// Handles of number_of_triangles() x 3 words, as Part; null if there are none.
  [[nodiscard]] void* triangles() const noexcept;
  [[nodiscard]] void* neighbors() const noexcept;
  /// Handle of number_of_points() x 2 doubles.
  [[nodiscard]] void* points() const noexcept;
  /// Handle of number_of_points() input indices of 64 bits.
  [[nodiscard]] void* ids() const noexcept;
  /// The hash of the triangles by input indices, as Triangulation::hash adds them up: NodeSums::hash. Waits for the
  /// device.
  [[nodiscard]] Hash128 hash() const;
  /// Waits for the device. O(triangles). \throws DeviceError
  [[nodiscard]] Part download() const;
  /// The same into the caller's memory, number_of_triangles() x 3 each. \throws std::invalid_argument for other sizes,
  /// DeviceError
  void download(std::span<std::int32_t> triangles, std::span<std::int32_t> neighbors) const;

  struct Data;  // internal
  explicit DevicePart(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// What the nodes say of the whole mesh, to be added up in any order.
struct CADT_API NodeSums {
  std::uint64_t points = 0, distinct = 0;  ///< of leaves
  std::uint64_t triangles = 0;             ///< final ones
  std::uint64_t hull_edges = 0;            ///< of the hull of all points: known at the root alone
  std::uint64_t certified_edges = 0;       ///< whose circles were examined, each once in all nodes
  int dimension = -1;                      ///< of all points so far, as Triangulation::dimension
  Hash128 hash;                            ///< of triangles and duplicates; 0 until DevicePart::hash was added
  NodeSums& operator+=(const NodeSums& other) noexcept;
  friend bool operator==(const NodeSums&, const NodeSums&) = default;
};

/// The certificate of the whole mesh: it has 2 * distinct - 2 - hull triangles, and each of its edges was examined
/// once. \throws InternalError if the sums over all nodes are not what they must be
CADT_API void require_complete(const NodeSums& whole);
/// Triangulation::hash of the mesh of all points in one call, from the sums over all nodes.
[[nodiscard]] CADT_API Hash128 hash_of(const NodeSums& whole) noexcept;
/// NodeSums::hash of a node, from its arrays: input indices of its points, triangles as in Part, and duplicates. O(n).
/// \throws std::invalid_argument if the triangles have not three points each, or one that has no input index
[[nodiscard]] CADT_API Hash128 hash_of(std::span<const std::uint64_t> ids, std::span<const std::int32_t> triangles,
                                       std::span<const DuplicateId> duplicates);

/// What a node of the tree gives.
struct CADT_API FinishedNode {
  DevicePart part;
  Open open;                            ///< for the parent; empty at the root
  std::vector<TriangleId> links;        ///< of the part (Part::neighbors); pending_triangle where a later node tells
  std::vector<Link> messages;           ///< to the links of earlier nodes
  std::vector<DuplicateId> duplicates;  ///< of a leaf, by point, ascending
  NodeSums sums;                        ///< its hash is that of the duplicates; add part.hash()
  Statistics statistics;                ///< of the triangulation
};

/// Where the input indices of the points of a leaf are.
struct DeviceIds {
  const void* memory =
      nullptr;  ///< on the device of the points, 64 bits each, ascending; null: `first`, `first` + 1, ...
  std::uint64_t first = 0;
};

/// A leaf: triangulates the points of a tile alone. A triangle whose closed circumscribed disc lies in the box by a
/// one-sided bound is certain: no point outside of the box can change it. A vertex is open if a triangle at it is not
/// certain, if it is on the hull, or if there are no triangles; triangles with a vertex that is not open are final.
/// Points of equal coordinates must be in one leaf.
///
/// `ids`: input indices of the points, ascending; `node`: number of the node, below 2^24. Cost: that of the
/// triangulation and about a tenth. Uses the triangulator as a call of its own would (thread-safety, options, device),
/// and about 135 bytes of device memory a point in all, which are asked for step by step (Options::max_memory); on the
/// host points and ids are not copied, and must outlive the part. \throws as Triangulator::triangulate
/// (InputError::index is the index within `points`), InputError for ids that do not ascend or a point outside of the
/// box, BackendUnavailable for a device without double precision
[[nodiscard]] CADT_API FinishedNode finish_leaf(Triangulator& triangulator, PointsView points,
                                                std::span<const std::uint64_t> ids, const TileBox& box,
                                                std::uint32_t node);
/// The same with points in device memory. Doubles alone.
[[nodiscard]] CADT_API FinishedNode finish_leaf(Triangulator& triangulator, const DevicePoints& points,
                                                const DeviceIds& ids, const TileBox& box, std::uint32_t node);

/// A join: triangulates what is open in the children, drops what their final triangles cover, and finishes what is
/// certain in the box, which is the union of theirs. Any number of children in any order. At the root (the box is the
/// plane) everything is final. Each side of a final triangle is matched with what lies across, whose circle is examined
/// exactly. O(m log m) for m open vertices. \throws as finish_leaf; LimitError for more than max_points() open
/// vertices; InternalError if children contradict each other
[[nodiscard]] CADT_API FinishedNode finish_join(Triangulator& triangulator, std::span<const Open> children,
                                                const TileBox& box, std::uint32_t node);

}  // namespace cadt
