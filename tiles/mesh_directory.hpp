// SPDX-License-Identifier: Apache-2.0
// Reading a mesh in nodes: from its directory, or from nodes in memory.
#pragma once

#include "tiles/node.hpp"
#include "tiles/store.hpp"

#include <cadt/stop_token.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/verify.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cadt::tiles {

/// The arrays of a node, as in NodeData, with complete links.
struct NodeArrays {
  std::span<const double> xy;
  std::span<const std::uint64_t> ids;
  std::span<const std::int32_t> triangles, neighbors;
  std::span<const TriangleId> links;
  std::span<const DuplicateId> duplicates;
  std::shared_ptr<const void> owner;  ///< keeps the arrays of a directory mapped
  [[nodiscard]] std::size_t number_of_points() const noexcept { return ids.size(); }
  [[nodiscard]] std::size_t number_of_triangles() const noexcept { return triangles.size() / 3; }
};

/// A mesh in nodes. Thread-safe.
class NodeMesh {
 public:
  virtual ~NodeMesh() = default;
  [[nodiscard]] virtual const TileTree& tree() const noexcept = 0;
  [[nodiscard]] virtual std::uint64_t first_id() const noexcept = 0;
  /// \throws io::FileError for files that are damaged, of a directory
  [[nodiscard]] virtual NodeArrays node(std::uint32_t i) const = 0;
};

/// A directory, whose arrays are mapped: pages are read as they are used.
class MeshDirectory : public NodeMesh {
 public:
  /// \throws io::FileError for what is missing, malformed or not complete (names the file)
  explicit MeshDirectory(const std::string& path);
  ~MeshDirectory() override;
  [[nodiscard]] const std::string& path() const noexcept;
  [[nodiscard]] const Manifest& manifest() const noexcept;
  [[nodiscard]] const TileTree& tree() const noexcept override;
  [[nodiscard]] std::uint64_t first_id() const noexcept override;
  [[nodiscard]] NodeArrays node(std::uint32_t i) const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};
[[nodiscard]] bool is_mesh_directory(const std::string& path);

/// Nodes in memory (RunOptions::collect); links are completed from the messages.
class CollectedMesh : public NodeMesh {
 public:
  CollectedMesh(TileTree tree, std::vector<NodeData> nodes, std::uint64_t first_id = 0);
  [[nodiscard]] const TileTree& tree() const noexcept override { return tree_; }
  [[nodiscard]] std::uint64_t first_id() const noexcept override { return first_id_; }
  [[nodiscard]] NodeArrays node(std::uint32_t i) const override;

 private:
  TileTree tree_;
  std::vector<NodeData> nodes_;
  std::uint64_t first_id_;
};

/// One mesh, with its points, in canonical order: the same arrays as those of one call.
struct MergedMesh {
  std::vector<double> xy;  ///< of all input points, x0 y0 x1 y1 ...
  std::vector<std::int32_t> triangles, neighbors, hull;
  std::vector<Duplicate> duplicates;
};
/// \throws LimitError if there are more points than 32-bit indices take; InvalidMesh for a mesh that contradicts itself
[[nodiscard]] MergedMesh merge(const NodeMesh& mesh);

/// Checks everything again, exactly and without believing the builder: hashes of the files, structure, orientation,
/// the empty circle of each edge, also between nodes, one convex hull, Euler's formula, every input point once. Memory:
/// two bits an input point. \throws io::FileError for what cannot be read
[[nodiscard]] VerifyReport verify(const MeshDirectory& mesh, const VerifyOptions& options = {});
[[nodiscard]] VerifyReport verify(const NodeMesh& mesh, const VerifyOptions& options = {});

/// Pieces of a node each, with GlobalNodeIds, and mesh.pvtu, in a new folder. \throws io::FileError, Cancelled between
/// two pieces
void export_pvtu(const NodeMesh& mesh, const std::string& folder, const cadt::stop_token& stop = {});
/// A .ply file for each node that has triangles. \throws io::FileError, Cancelled between two files
void export_ply(const NodeMesh& mesh, const std::string& folder, const cadt::stop_token& stop = {});

}  // namespace cadt::tiles
