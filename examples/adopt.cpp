// SPDX-License-Identifier: Apache-2.0
// The mesh of another program: verified and adopted, or refused with the first thing that is wrong.
#include <cadt/cadt.hpp>

#include <array>
#include <exception>
#include <iostream>
#include <vector>

int main() {
  try {
    const std::vector<std::array<double, 2>> points = {{0, 0}, {4, 0}, {2, 1}, {2, -1}};
    std::vector<std::int32_t> triangles = {0, 3, 2, 3, 1, 2};  // as SciPy, Triangle or CGAL gave them

    const cadt::Triangulation mesh = cadt::Triangulation::adopt(points, triangles);
    std::cout << "adopted: " << mesh.number_of_triangles()
              << " triangles, neighbour of 0 across vertex 0: " << mesh.neighbor(0, 0) << '\n';

    triangles = {0, 1, 2, 0, 3, 1};  // the other diagonal
    try {
      static_cast<void>(cadt::Triangulation::adopt(points, triangles));
      std::cerr << "example-adopt: a wrong mesh was adopted\n";
      return 1;
    } catch (const cadt::InvalidMesh& error) {
      std::cout << "refused by the check '" << error.check() << "': " << error.what() << '\n';
    }
    // Whoever knows that the geometry is right saves the exact tests; the structure is checked all the same.
    static_cast<void>(cadt::Triangulation::adopt(points, triangles, {}, cadt::Trust::geometry));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "example-adopt: " << error.what() << '\n';
    return 1;
  }
}
