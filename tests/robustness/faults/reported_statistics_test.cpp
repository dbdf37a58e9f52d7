// SPDX-License-Identifier: Apache-2.0
// The statistics of a call, field by field, against the requests that the device counted; the host copy of a mesh on
// the device has the same statistics as the mesh.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

#include <sstream>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

/// All fields, by name.
std::map<std::string, std::string> fields_of(const Statistics& s) {
  std::map<std::string, std::string> fields = {{"backend", s.backend}, {"device", s.device}};
  const std::pair<const char*, std::uint64_t> numbers[] = {{"threads", s.threads},
                                                           {"points", s.points},
                                                           {"distinct", s.distinct},
                                                           {"launches", s.launches},
                                                           {"walk_steps", s.walk_steps},
                                                           {"lock_attempts", s.lock_attempts},
                                                           {"lock_failures", s.lock_failures},
                                                           {"invalid_restarts", s.invalid_restarts},
                                                           {"insert_retries", s.insert_retries},
                                                           {"stale_edges", s.stale_edges},
                                                           {"deferred_points", s.deferred_points},
                                                           {"deferred_edges", s.deferred_edges},
                                                           {"splits", s.splits},
                                                           {"edge_splits", s.edge_splits},
                                                           {"flips", s.flips},
                                                           {"incircle_tests", s.incircle_tests},
                                                           {"orientation_tests", s.orientation_tests},
                                                           {"exact_orientations", s.exact_orientations},
                                                           {"exact_incircles", s.exact_incircles},
                                                           {"ties", s.ties},
                                                           {"legality_sweeps", s.legality_sweeps},
                                                           {"sweep_repairs", s.sweep_repairs},
                                                           {"certified_edges", s.certified_edges},
                                                           {"stabilized_edges", s.stabilized_edges},
                                                           {"illegal_edges", s.illegal_edges},
                                                           {"tiles", s.tiles},
                                                           {"proven_stars", s.proven_stars},
                                                           {"wrapped_stars", s.wrapped_stars},
                                                           {"sets", s.sets},
                                                           {"batched_sets", s.batched_sets},
                                                           {"refined_points", s.refined_points},
                                                           {"inserted_segments", s.inserted_segments},
                                                           {"segment_retries", s.segment_retries},
                                                           {"bytes_device_peak", s.bytes_device_peak},
                                                           {"bytes_to_device", s.bytes_to_device},
                                                           {"bytes_from_device", s.bytes_from_device},
                                                           {"wide_arithmetic", s.wide_arithmetic ? 1 : 0},
                                                           {"certified", s.certified ? 1 : 0}};
  for (const auto& [name, value] : numbers) fields[name] = std::to_string(value);
  for (std::size_t k = 0; k < s.flips_per_edge.size(); ++k)
    fields["flips_per_edge " + std::to_string(k)] = std::to_string(s.flips_per_edge[k]);
  const auto text = [](double value) {
    std::ostringstream out;
    out << std::hexfloat << value;
    return out.str();
  };
  for (const auto& [name, share] : s.thread_time) fields["share of " + name] = text(share);
  for (const auto& [name, time] : s.milliseconds) fields["time of " + name] = text(time);
  for (const KernelTime& kernel : s.kernels)
    fields["kernel " + kernel.name] = std::to_string(kernel.launches) + ", " + text(kernel.milliseconds);
  return fields;
}

/// Some twice, so that there are fewer distinct ones.
Points some_points(std::size_t n) {
  Points xy = uniform_points(n, 17);
  xy.insert(xy.end(), xy.begin(), xy.begin() + 100);
  return xy;
}

