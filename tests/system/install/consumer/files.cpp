// SPDX-License-Identifier: Apache-2.0
#include <cadt/cadt.hpp>
#include <cadt/io/generate.hpp>
#include <cadt/io/mesh_file.hpp>

int main(int, char** argv) {
  const cadt::io::PointSet points = cadt::io::generate("uniform", {.n = 100});
  cadt::io::write_mesh(argv[1], points, cadt::triangulate(points.view()));
}
