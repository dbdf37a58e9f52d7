// SPDX-License-Identifier: Apache-2.0
// Queries whose points, values and results stay in device memory. Here the device is the host, whose memory is ordinary
// memory; with CUDA the pointers come from cudaMalloc, and nothing else changes.
//
// usage: example-device_queries [points]
#include <cadt/cadt.hpp>

#include <algorithm>
#include <cmath>
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
    std::vector<double> xy(2 * n), height(n), where(2 * n);
    for (double& value : xy) value = coordinate(random);
    for (std::size_t i = 0; i < n; ++i) height[i] = 2 * xy[2 * i] - 3 * xy[2 * i + 1];
    for (double& value : where) value = coordinate(random);

    cadt::Options options;
    options.backend = cadt::Backend::host;     // CUDA: Backend::cuda
    cadt::Triangulator triangulator(options);  // CUDA: options.queue = stream puts all work on a stream of the caller
    const cadt::DevicePoints points{.x = xy.data(), .size = n};
    const cadt::DeviceTriangulation mesh = triangulator.triangulate(points);
    cadt::MeshQueries queries(triangulator, points, mesh);  // all three must outlive it

    // Results go to memory of the caller's. Their sizes are known before: here one number a query.
    const cadt::DevicePoints asked{.x = where.data(), .size = n};
    std::vector<std::int32_t> triangles(n);
    queries.locate(asked, cadt::DeviceArray{triangles.data(), n});
    std::vector<double> found(n);
    queries.interpolate(cadt::DeviceArray{height.data(), n}, asked, cadt::DeviceArray{found.data(), n},
                        cadt::Interpolation::natural, cadt::Outside::nearest);
    // With a stream of the caller: cudaStreamSynchronize(stream) before the host looks at results.

    std::size_t inside = 0;
    double worst = 0;
    for (std::size_t q = 0; q < n; ++q) {
      if (triangles[q] < 0) continue;
      ++inside;
      worst = std::max(worst, std::abs(found[q] - (2 * where[2 * q] - 3 * where[2 * q + 1])));
    }
    std::cout << "inside      " << inside << " of " << n << '\n'
              << "error       " << worst << " at most, for a plane\n"
              << "device      " << queries.device().name << '\n';
    return worst < 1e-9 ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << "example-device_queries: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
