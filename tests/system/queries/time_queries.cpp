// SPDX-License-Identifier: Apache-2.0
// Times of queries on large sets: points, queries and results in device memory, on the host beside CGAL. One line a
// query.
#include <cadt/cadt.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/families.hpp"
#include "tests/support/oracle.hpp"
#include "tests/system/resident/device_memory.hpp"

namespace {

using namespace cadt;

[[noreturn]] void usage() {
  std::fputs(
      "usage: cadt-time-queries [--backend cuda|opencl|host] [--points N] [--queries Q] [--cells C] [--runs R] "
      "[--cgal]\n"
      "prints the median of R runs (and the least and the most) in milliseconds; --cgal: locate of CGAL in turn with "
      "ours\n",
      stderr);
  std::exit(2);
}

struct Arguments {
  std::string backend = "cuda";
  std::size_t points = 1'000'000, queries = 1'000'000, cells = 1000;
  int runs = 9;
  bool cgal = false;
};

Arguments parse(int count, char** values) {
  Arguments a;
  for (int i = 1; i < count; ++i) {
    const std::string word = values[i];
    if (word == "--cgal") {
      a.cgal = true;
      continue;
    }
    if (++i == count) usage();
    if (word == "--backend")
      a.backend = values[i];
    else if (word == "--points")
      a.points = std::stoul(values[i]);
    else if (word == "--queries")
      a.queries = std::stoul(values[i]);
    else if (word == "--cells")
      a.cells = std::stoul(values[i]);
    else if (word == "--runs")
      a.runs = std::stoi(values[i]);
    else
      usage();
  }
  return a;
}

double time_of(const std::function<void()>& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

void print(const char* what, std::vector<double> times, double elements) {
  std::ranges::sort(times);
  const double median = times[times.size() / 2];
  std::printf("%-34s %9.3f ms  (%.3f to %.3f)  %8.1f M/s\n", what, median, times.front(), times.back(),
              elements / median / 1e3);
}

int run(const Arguments& a) {
  Options options;
  options.backend = backend_from_string(a.backend);
  int index = 0;
  for (const DeviceInfo& device : list_devices())
    if (device.backend == options.backend && device.usable && device.gpu) index = device.index;
  const auto memory = test::device_memory(options.backend, index);
  if (options.backend != Backend::host) options.queue = memory->queue();
  Triangulator triangulator(options);
  const test::Points xy = test::uniform_points(a.points, 1), where = test::uniform_points(a.queries, 2);
  std::vector<double> heights(a.points);
  for (std::size_t i = 0; i < a.points; ++i) heights[i] = std::sin(9 * xy[2 * i]) * xy[2 * i + 1];
  const DevicePoints points{.x = memory->upload(std::span<const double>(xy)), .size = a.points};
  const DevicePoints queries{.x = memory->upload(std::span<const double>(where)), .size = a.queries},
      one{.x = queries.x, .size = 1};
  const DeviceArray values{memory->upload(std::span<const double>(heights)), a.points};
  const DeviceArray triangles{memory->allocate(4 * a.queries), a.queries}, nearest = triangles;
  const DeviceArray results{memory->allocate(8 * a.queries), a.queries};
  const Grid grid{0, 0, 1.0 / static_cast<double>(a.cells), 1.0 / static_cast<double>(a.cells), a.cells, a.cells};
  const DeviceArray cells{memory->allocate(8 * grid.cells()), grid.cells()};
  const DeviceTriangulation mesh = triangulator.triangulate(points);
  const DeviceArray centers{memory->allocate(16 * mesh.number_of_triangles()), 2 * mesh.number_of_triangles()};
  std::printf("%s: %zu points, %zu queries, %zu cells\n", triangulator.device().name.c_str(), a.points, a.queries,
              grid.cells());

  const auto repeat = [&](const char* what, double elements, const std::function<void()>& call) {
    call();
    memory->wait();
    std::vector<double> times;
    for (int i = 0; i < a.runs; ++i)
      times.push_back(time_of([&] {
        call();
        memory->wait();
      }));
    print(what, times, elements);
  };
  const auto n = static_cast<double>(a.queries);
  repeat("index", static_cast<double>(a.points), [&] {
    MeshQueries(triangulator, points, mesh).locate(one, triangles);  // the first query makes it
  });
  MeshQueries asked(triangulator, points, mesh);
  repeat("locate", n, [&] { asked.locate(queries, triangles); });
  repeat("nearest vertex", n, [&] { asked.nearest_vertices(queries, 1, nearest); });
  repeat("linear", n, [&] { asked.interpolate(values, queries, results); });
  repeat("natural neighbours", n, [&] { asked.interpolate(values, queries, results, Interpolation::natural); });
  repeat("raster, linear", static_cast<double>(grid.cells()), [&] { asked.rasterize(grid, values, cells); });
  repeat("circumcentres", static_cast<double>(mesh.number_of_triangles()), [&] { asked.circumcenters(centers); });
  const std::size_t m = mesh.number_of_triangles();
  const DeviceVoronoi diagram{centers,
                              {memory->allocate(4 * (a.points + 1)), a.points + 1},
                              {memory->allocate(12 * m), 3 * m},
                              {memory->allocate(16 * m), 4 * m},
                              {memory->allocate(16 * m), 4 * m}};
  repeat("Voronoi: vertices, cells, edges", static_cast<double>(m), [&] { asked.voronoi(diagram); });
  repeat("Voronoi: vertices, cells", static_cast<double>(m), [&] {
    asked.voronoi({diagram.vertices, diagram.cell_begin, diagram.cells, {}, {}});
  });
  repeat("Voronoi, to the host", static_cast<double>(mesh.number_of_triangles()), [&] { (void)asked.voronoi(); });
#if CADT_TEST_CGAL
  if (a.cgal) {
    std::vector<double> ours, theirs;
    for (int i = 0; i < 3; ++i) {
      theirs.push_back(1e3 * test::cgal_locate(xy, where).seconds);
      for (int k = 0; k < 3; ++k)
        ours.push_back(time_of([&] {
          asked.locate(queries, triangles);
          memory->wait();
        }));
    }
    print("locate, in turn with CGAL", ours, n);
    print("CGAL's locate, sorted, with hints", theirs, n);
  }
#endif
  return 0;
}

}  // namespace

int main(int count, char** values) {
  try {
    return run(parse(count, values));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
