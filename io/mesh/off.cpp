// SPDX-License-Identifier: Apache-2.0
// OFF meshes: .off
#include "io/mesh/mesh_parts.hpp"
#include "io/support/number_format.hpp"
#include "io/support/off_reader.hpp"

namespace cadt::io::detail {

void write_off(AtomicFile& out, const MeshParts& mesh) {
  out.write("OFF\n" + std::to_string(mesh.xy.size() / 2) + " " + std::to_string(mesh.triangles.size() / 3) + " 0\n");
  write_vertex_rows(out, mesh, "");
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    char* at = put_corners(put(out.room(4 * number_room), "3"), &mesh.triangles[i], 0);
    *at++ = '\n';
    out.advance(at);
  }
}

MeshFile read_off_mesh(const InputFile& file, std::size_t points) {
  OffReader reader(file);
  for (std::size_t i = 0; i < reader.vertices(); ++i) static_cast<void>(reader.vertex());
  TriangleCollector triangles(points, 0);
  triangles.reserve(reader.faces());
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < reader.faces(); ++i) {
    reader.face(corners);
    if (corners.size() != corners_of_triangle) reader.fail(not_a_triangle(corners.size()));
    for (const std::int64_t index : corners) {
      if (!triangles.add(index)) reader.fail(triangles.refusal(index));
    }
  }
  reader.expect_end();
  return {triangles.take(), {}};
}

}  // namespace cadt::io::detail
