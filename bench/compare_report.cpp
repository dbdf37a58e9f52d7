// SPDX-License-Identifier: Apache-2.0
#include "bench/compare.hpp"

#include "bench/row.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace cadt::bench {
namespace {

const Comparison* find(const std::vector<Comparison>& all, const std::string& distribution,
                       const std::string& contestant) {
  const auto found = std::ranges::find_if(
      all, [&](const Comparison& m) { return m.distribution == distribution && m.contestant == contestant; });
  return found == all.end() ? nullptr : &*found;
}

// Negative if there is nothing to compare with.
double times_as_fast_as_cgal(const std::vector<Comparison>& all, const Comparison& m) {
  const Comparison* cgal = find(all, m.distribution, "cgal");
  return cgal ? cgal->best() / m.best() : -1.0;
}

double against_uniform(const std::vector<Comparison>& all, const Comparison& m) {
  const Comparison* uniform = find(all, "uniform", m.contestant);
  if (!uniform) return -1.0;
  const double here = m.best() / static_cast<double>(m.points);
  return here / (uniform->best() / static_cast<double>(uniform->points));
}

std::string ratio(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%9.2f", value);
  return value < 0.0 ? "        -" : text;
}

}  // namespace

std::string comparison_table(const std::vector<Comparison>& all) {
  std::string result = "distribution   who       points      triangles   best ms   median ms   x CGAL  / uniform\n";
  for (const Comparison& m : all) {
    char line[200];
    std::snprintf(line, sizeof line, "%-13s  %-7s %8zu %14zu %9.1f %11.1f", m.distribution.c_str(),
                  m.contestant.c_str(), m.points, m.triangles, 1e3 * m.best(), 1e3 * median(m.seconds));
    result += line + ratio(times_as_fast_as_cgal(all, m)) + "  " + ratio(against_uniform(all, m)) + '\n';
  }
  return result +
         "x CGAL: times as fast as CGAL on the same points. / uniform: time per point, uniform points being 1.\n";
}

std::string comparison_json(const std::vector<Comparison>& all) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (const Comparison& m : all) {
    nlohmann::ordered_json entry = {{"distribution", m.distribution},
                                    {"contestant", m.contestant},
                                    {"points", m.points},
                                    {"triangles", m.triangles},
                                    {"best_seconds", m.best()},
                                    {"median_seconds", median(m.seconds)},
                                    {"seconds", m.seconds}};
    if (const double value = times_as_fast_as_cgal(all, m); value >= 0.0) entry["times_as_fast_as_cgal"] = value;
    if (const double value = against_uniform(all, m); value >= 0.0) entry["time_per_point_against_uniform"] = value;
    if (!m.statistics.backend.empty()) {
      const Statistics& s = m.statistics;
      entry["device"] = s.device;
      entry["threads"] = s.threads;
      entry["launches"] = s.launches;
      entry["walk_steps"] = s.walk_steps;
      entry["lock_failures"] = s.lock_failures;
      entry["flips"] = s.flips;
      entry["exact_incircles"] = s.exact_incircles;
      entry["sweep_repairs"] = s.sweep_repairs;
      for (const auto& [phase, time] : s.milliseconds) entry["milliseconds"][phase] = time;
      entry["device_seconds"] = m.device_seconds;
    }
    result.push_back(std::move(entry));
  }
  return result.dump(2) + '\n';
}

}  // namespace cadt::bench
