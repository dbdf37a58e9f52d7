// SPDX-License-Identifier: Apache-2.0
// What segments cost: resident calls with and without them, in turn, and how many pieces were inserted. One line a
// case.
//   cadt-time-constraints BACKEND CASE [POINTS]
// CASE: edges (as many segments as points, a tenth of them no edges), one (across all points), long (1,000 across all
// points), crossings (POINTS segments with about as many crossings, Crossing::exact), or NAME of
// NAME.f64 with points and NAME.i32 with segments: then with Domain::even_odd
#include <cadt/cadt.hpp>
#include <cadt/constrained.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/system/resident/device_memory.hpp"

namespace {

using namespace cadt;

struct Input {
  std::vector<double> xy;
  std::vector<Segment> segments;
};

Input uniform(std::size_t n) {
  Input input;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 1);
  for (std::size_t i = 0; i < 2 * n; ++i) input.xy.push_back(place(random));
  return input;
}

/// Edges of the mesh, and for a tenth of the segments the other diagonals of edges that are no segments.
Input edges(std::size_t n, const Options& options) {
  Input input = uniform(n);
  const Triangulation mesh = triangulate(input.xy, options);
  const auto t = mesh.triangles(), across = mesh.neighbors();
  const auto at = [&](std::int32_t v) {
    return std::array<double, 2>{input.xy[2 * static_cast<std::size_t>(v)],
                                 input.xy[2 * static_cast<std::size_t>(v) + 1]};
  };
  std::vector<bool> used(mesh.number_of_triangles());
  std::vector<Segment> plain;
  std::size_t flipped = 0;
  for (std::size_t i = 0; i < used.size() && input.segments.size() < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = across[3 * i + k];
      if (other < static_cast<std::int32_t>(i)) continue;
      const auto u = static_cast<std::size_t>(other);
      const std::int32_t p = t[3 * i + k], a = t[3 * i + (k + 1) % 3], b = t[3 * i + (k + 2) % 3];
      std::size_t j = 0;
      while (across[3 * u + j] != static_cast<std::int32_t>(i)) ++j;
      const std::int32_t q = t[3 * u + j];
      if (flipped < n / 10 && !used[i] && !used[u] && exact_orientation(at(p), at(a), at(q)) > 0 &&
          exact_orientation(at(p), at(q), at(b)) > 0) {
        used[i] = used[u] = true;
        ++flipped;
        input.segments.push_back({p, q});
      } else if (plain.size() < n - n / 10) {
        plain.push_back({a, b});
      }
    }
  }
  input.segments.insert(input.segments.end(), plain.begin(), plain.end());
  std::shuffle(input.segments.begin(), input.segments.end(), std::mt19937_64(2));
  return input;
}

/// From the left to the right of all points, one above the other.
Input across_all(std::size_t n, std::size_t count) {
  Input input = uniform(n - 2 * count);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(0, 0.5);
  for (std::size_t i = 0; i < count; ++i) {
    const auto v = static_cast<std::int32_t>(input.xy.size() / 2);
    const double step = 1.0 / static_cast<double>(count), y = (static_cast<double>(i) + 0.5) * step;
    input.xy.insert(input.xy.end(), {-0.001, y, 1.001, y + step * shift(random)});
    input.segments.push_back({v, v + 1});
  }
  return input;
}

/// Segments of one length in random directions, with about as many crossings.
Input crossings(std::size_t n) {
  Input input;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0, 1);
  constexpr double pi = 3.14159265358979323846;
  const double length = std::sqrt(pi / static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const double x = place(random), y = place(random), angle = 2 * pi * place(random);
    input.xy.insert(input.xy.end(), {x, y, x + length * std::cos(angle), y + length * std::sin(angle)});
    input.segments.push_back({static_cast<std::int32_t>(2 * i), static_cast<std::int32_t>(2 * i + 1)});
  }
  return input;
}

template <class T>
std::vector<T> read_all(const std::string& name) {
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  if (!file) throw std::runtime_error(name + " cannot be opened");
  std::vector<T> values(static_cast<std::size_t>(file.tellg()) / sizeof(T));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
  return values;
}

template <class Call>
double milliseconds(const Call& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string which = argv[2];
  const std::size_t n = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1000000;
  Options options;
  options.backend = backend_from_string(argv[1]);
  if (argc > 4) options.threads = static_cast<unsigned>(std::atoi(argv[4]));
  options.order = Order::fast;
  options.tuning.kernel_times = std::getenv("CADT_KERNELS") != nullptr;
  options.statistics = StatisticsDetail::none;
  ConstraintOptions constraints;
  Input input;
  if (which == "edges") {
    input = edges(n, options);
  } else if (which == "crossings") {
    input = crossings(n);
    constraints.crossing = Crossing::exact;
  } else if (which == "one" || which == "long") {
    input = across_all(n, which == "one" ? 1 : 1000);
  } else {
    input = {read_all<double>(which + ".f64"), read_all<Segment>(which + ".i32")};
    constraints.domain = Domain::even_odd;
  }
  const auto memory = test::device_memory(options.backend, 0);
  if (memory->queue() != nullptr) options.queue = memory->queue();
  Triangulator triangulator(options);
  void* segments = memory->upload(std::span<const Segment>(input.segments));
  const DevicePoints points{.x = memory->upload(std::span<const double>(input.xy)), .size = input.xy.size() / 2};
  std::vector<double> plain, constrained;
  Statistics statistics;
  std::size_t added = 0;
  for (int round = 0; round < 9; ++round) {
    plain.push_back(milliseconds([&] {
      (void)triangulator.triangulate(points);
      memory->wait();
    }));
    constrained.push_back(milliseconds([&] {
      const DeviceTriangulation mesh =
          triangulator.triangulate_constrained(points, {segments, 2 * input.segments.size()}, constraints);
      statistics = mesh.statistics();
      added = mesh.number_added();
      memory->wait();
    }));
  }
  std::printf(
      "%s %s: %zu points, %zu segments: %.3f ms, without segments %.3f ms; %llu inserted, %llu retries, %llu "
      "launches\n",
      argv[1], which.c_str(), points.size, input.segments.size(), median(constrained), median(plain),
      static_cast<unsigned long long>(statistics.inserted_segments),
      static_cast<unsigned long long>(statistics.segment_retries),
      static_cast<unsigned long long>(statistics.launches));
  if (added != 0) std::printf("  %zu crossings\n", added);
  for (const KernelTime& k : statistics.kernels)
    std::printf("  %-28s %5llu %10.3f ms\n", k.name.c_str(), static_cast<unsigned long long>(k.launches),
                k.milliseconds);
  return 0;
}
