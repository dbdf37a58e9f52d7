// SPDX-License-Identifier: Apache-2.0
#include <cadt/cadt.hpp>

#include <cstdio>
#include <limits>
#include <vector>

int main() {
  std::vector<double> xy = {0, 0, 1, 0, 1, 1, 0, 1};
  cadt::Options options;
  options.backend = cadt::Backend::host;
  const cadt::Triangulation mesh = cadt::triangulate(xy, options);
  if (mesh.number_of_triangles() != 2 || !cadt::verify(xy, mesh).ok) return 1;
  xy[3] = std::numeric_limits<double>::quiet_NaN();
  try {
    static_cast<void>(cadt::triangulate(xy, options));
    return 2;
  } catch (const cadt::InputError& error) {  // its type is the same on both sides of a shared library
    if (error.index() != 1) return 3;
  }
  std::puts("two triangles");
}
