// SPDX-License-Identifier: Apache-2.0
// One reader and one writer a format, behind read_points and write_points.
#pragma once

#include "io/support/atomic_file.hpp"
#include "io/support/input_file.hpp"
#include "io/support/text_scanner.hpp"

#include <cadt/io/points_file.hpp>
#include <cadt/io/triangle_files.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace cadt::io::detail {

/// Takes points as they are read and projects those with three coordinates.
class PointCollector {
 public:
  /// Throws FileError when a projection other than xy is asked for and there is no third coordinate.
  PointCollector(const std::string& name, Projection projection, bool three_coordinates)
      : projection_(projection), three_(three_coordinates) {
    if (!three_ && projection != Projection::xy) {
      throw FileError(name, 0, "a projection to yz or zx needs three coordinates, the file has two");
    }
  }
  /// `points` must be bounded by the size of the file.
  void reserve(std::size_t points) {
    set_.xy.reserve(2 * points);
    if (three_) set_.height.reserve(points);
  }
  /// z is ignored unless the file has three coordinates.
  void add(double x, double y, double z) {
    if (three_) {
      if (projection_ == Projection::yz) {
        std::swap(x, y), std::swap(y, z);  // plane (y, z), height x
      } else if (projection_ == Projection::zx) {
        std::swap(x, z), std::swap(y, z);  // plane (z, x), height y
      }
      set_.height.push_back(z);
    }
    set_.xy.push_back(x);
    set_.xy.push_back(y);
  }
  [[nodiscard]] std::size_t size() const noexcept { return set_.size(); }
  [[nodiscard]] PointSet take() { return std::move(set_); }

 private:
  PointSet set_;
  Projection projection_;
  bool three_;
};

[[nodiscard]] PointSet read_table(const InputFile& file, const ReadOptions& options);
[[nodiscard]] PointSet read_node(const InputFile& file, const ReadOptions& options);
[[nodiscard]] PointSet read_ply_points(const InputFile& file, const ReadOptions& options);
[[nodiscard]] PointSet read_obj_points(const InputFile& file, const ReadOptions& options);
[[nodiscard]] PointSet read_off_points(const InputFile& file, const ReadOptions& options);
[[nodiscard]] PointSet read_npy(const InputFile& file, const ReadOptions& options);
/// Interleaved little-endian floats of `bytes` (4 or 8) each.
[[nodiscard]] PointSet read_raw(const InputFile& file, const ReadOptions& options, std::size_t bytes);

/// The header and the points of a .node or .poly file, of which there may be none.
[[nodiscard]] NodeFile read_node_section(TextScanner& scanner);
/// The next word as a boundary marker.
[[nodiscard]] std::int32_t read_marker(TextScanner& scanner);

/// The columns of a .node file but the index.
struct NodeColumns {
  std::span<const double> xy, attributes;
  std::size_t attributes_per_point = 0;
  std::span<const int> markers = {};
  bool has_markers = false;
};
/// Heights, if there are any, are the only attribute.
[[nodiscard]] inline NodeColumns node_columns(std::span<const double> xy, std::span<const double> height) {
  return {xy, height, height.empty() ? std::size_t{0} : std::size_t{1}};
}

/// Writers take coordinates as spans so that meshes can share them; `height` is empty or has one value a point.
void write_table(AtomicFile& out, std::span<const double> xy, std::span<const double> height,
                 const std::string& format);
/// The header and the points of a .node or .poly file.
void write_node_section(AtomicFile& out, const NodeColumns& nodes, int base);
void write_node(AtomicFile& out, const NodeColumns& nodes, int base);
void write_ply_points(AtomicFile& out, std::span<const double> xy, std::span<const double> height);
void write_npy(AtomicFile& out, std::span<const double> xy, std::span<const double> height);
void write_raw(AtomicFile& out, const std::string& name, std::span<const double> xy, std::size_t bytes);

}  // namespace cadt::io::detail
