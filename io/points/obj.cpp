// SPDX-License-Identifier: Apache-2.0
// Vertices of Wavefront OBJ files: .obj
#include "io/points/readers.hpp"
#include "io/support/obj_statements.hpp"

namespace cadt::io::detail {

PointSet read_obj_points(const InputFile& file, const ReadOptions& options) {
  TextScanner scanner(file.name(), file.bytes());
  PointCollector points(file.name(), options.projection, true);
  std::size_t vertices = 0;
  while (next_obj_statement(scanner, "v", vertices)) {
    const double x = scanner.number("x");
    const double y = scanner.number("y");
    points.add(x, y, scanner.number("z"));  // a weight or a colour may follow
  }
  return points.take();
}

}  // namespace cadt::io::detail
