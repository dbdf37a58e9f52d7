// SPDX-License-Identifier: Apache-2.0
// Reading and writing point files.
#pragma once

#include <cadt/io/errors.hpp>
#include <cadt/points.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace cadt::io {

/// Which two coordinates span the plane; the third becomes `PointSet::height`.
enum class Projection { xy, yz, zx };

struct ReadOptions {
  std::string format;   ///< overrides the suffix: xy txt csv xyz node ply obj off npy f64 f32
  std::string columns;  ///< for tables: "1,2", "x,y", "lon,lat,depth" (1-based or by header name); empty: detected
  Projection projection = Projection::xy;
};

/// Points as read. `height` is empty for plane data, else it has one value a point. The view is valid as long as `xy`
/// is unchanged.
struct PointSet {
  std::vector<double> xy;  ///< interleaved
  std::vector<double> height;
  std::string format;  ///< the format that was read
  [[nodiscard]] std::size_t size() const noexcept { return xy.size() / 2; }
  [[nodiscard]] PointsView view() const { return PointsView(std::span<const double>(xy)); }
};

/// Reads a point file; "-" is standard input (then `format` is required). Numbers do not depend on the C locale. Memory
/// is bounded by the size of the file, whatever its header claims. \throws FileError with the line (text) or the byte
/// (binary), also for NaN and infinity, empty files, truncated files and wrong counts
[[nodiscard]] PointSet read_points(const std::string& path, const ReadOptions& options = {});

/// Writes points; the format comes from the suffix unless given: xy txt csv xyz node ply npy f64 f32. Numbers are the
/// shortest decimals that read back to the same doubles. The file appears under its name only when complete. \throws
/// FileError
void write_points(const std::string& path, const PointSet& points, const std::string& format = {});

/// Names of the formats that can be read, and that points can be written to.
[[nodiscard]] std::vector<std::string> point_read_formats();
[[nodiscard]] std::vector<std::string> point_write_formats();

}  // namespace cadt::io
