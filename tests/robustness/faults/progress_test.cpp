// SPDX-License-Identifier: Apache-2.0
// The progress that a call reports, listed for each path through it: no report may be missing, each fraction is greater
// than the one before, and at each report a stop request takes effect.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

#include <cadt/constrained.hpp>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "common/driver/device_text.hpp"

namespace cadt::test {
namespace {

using Reals = std::span<const double>;
using Counted = std::function<Statistics(Triangulator&)>;
using Names = std::vector<std::string>;

/// Insertion, of points and of segments, reports how far it is whenever it waits for that; other reports come once.
bool is_repeated(const Progress& progress) { return progress.phase == "insert" || progress.phase == "constrain"; }

std::string text_of(const Progress& progress) {
  char text[64];
  if (is_repeated(progress)) return std::string(progress.phase);
  (void)std::snprintf(text, sizeof text, "%s %.4g", std::string(progress.phase).c_str(), progress.fraction);
  return text;
}

Names names_of(const Statistics& statistics) {
  Names names;
  for (const auto& [name, milliseconds] : statistics.milliseconds) names.push_back(name);
  return names;
}

Names sorted(Names names) {
  std::ranges::sort(names);
  return names;
}

class ReportedProgress : public ResidentTest {
 protected:
  [[nodiscard]] Options options(Strategy strategy) const {
    Options with = ResidentTest::options();
    with.tuning.strategy = strategy;
    return with;
  }

  /// `reports`: as text_of() has them, those of insertion once. `phases`: of Statistics::milliseconds.
  void expect_reports(const Options& with, const Counted& call, const Names& reports, const Names& phases) {
    // A sweep that repairs something, which depends on the schedule, has a report of its own, and what follows then
    // begins no later.
    const auto report_of = [&](const Progress& progress) {
      const std::string text = text_of(progress);
      if (progress.phase != "certify" || std::ranges::find(reports, text) != reports.end()) return text;
      return std::string(progress.fraction < 0.9 ? "constrain" : "output 0.9");
    };
    Triangulator triangulator(with);
    Names told;
    std::size_t all = 0;
    double last = -1;
    triangulator.options().progress = [&](const Progress& progress) {
      EXPECT_GT(progress.fraction, last) << progress.phase;
      EXPECT_LE(progress.fraction, 1);
      last = progress.fraction;
      ++all;
      if (told.empty() || told.back() != report_of(progress) || !is_repeated(progress))
        told.push_back(report_of(progress));
    };
    const Statistics statistics = call(triangulator);
    EXPECT_EQ(told, reports);
    EXPECT_EQ(last, 1);
    EXPECT_EQ(sorted(names_of(statistics)), sorted(phases));
    // A stop requested at any report takes effect before the next one.
    for (std::size_t stop_at = 0; stop_at < reports.size(); ++stop_at) {
      cadt::stop_source source;
      std::size_t later = 0;
      triangulator.options().stop = source.get_token();
      triangulator.options().progress = [&](const Progress& progress) {
        if (source.stop_requested()) ++later;
        if (report_of(progress) == reports[stop_at]) source.request_stop();
      };
      (void)thrown<Cancelled>([&] { (void)call(triangulator); });
      EXPECT_TRUE(source.stop_requested()) << reports[stop_at];
      EXPECT_EQ(later, 0U) << reports[stop_at];
    }
    triangulator.options().stop = {};
    triangulator.options().progress = nullptr;
    (void)call(triangulator);
  }