class ReportedStatistics : public ResidentTest {
 protected:
  void SetUp() override {
    ResidentTest::SetUp();
    faults->change_launch = [this](KernelId, std::vector<Arg>&) { ++launches; };
  }
  [[nodiscard]] Options options(Strategy strategy) const {
    Options with = ResidentTest::options();
    with.tuning.strategy = strategy;
    return with;
  }
  void expect_told(const Statistics& s, const DeviceInfo& device, std::size_t n, std::size_t distinct,
                   std::uint64_t edges) const {
    EXPECT_EQ(s.backend, to_string(GetParam().backend));
    EXPECT_EQ(s.device, device.name);
    EXPECT_EQ(s.threads, GetParam().backend == Backend::host ? GetParam().threads : device.compute_units);
    EXPECT_EQ(s.points, n);
    EXPECT_EQ(s.distinct, distinct);
    EXPECT_EQ(s.launches, launches);
    EXPECT_EQ(s.bytes_device_peak, faults->most_bytes());
    const bool copies = GetParam().backend != Backend::host;
    EXPECT_EQ(s.bytes_to_device, copies ? faults->copied.to_device : 0);
    EXPECT_EQ(s.bytes_from_device, copies ? faults->copied.from_device : 0);
    EXPECT_EQ(s.certified_edges, edges);
    EXPECT_TRUE(s.certified);
    EXPECT_EQ(s.illegal_edges, 0U);
    EXPECT_GE(s.legality_sweeps, 1U);
    EXPECT_FALSE(s.wide_arithmetic);
    EXPECT_FALSE(s.milliseconds.empty());
    EXPECT_TRUE(s.kernels.empty());
  }

  std::uint64_t launches = 0;
  const std::shared_ptr<Faults> faults = std::make_shared<Faults>();
  const Injection injection{faults};
};

TEST_P(ReportedStatistics, OneSet) {
  const Points xy = some_points(20000);
  const std::size_t n = xy.size() / 2, distinct = n - 50;
  const DevicePoints points = upload(xy);
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    for (const bool on_device : {false, true}) {
      SCOPED_TRACE(std::string(cadt::to_string(strategy)) + (on_device ? ", points of the device" : ""));
      Triangulator triangulator(options(strategy));
      faults->clear();
      launches = 0;
      DeviceTriangulation mesh;
      Statistics s;
      if (on_device) {
        mesh = triangulator.triangulate(points);
        s = mesh.statistics();
      } else {
        s = triangulator.triangulate(Reals(xy)).statistics();
      }
      expect_told(s, triangulator.device(), n, distinct, 3 * distinct - 3);
      EXPECT_EQ(s.sets + s.batched_sets, 0U);
      if (strategy == Strategy::stars) {
        EXPECT_GT(s.proven_stars, distinct / 2);
        EXPECT_EQ(s.tiles == 0, s.proven_stars == 0);
      } else {
        EXPECT_EQ(s.splits + s.edge_splits, distinct - 3);
        EXPECT_EQ(s.proven_stars + s.wrapped_stars + s.tiles, 0U);
      }
      if (on_device) {
        EXPECT_EQ(fields_of(mesh.download().statistics()), fields_of(s));
      }
    }
  }
}

TEST_P(ReportedStatistics, SeveralSets) {
  Points xy = some_points(500);
  std::vector<std::size_t> offsets = {0, xy.size() / 2};
  for (const Points& set : {uniform_points(700, 2), Points{}, Points{1, 2}, Points{0, 0, 1, 1}, some_points(33'000)}) {
    xy.insert(xy.end(), set.begin(), set.end());
    offsets.push_back(xy.size() / 2);
  }
  const std::size_t n = offsets.back(), distinct = n - 100;
  const std::uint64_t edges = 3 * (500 + 700 + 33'000) - 3 * 3;
  const DevicePoints points = upload(xy);
  for (const Strategy strategy : {Strategy::automatic, Strategy::stars}) {
    for (const bool on_device : {false, true}) {
      SCOPED_TRACE(std::string(cadt::to_string(strategy)) + (on_device ? ", points of the device" : ""));
      Triangulator triangulator(options(strategy));
      faults->clear();
      launches = 0;
      DeviceTriangulationBatch batch;
      Statistics s;
      if (on_device) {
        batch = triangulator.triangulate_batch(points, offsets);
        s = batch.statistics();
      } else {
        s = triangulator.triangulate_batch(Reals(xy), offsets).statistics();
      }
      expect_told(s, triangulator.device(), n, distinct, edges);
      EXPECT_EQ(s.sets, 6U);
      EXPECT_EQ(s.batched_sets, 2U);
      if (on_device) {
        EXPECT_EQ(fields_of(batch.download().statistics()), fields_of(s));
      }
    }
  }
}

CADT_ON_MAIN_BACKENDS(ReportedStatistics);

}  // namespace
}  // namespace cadt::test
