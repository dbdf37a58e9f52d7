// SPDX-License-Identifier: Apache-2.0
// Vertices of OFF files: .off
#include "io/points/readers.hpp"
#include "io/support/off_reader.hpp"

namespace cadt::io::detail {

PointSet read_off_points(const InputFile& file, const ReadOptions& options) {
  OffReader reader(file);
  PointCollector points(file.name(), options.projection, true);
  points.reserve(reader.vertices());
  for (std::size_t i = 0; i < reader.vertices(); ++i) {
    const auto [x, y, z] = reader.vertex();
    points.add(x, y, z);
  }
  // The faces are read as well: a truncated file is an error even if all vertices are there.
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < reader.faces(); ++i) reader.face(corners);
  reader.expect_end();
  return points.take();
}

}  // namespace cadt::io::detail
