// SPDX-License-Identifier: Apache-2.0
// The step that leaves and joins share: from the mesh of a node's points to its final triangles.
#pragma once

#include <cadt/finalization.hpp>

#include <cstdint>
#include <vector>

#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/bounds.hpp"

namespace cadt {

struct DevicePart::Data {
  std::shared_ptr<Triangulator::State> state;  // first member: destroyed last, after the memory
  Allocation points, ids;
  std::size_t point_count = 0, triangle_count = 0;
  Allocation triangles, neighbors;  ///< null if there are no triangles
};

namespace finalization {

inline constexpr std::size_t id_bytes = sizeof(std::uint64_t);

/// What the children of a join cover (common/finalization/join.dev.h). All null for a leaf.
struct Cover {
  Allocation half_edges, covers, kept;
};

/// A node whose points are triangulated.
struct Node {
  std::uint32_t number = 0;
  TileBox box;
  bool is_root = false;
  std::unique_ptr<DevicePart::Data> data;
  std::unique_ptr<DeviceTriangulation::Data> mesh;
  Bounds bounds;
  Cover cover;

  [[nodiscard]] DeviceMeshView view() const;
};

/// An edge of a final triangle with a row of links, in the order of rows (CADT_ROW_WORDS).
struct Row {
  std::uint32_t from, to, triangle, cover;
  Row() noexcept {}  // NOLINT: many are read from the device, and not zeroed before
};

/// The final part of a node, with what is known of it without its children.
struct Finished {
  FinishedNode node;  ///< its open vertices, no sides yet
  std::vector<Row> rows;
  std::vector<double> apexes;  ///< of the rows: x0 y0 x1 y1 ...; none at the root, where nothing goes up
  Allocation places;           ///< numbers of final triangles: the scan of 1 for each; null without triangles
  Allocation ranks;            ///< numbers of open vertices, as a scan; null at the root and without triangles
};

/// Of the fractions that are reported: the mesh of a node is there at 0.8.
inline constexpr double share_of_mesh = 0.8;

/// One call: its options, statistics and context.
struct Call {
  /// `done`: what part of the node's work is behind it, 0 or share_of_mesh.
  Call(Triangulator::State& state, std::size_t points, double done);
  Statistics statistics;
  Context ctx;
};

/// \throws LimitError, BackendUnavailable
[[nodiscard]] Node open_node(Triangulator& triangulator, std::size_t points, const TileBox& box, std::uint32_t number);
/// \throws InputError if these ids of 64 bits do not ascend
void require_ascending(Context& ctx, const Allocation& ids, std::size_t count);
/// Triangulates the points of a node. \throws as finish_leaf
void triangulate_node(Node& node);
/// Takes the final triangles out of the mesh.
[[nodiscard]] Finished take_final(Call& call, Node& node);
/// What goes to the parent of a row that is one of an edge between open vertices. \throws InternalError if it is not
[[nodiscard]] OpenSide side_of(const Finished& finished, const Node& node, std::size_t row);
/// Waits for the device, and adds the sums of a node and its statistics.
void add_sums(Call& call, Finished& finished, const Node& node, std::size_t covered_hull_edges,
              std::uint64_t certified_links);

}  // namespace finalization
}  // namespace cadt