  const std::shared_ptr<Faults> faults = std::make_shared<Faults>();
  const Injection injection{faults};
};

const Names of_insertion = {"sort 0", "sort 0.01", "insert", "output 0.9", "output 0.95", "output 1"};
const Names of_stars = {"sort 0",     "sort 0.01",   "stars 0.1",   "stars 0.5",
                        "stitch 0.8", "certify 0.9", "output 0.95", "output 1"};
const Names insertion_phases = {"upload", "bounds", "sort", "gather", "seed", "insert", "certify", "output"};
const Names star_phases = {"upload",   "bounds", "sort",   "gather",  "tiles", "stars",
                           "assemble", "wrap",   "stitch", "certify", "output"};

Names with(Names names, const Names& more) {
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

Names without(Names names, const std::string& one) {
  std::erase(names, one);
  return names;
}

TEST_P(ReportedProgress, Insertion) {
  const Points xy = uniform_points(20000, 7);
  const DevicePoints points = upload(xy);
  expect_reports(
      options(Strategy::locks), [&](Triangulator& t) { return t.triangulate(Reals(xy)).statistics(); }, of_insertion,
      with(insertion_phases, {"copy"}));
  expect_reports(
      options(Strategy::locks), [&](Triangulator& t) { return t.triangulate(points).statistics(); }, of_insertion,
      insertion_phases);
}

TEST_P(ReportedProgress, Stars) {
  const Points xy = uniform_points(20000, 7);
  const DevicePoints points = upload(xy);
  Options bounded = options(Strategy::stars);
  bounded.max_memory = 2 * 65536 + 83 * xy.size() / 2;  // the triangles are put in order where they are
  const Counted of_host = [&](Triangulator& t) { return t.triangulate(Reals(xy)).statistics(); };
  const Counted of_device = [&](Triangulator& t) { return t.triangulate(points).statistics(); };
  expect_reports(options(Strategy::stars), of_host, of_stars, with(star_phases, {"copy"}));
  expect_reports(options(Strategy::stars), of_device, of_stars, star_phases);
  expect_reports(bounded, of_host, without(of_stars, "output 0.95"), with(star_phases, {"copy"}));
}

/// Of few points all stars are wrapped, and there is nothing to join.
TEST_P(ReportedProgress, WrappedStars) {
  const Points xy = {0, 0, 1, 0, 0, 1, 3, 3};
  expect_reports(options(Strategy::stars), [&](Triangulator& t) { return t.triangulate(Reals(xy)).statistics(); },
                 {"sort 0", "sort 0.01", "stars 0.1", "stars 0.5", "output 0.9", "output 0.95", "output 1"},
                 {"upload", "bounds", "sort", "gather", "tiles", "stars", "wrap", "certify", "output", "copy"});
}

/// Repeated sweeps report nothing twice: here three find edges that could not be read.
TEST_P(ReportedProgress, RepeatedPasses) {
  using namespace device_text;
  const Points xy = uniform_points(20000, 7);
  const Buffer* counts = nullptr;
  int unsettled = 0;
  faults->change_launch = [&](KernelId kernel, std::vector<Arg>& args) {
    counts = kernel == KernelId::cadt_legality_sweep ? args[args.size() - 3].buffer() : nullptr;
  };
  faults->change_read = [&](const Buffer& from, std::size_t offset, void* to, std::size_t bytes) {
    const std::size_t at = (CADT_DEFERRED_COUNTS + 2) * sizeof(std::uint32_t);
    if (&from != counts || offset + bytes <= at || unsettled++ % 4 == 3) return;
    const std::uint32_t one = 1;
    std::memcpy(static_cast<std::byte*>(to) + (at - offset), &one, sizeof one);
  };
  Names reports = of_insertion;  // a sweep that is not the last one has its own report
  std::ranges::replace(reports, "output 0.9", "certify 0.9");
  const Counted call = [&](Triangulator& t) {
    unsettled = 0;
    const Statistics statistics = t.triangulate(Reals(xy)).statistics();
    EXPECT_EQ(statistics.legality_sweeps, 4U);
    return statistics;
  };
  expect_reports(options(Strategy::locks), call, reports, with(insertion_phases, {"copy"}));
}

/// Reports before the segments are 0.7 of those without.
TEST_P(ReportedProgress, Segments) {
  const Points xy = uniform_points(20000, 7);
  const std::vector<Segment> segments = {{0, 1}};
  const Counted call = [&](Triangulator& t) {
    return t.triangulate_constrained(Reals(xy), segments).mesh().statistics();
  };
  expect_reports(options(Strategy::locks), call,
                 {"sort 0", "sort 0.007", "insert", "constrain", "certify 0.9", "output 0.95", "output 1"},
                 with(insertion_phases, {"constrain", "copy"}));
}

/// A stop that is requested in a launch with segments takes effect before the next one.
TEST_P(ReportedProgress, SegmentsCanBeStopped) {
  Points xy = uniform_points(2000, 7);
  std::vector<Segment> segments;
  for (int i = 0; i < 30; ++i) {
    const auto v = static_cast<std::int32_t>(xy.size() / 2);
    xy.insert(xy.end(), {-1, i / 30.0, 2, i / 30.0 + 0.01});
    segments.push_back({v, v + 1});
  }
  Triangulator triangulator(options(Strategy::locks));
  int launches = 0;
  faults->change_launch = [&](KernelId kernel, std::vector<Arg>&) {
    launches += kernel == KernelId::cadt_find_segments ? 1 : 0;
  };
  const Hash128 expected = triangulator.triangulate_constrained(Reals(xy), segments).hash();
  const int all = launches;
  EXPECT_GT(all, 2);
  int stopped = 0;
  for (int stop_at = 1; stop_at < all; ++stop_at) {
    cadt::stop_source source;
    launches = 0;
    faults->change_launch = [&](KernelId kernel, std::vector<Arg>&) {
      if (kernel == KernelId::cadt_find_segments && ++launches == stop_at) source.request_stop();
    };
    triangulator.options().stop = source.get_token();
    try {
      (void)triangulator.triangulate_constrained(Reals(xy), segments);
      EXPECT_LE(launches, stop_at);  // how many there are depends on the threads: the last one may be that of the stop
    } catch (const Cancelled&) {
      ++stopped;
      EXPECT_EQ(launches, stop_at);
    }
    triangulator.options().stop = {};
    EXPECT_EQ(triangulator.triangulate_constrained(Reals(xy), segments).hash(), expected);
  }
  EXPECT_GT(stopped, 0);
}

CADT_ON_MAIN_BACKENDS(ReportedProgress);

}  // namespace
}  // namespace cadt::test
