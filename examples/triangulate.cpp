// SPDX-License-Identifier: Apache-2.0
// Points on the host, their mesh on the host: the shortest use of the library.
//
// usage: example-triangulate [points [back end]]      e.g. example-triangulate 1000000 opencl
#include <cadt/cadt.hpp>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <random>
#include <vector>

int main(int count, char** values) {
  try {
    const std::size_t n = count > 1 ? std::strtoul(values[1], nullptr, 10) : 100'000;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> coordinate(0.0, 1.0);
    std::vector<double> xy(2 * n);
    for (double& value : xy) value = coordinate(random);

    cadt::Options options;  // all defaults: a GPU if there is one, else all cores
    if (count > 2) options.backend = cadt::backend_from_string(values[2]);
    const cadt::Triangulation mesh = cadt::triangulate(xy, options);

    std::cout << "points      " << mesh.number_of_points() << '\n'
              << "duplicates  " << mesh.duplicates().size() << '\n'
              << "triangles   " << mesh.number_of_triangles() << '\n'
              << "hull        " << mesh.hull().size() << '\n'
              << "back end    " << mesh.statistics().backend << ", " << mesh.statistics().device << '\n';

    const cadt::VerifyReport report = cadt::verify(xy, mesh);  // predicates of its own
    std::cout << "verified    " << report.summary() << '\n';
    return report.ok ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {  // cadt::Error has the library's own ones, each with its data
    std::cerr << "example-triangulate: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
