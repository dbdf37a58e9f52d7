// SPDX-License-Identifier: Apache-2.0
#include "bench/compare.hpp"

#include "bench/measure.hpp"
#include "tests/support/oracle.hpp"

#include <algorithm>
#include <iostream>
#include <span>

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

bool has_cgal() noexcept { return CADT_TEST_CGAL != 0; }

std::vector<Fighter> find_fighters(const std::vector<std::string>& names, unsigned threads, const std::string& device) {
  std::vector<Fighter> result;
  for (const std::string& name : names) {
    Fighter fighter{name, name == "cgal", {}};
    std::string reason;
    if (fighter.cgal) {
      if (!has_cgal()) reason = "it was not there when this was built";
    } else {
      fighter.options.backend = backend_from_string(name);
      reason = why_not(fighter.options.backend);
      if (fighter.options.backend == Backend::host) {
        fighter.options.threads = threads;
      } else {
        fighter.options.device = device;
      }
    }
    if (reason.empty()) {
      result.push_back(fighter);
    } else {
      std::cerr << name << " is left out: " << reason << '\n';
    }
  }
  return result;
}

Comparison compare(const Fighter& fighter, const std::vector<double>& xy, int repeat) {
  Comparison result;
  result.contestant = fighter.name;
  result.points = xy.size() / 2;
  for (int run = 0; run <= repeat; ++run) {
    const std::vector<double> fresh = xy;
    double seconds = 0.0;
    if (fighter.cgal) {
#if CADT_TEST_CGAL
      const test::InsertionTime insertion = test::cgal_insertion(fresh);
      result.triangles = insertion.triangles;
      seconds = insertion.seconds;
#endif
    } else {
      const Stopwatch watch;
      const Triangulation mesh = triangulate(std::span<const double>(fresh), fighter.options);
      seconds = watch.milliseconds() / 1e3;
      result.triangles = mesh.number_of_triangles();
      result.statistics = mesh.statistics();
    }
    if (run == 0) continue;
    result.seconds.push_back(seconds);
    if (const auto milliseconds = on_device(result.statistics)) result.device_seconds.push_back(*milliseconds / 1e3);
  }
  std::ranges::sort(result.seconds);
  std::ranges::sort(result.device_seconds);
  return result;
}

std::string difference_from_cgal(const Fighter& fighter, const std::vector<double>& xy) {
#if CADT_TEST_CGAL
  if (fighter.cgal) return {};
  const test::OracleMesh oracle = test::cgal_delaunay(xy);
  const Triangulation mesh = triangulate(std::span<const double>(xy), fighter.options);
  const auto have = mesh.triangles();
  if (have.size() != 3 * oracle.triangles.size()) {
    return std::to_string(have.size() / 3) + " triangles, CGAL has " + std::to_string(oracle.triangles.size());
  }
  for (std::size_t t = 0; t < oracle.triangles.size(); ++t) {
    if (!std::ranges::equal(have.subspan(3 * t, 3), oracle.triangles[t]))
      return "triangle " + std::to_string(t) + " differs";
  }
  return {};
#else
  static_cast<void>(fighter), static_cast<void>(xy);
  return "CGAL was not there when this was built";
#endif
}

}  // namespace cadt::bench
