// SPDX-License-Identifier: Apache-2.0
// How long triangulate_polygons takes, from host to host. usage: cadt-time-polygons [BACKEND [THREADS [POLYGONS]]]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/unit/constraints/polygon_sets.hpp"

int main(int argc, char** argv) try {
  using namespace cadt;
  using Clock = std::chrono::steady_clock;
  Options options;
  options.backend = backend_from_string(argc > 1 ? argv[1] : "host");
  options.threads = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0;
  const std::size_t points = 10 * (argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1000000);
  std::mt19937_64 random(1);
  for (const std::size_t n : {std::size_t{10}, std::size_t{4}, std::size_t{30}, std::size_t{100}}) {
    test::PolygonSet set;
    for (std::size_t p = 0; p < points / n; ++p)
      set.add(
          {test::star(random, n, static_cast<double>(random() >> 20), static_cast<double>(random() >> 20), 3e8, 1e9)});
    for (int run = 0; run < 4; ++run) {
      const auto begin = Clock::now();
      const PolygonsResult result = set.triangulate(options);
      const double ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
      std::printf("%zu polygons of %zu points: %.1f ms, %.0f ns each, %zu triangles, %zu problems\n", set.size(), n, ms,
                  1e6 * ms / static_cast<double>(set.size()), result.triangles().size() / 3, result.problems().size());
    }
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "cadt-time-polygons: %s\n", error.what());
  return 1;
}
