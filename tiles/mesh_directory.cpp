// SPDX-License-Identifier: Apache-2.0
#include "tiles/mesh_directory.hpp"

#include <cadt/io/errors.hpp>

#include "tiles/files.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace cadt::tiles {
namespace {

static_assert(sizeof(DuplicateId) == 2 * sizeof(std::uint64_t));

/// The files of a node.
struct NodeFiles {
  MappedFile points, ids, triangles, neighbors, links, duplicates;
  explicit NodeFiles(const std::string& folder)
      : points(folder + "/points.npy"),
        ids(folder + "/ids.npy"),
        triangles(folder + "/triangles.npy"),
        neighbors(folder + "/neighbors.npy"),
        links(folder + "/links.npy"),
        duplicates(folder + "/duplicates.npy") {}
};

}  // namespace

struct MeshDirectory::Data {
  std::string path;
  Manifest manifest;
};

MeshDirectory::MeshDirectory(const std::string& path) : data_(std::make_unique<Data>()) {
  data_->path = path;
  while (data_->path.size() > 1 && data_->path.back() == '/') data_->path.pop_back();
  data_->manifest = read_manifest(data_->path);
  if (!data_->manifest.complete)
    throw io::FileError(path, 0, "the mesh is not complete; continue it with: cadt tiles --resume");
}
MeshDirectory::~MeshDirectory() = default;

const std::string& MeshDirectory::path() const noexcept { return data_->path; }
const Manifest& MeshDirectory::manifest() const noexcept { return data_->manifest; }
const TileTree& MeshDirectory::tree() const noexcept { return data_->manifest.plan.tree; }
std::uint64_t MeshDirectory::first_id() const noexcept { return data_->manifest.plan.first_id; }

NodeArrays MeshDirectory::node(std::uint32_t i) const {
  const std::string folder = data_->path + "/" + node_name(i);
  const auto files = std::make_shared<NodeFiles>(folder);
  NodeArrays arrays;
  arrays.xy = numbers_of<double>(files->points, folder + "/points.npy", "<f8", 2);
  arrays.ids = numbers_of<std::uint64_t>(files->ids, folder + "/ids.npy", "<u8", 1);
  arrays.triangles = numbers_of<std::int32_t>(files->triangles, folder + "/triangles.npy", "<i4", 3);
  arrays.neighbors = numbers_of<std::int32_t>(files->neighbors, folder + "/neighbors.npy", "<i4", 3);
  arrays.links = numbers_of<std::uint64_t>(files->links, folder + "/links.npy", "<u8", 1);
  const auto duplicates = numbers_of<std::uint64_t>(files->duplicates, folder + "/duplicates.npy", "<u8", 2);
  arrays.duplicates = {reinterpret_cast<const DuplicateId*>(duplicates.data()), duplicates.size() / 2};
  if (arrays.xy.size() != 2 * arrays.ids.size())
    throw io::FileError(folder + "/ids.npy", 0, "has not as many rows as points.npy");
  if (arrays.neighbors.size() != arrays.triangles.size())
    throw io::FileError(folder + "/neighbors.npy", 0, "has not as many rows as triangles.npy");
  arrays.owner = files;
  return arrays;
}

bool is_mesh_directory(const std::string& path) {
  std::error_code code;
  return std::filesystem::is_regular_file(path + "/manifest.json", code);
}

CollectedMesh::CollectedMesh(TileTree tree, std::vector<NodeData> nodes, std::uint64_t first_id)
    : tree_(std::move(tree)), nodes_(std::move(nodes)), first_id_(first_id) {
  std::sort(nodes_.begin(), nodes_.end(), [](const NodeData& a, const NodeData& b) { return a.node < b.node; });
  if (nodes_.size() != tree_.size()) throw Error("a mesh needs all nodes of its tree");
  std::vector<Link> messages;
  for (const NodeData& node : nodes_) messages.insert(messages.end(), node.messages.begin(), node.messages.end());
  complete_links(std::move(messages), tree_.size(), [&](std::uint32_t node, std::span<const Link> of_node) {
    apply_messages(node, of_node, nodes_[node].links);
  });
}

NodeArrays CollectedMesh::node(std::uint32_t i) const {
  const NodeData& node = nodes_[i];
  return {.xy = node.xy,
          .ids = node.ids,
          .triangles = node.triangles,
          .neighbors = node.neighbors,
          .links = node.links,
          .duplicates = node.duplicates,
          .owner = {}};
}

}  // namespace cadt::tiles
