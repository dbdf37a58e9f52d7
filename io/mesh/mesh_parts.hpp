// SPDX-License-Identifier: Apache-2.0
// What the mesh writers need of a mesh, independent of its source.
#pragma once

#include "io/support/atomic_file.hpp"
#include "io/support/input_file.hpp"

#include <cadt/io/mesh_file.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cadt::io::detail {

/// Views of arrays in the layout of Triangulation.
struct MeshParts {
  std::span<const double> xy;
  std::span<const double> height;  ///< empty or one a point
  std::span<const std::int32_t> triangles, neighbors, hull;
  std::span<const Duplicate> duplicates;
  std::span<const std::uint64_t> global_ids = {};  ///< of the points, for pieces of a larger mesh: vtu alone
  std::span<const std::int32_t> region = {};       ///< one a triangle: ele, ply, vtu
  std::string region_name = {};                    ///< what ply and vtu call it
};

/// write_mesh for all formats but pictures.
void write_mesh_parts(const std::string& path, const MeshParts& mesh, const WriteOptions& options);

/// The format in which a mesh is written: WriteOptions::format or the suffix. Throws FileError.
[[nodiscard]] std::string mesh_write_format(const std::string& path, const WriteOptions& options);

/// `attributes`: one a triangle if it is `attributed`, else none.
void write_ele(AtomicFile& out, std::span<const std::int32_t> triangles, int base, bool attributed,
               std::span<const double> attributes);
void write_neigh(AtomicFile& out, std::span<const std::int32_t> neighbors, int base);
void write_obj(AtomicFile& out, const MeshParts& mesh);
void write_off(AtomicFile& out, const MeshParts& mesh);
void write_ply(AtomicFile& out, const MeshParts& mesh, bool ascii);
void write_vtu(AtomicFile& out, const MeshParts& mesh);
/// Rows of text: x, y and the height, or 0, behind `prefix`.
void write_vertex_rows(AtomicFile& out, const MeshParts& mesh, std::string_view prefix);
/// The three corners of a triangle as text, each behind a space. Returns the end.
[[nodiscard]] char* put_corners(char* at, const std::int32_t* corners, std::int64_t base);
void write_glb(AtomicFile& out, const std::string& path, const MeshParts& mesh);
void write_npz(AtomicFile& out, const MeshParts& mesh);

/// Checks indices as they are read and collects them.
class TriangleCollector {
 public:
  /// Indices run from `base` to base + points - 1.
  TriangleCollector(std::size_t points, std::int64_t base) : points_(static_cast<std::int64_t>(points)), base_(base) {}
  void reserve(std::size_t triangles) { indices_.reserve(3 * triangles); }
  /// False if the index is out of range.
  [[nodiscard]] bool add(std::int64_t index) {
    index -= base_;
    if (index < 0 || index >= points_) return false;
    indices_.push_back(static_cast<std::int32_t>(index));
    return true;
  }
  /// Text for an index that `add` refused.
  [[nodiscard]] std::string refusal(std::int64_t index) const;
  [[nodiscard]] std::vector<std::int32_t> take() { return std::move(indices_); }

 private:
  std::int64_t points_, base_;
  std::vector<std::int32_t> indices_;
};

/// Required number of vertices of a face, and the message for any other.
inline constexpr std::size_t corners_of_triangle = 3;
[[nodiscard]] std::string not_a_triangle(std::size_t corners);

[[nodiscard]] MeshFile read_ele(const InputFile& file, const std::string& path, std::size_t points, int base);
[[nodiscard]] MeshFile read_obj_mesh(const InputFile& file, std::size_t points);
[[nodiscard]] MeshFile read_off_mesh(const InputFile& file, std::size_t points);
[[nodiscard]] MeshFile read_ply_mesh(const InputFile& file, std::size_t points);
[[nodiscard]] MeshFile read_vtu(const InputFile& file, std::size_t points);
[[nodiscard]] MeshFile read_npz(const InputFile& file, std::size_t points);

}  // namespace cadt::io::detail
