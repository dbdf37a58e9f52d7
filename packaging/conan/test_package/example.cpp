// SPDX-License-Identifier: Apache-2.0
#include <cadt/cadt.hpp>

#include <cstdio>
#include <vector>

int main() {
  const std::vector<double> xy = {0, 0, 1, 0, 1, 1, 0, 1};
  const cadt::Triangulation mesh = cadt::triangulate(xy);
  std::printf("cadt " CADT_VERSION ": %zu triangles\n", mesh.number_of_triangles());
  return mesh.number_of_triangles() == 2 && cadt::verify(xy, mesh).ok ? 0 : 1;
}
