// SPDX-License-Identifier: Apache-2.0
#include "bench/measure.hpp"

#include "tests/support/oracle.hpp"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <stdexcept>

namespace cadt::bench {
namespace {

std::string why_not(Backend backend) {
  std::string reason = "not listed";
  for (const DeviceInfo& device : list_devices()) {
    if (device.backend != backend) continue;
    if (device.usable) return {};
    reason = device.reason;
  }
  return reason;
}

}  // namespace

std::vector<Contestant> contestants(const std::vector<std::string>& names, unsigned threads,
                                    const std::string& device) {
  std::vector<Contestant> result;
  for (const std::string& name : names) {
    Contestant contestant{name, name == "cgal", {}};
    if (!contestant.cgal) {
      const Backend backend = backend_from_string(name);
      const std::string reason = why_not(backend);
      if (!reason.empty()) {
        std::cerr << name << " is left out: " << reason << '\n';
        continue;
      }
      contestant.options.backend = backend;
      if (backend == Backend::host) contestant.options.threads = threads;
      if (backend != Backend::host) contestant.options.device = device;
    }
    result.push_back(contestant);
  }
  return result;
}

Measurement measure(const Contestant& contestant, const std::vector<double>& xy, int repeat) {
  using Clock = std::chrono::steady_clock;
  Measurement result;
  result.contestant = contestant.name;
  result.points = xy.size() / 2;
  for (int run = 0; run <= repeat; ++run) {
    const std::vector<double> fresh = xy;
    double seconds = 0.0;
    if (contestant.cgal) {
      const test::InsertionTime insertion = test::cgal_insertion(fresh);
      result.triangles = insertion.triangles;
      seconds = insertion.seconds;
    } else {
      const auto start = Clock::now();
      const Triangulation mesh = triangulate(std::span<const double>(fresh), contestant.options);
      seconds = std::chrono::duration<double>(Clock::now() - start).count();
      result.triangles = mesh.number_of_triangles();
      result.statistics = mesh.statistics();
    }
    if (run > 0) result.times.seconds.push_back(seconds);
  }
  std::ranges::sort(result.times.seconds);
  return result;
}

std::string difference_from_cgal(const Contestant& contestant, const std::vector<double>& xy) {
  if (contestant.cgal) return {};
  const test::OracleMesh oracle = test::cgal_delaunay(xy);
  const Triangulation mesh = triangulate(std::span<const double>(xy), contestant.options);
  const auto have = mesh.triangles();
  if (have.size() != 3 * oracle.triangles.size()) {
    return std::to_string(have.size() / 3) + " triangles, CGAL has " + std::to_string(oracle.triangles.size());
  }
  for (std::size_t t = 0; t < oracle.triangles.size(); ++t) {
    if (!std::ranges::equal(have.subspan(3 * t, 3), oracle.triangles[t]))
      return "triangle " + std::to_string(t) + " differs";
  }
  return {};
}

}  // namespace cadt::bench
