// SPDX-License-Identifier: Apache-2.0
// Archives of NumPy arrays with the names that SciPy's Delaunay gives them: .npz
#include "io/mesh/mesh_parts.hpp"
#include "io/support/byte_reader.hpp"
#include "io/support/npy_format.hpp"
#include "io/support/zip_archive.hpp"

namespace cadt::io::detail {
namespace {

template <class T>
void add_array(ZipWriter& zip, const char* name, std::string_view descr, const std::vector<std::size_t>& shape,
               std::span<const T> data) {
  static_assert(std::endian::native == std::endian::little, "the binary writers copy numbers as they are in memory");
  const std::string header = npy_header(descr, shape);
  const std::string_view parts[] = {header, {reinterpret_cast<const char*>(data.data()), data.size_bytes()}};
  zip.add(std::string(name) + ".npy", parts);
}

/// The boundary as edges (h x 2), in the order of the loop.
std::vector<std::int32_t> loop_edges(std::span<const std::int32_t> loop) {
  std::vector<std::int32_t> edges;
  edges.reserve(2 * loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    edges.push_back(loop[i]);
    edges.push_back(loop[i + 1 < loop.size() ? i + 1 : 0]);
  }
  return edges;
}

/// An n x 3 array of integers.
class IndexMatrix {
 public:
  IndexMatrix(const InputFile& file, const ZipReader& zip, const char* key)
      : name_(file.name()),
        key_(key),
        member_(zip.read(std::string(key) + ".npy")),
        array_(parse_npy(name_, member_.content, member_.offset)) {
    const bool signed_integers = array_.kind == 'i' && (array_.item_size == 4 || array_.item_size == 8);
    if (!signed_integers) fail("must hold int32 or int64");
    if (array_.shape.size() != 2 || array_.shape[1] != corners_of_triangle) fail("must have the shape (n, 3)");
  }
  [[nodiscard]] std::size_t rows() const noexcept { return array_.data.empty() ? 0 : array_.shape[0]; }
  [[nodiscard]] std::int64_t at(std::size_t row, std::size_t column) const {
    const char* bytes = array_.data.data() + array_.item(row, column);
    return array_.item_size == 4 ? load<std::int32_t>(bytes, array_.big_endian)
                                 : load<std::int64_t>(bytes, array_.big_endian);
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(name_, 0, "array '" + std::string(key_) + "' " + message);
  }

 private:
  const std::string& name_;
  const char* key_;
  ZipReader::Member member_;
  NpyArray array_;
};

}  // namespace

void write_npz(AtomicFile& out, const MeshParts& mesh) {
  ZipWriter zip(out);
  const std::size_t points = mesh.xy.size() / 2;
  add_array(zip, "points", "<f8", {points, 2}, mesh.xy);
  if (!mesh.height.empty()) add_array(zip, "height", "<f8", {points}, mesh.height);
  add_array(zip, "simplices", "<i4", {mesh.triangles.size() / 3, 3}, mesh.triangles);
  add_array(zip, "neighbors", "<i4", {mesh.neighbors.size() / 3, 3}, mesh.neighbors);
  add_array(zip, "hull", "<i4", {mesh.hull.size()}, mesh.hull);
  const std::vector<std::int32_t> edges = loop_edges(mesh.hull);
  add_array(zip, "convex_hull", "<i4", {mesh.hull.size(), 2}, std::span<const std::int32_t>(edges));
  static_assert(sizeof(Duplicate) == 2 * sizeof(std::int32_t), "a duplicate is a row of two int32");
  add_array(zip, "duplicates", "<i4", {mesh.duplicates.size(), 2}, mesh.duplicates);
  zip.finish();
}

MeshFile read_npz(const InputFile& file, std::size_t points) {
  const ZipReader zip(file);
  const IndexMatrix simplices(file, zip, "simplices");
  TriangleCollector triangles(points, 0);
  triangles.reserve(simplices.rows());
  for (std::size_t i = 0; i < simplices.rows(); ++i) {
    for (std::size_t k = 0; k < corners_of_triangle; ++k) {
      if (!triangles.add(simplices.at(i, k)))
        simplices.fail("row " + std::to_string(i) + ": " + triangles.refusal(simplices.at(i, k)));
    }
  }
  MeshFile mesh{triangles.take(), {}};
  if (!zip.contains("neighbors.npy")) return mesh;
  const IndexMatrix neighbors(file, zip, "neighbors");
  if (neighbors.rows() != simplices.rows()) neighbors.fail("has another number of rows than 'simplices'");
  mesh.neighbors.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < neighbors.rows(); ++i) {
    for (std::size_t k = 0; k < corners_of_triangle; ++k) {
      const std::int64_t value = neighbors.at(i, k);
      if (value < -1 || value >= static_cast<std::int64_t>(neighbors.rows())) {
        neighbors.fail("row " + std::to_string(i) + ": triangle " + std::to_string(value) + " does not exist");
      }
      mesh.neighbors.push_back(static_cast<std::int32_t>(value));
    }
  }
  return mesh;
}

}  // namespace cadt::io::detail
