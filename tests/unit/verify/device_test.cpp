// SPDX-License-Identifier: Apache-2.0
// The verifier on devices: each of its stages is taken where it should be, it says what the host says about the mesh of
// every family and file, and a kernel that does not run is noticed.
#include "rejection.hpp"

#include "common/driver/registry.hpp"
#include "common/verify/device/verify_on_device.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/data_files.hpp"
#include "tests/support/families.hpp"
#include "tests/support/report_checks.hpp"

#include <cfloat>
#include <cmath>
#include <functional>

namespace cadt::test {
namespace {

Triangulation mesh_of(const Points& xy) {
  Options options;
  options.backend = Backend::host;
  return triangulate(std::span<const double>(xy), options);
}

/// Compares all devices with the host for a valid mesh, and for one in which an edge has been flipped if there is one.
void compare(const Points& xy) {
  const PointsView points = std::span<const double>(xy);
  const Triangulation mesh = mesh_of(xy);
  const VerifyReport host = verify(points, mesh);
  EXPECT_TRUE(host.ok) << host.summary();
  for (const OpenDevice& d : open_devices()) {
    SCOPED_TRACE(d.name);
    MeshView view{mesh.triangles(), mesh.neighbors(), mesh.hull(), mesh.duplicates(), true};
    expect_same_report(verify_on_device(*d.device, points, view, d.options, {}), host);
  }
}

void compare_moved(const Points& xy, std::size_t point) {
  const Triangulation mesh = mesh_of(xy);
  if (mesh.dimension() < 2) return;
  Points moved = xy;
  moved[2 * (point % (xy.size() / 2))] = 0.5 * xy[0] + 0.25 * xy[2];
  (void)on_host_and_devices(std::span<const double>(moved),
                            MeshView{mesh.triangles(), mesh.neighbors(), {}, {}, false});
}

TEST(OnDevices, EveryFamily) {
  for (const FamilyGroup& group : family_groups())
    for (const Family& family : group.families()) {
      SCOPED_TRACE(family.name);
      const Points xy = family.make();
      compare(xy);
      if (xy.size() > 6) compare_moved(xy, xy.size() / 5);
      if (HasFailure()) return;
    }
}

TEST(OnDevices, EveryFile) {
  if (!data_folder()) GTEST_SKIP() << "no data: set CADT_DATA_DIR";
  int examined = 0;
  for (const ExactCounts& counts : expected_of_files()) {
    if (counts.not_finite) continue;
    SCOPED_TRACE(counts.name);
    compare(hard_file(counts.name));
    ++examined;
  }
  for (const RealSet& set : real_sets()) {
    if (set.points > 120000) continue;
    SCOPED_TRACE(set.name);
    compare(read(set));
    ++examined;
  }
  EXPECT_GT(examined, 50);
}

/// What only the predicates of the host can reject.
TEST(OnDevices, WrongDiagonalOfExtremeExponent) {
  for (const int exponent : {0, -600, 400}) {
    const auto names = [&](const Points& xy, std::vector<std::int32_t> triangles) {
      return failed(
          on_host_and_devices(std::span<const double>(scaled(xy, exponent)), MeshView{triangles, {}, {}, {}, false}));
    };
    const Points kite = {0, 0, 4, -1, 8, 0, 4, 1}, square = {0, 0, 1, 0, 1, 1, 0, 1};
    EXPECT_EQ(names(kite, {0, 1, 2, 0, 2, 3}), Names{"delaunay"});
    EXPECT_EQ(names(kite, {0, 1, 3, 1, 2, 3}), Names{});
    EXPECT_EQ(names(square, {0, 1, 2, 0, 2, 3}), Names{"ties"});
    EXPECT_EQ(names(square, {0, 1, 3, 1, 2, 3}), Names{});
  }
}

/// Several launches, several elements to each work-item, and undecided signs in the last of them.
TEST(OnDevices, LatticeOfMoreThanOneLaunch) {
  compare(grid_points(900, 700));
  compare(scaled(grid_points(400, 300), -600));
}

/// One test per configuration of a back end, through the public function.
class VerifyOnDevice : public BackendTest {
 protected:
  [[nodiscard]] VerifyReport report(const Points& xy) const {
    const Triangulation mesh = mesh_of(xy);
    VerifyReport r = verify_on_device(std::span<const double>(xy), mesh, GetParam().options());
    EXPECT_TRUE(r.ok) << r.summary();
    EXPECT_EQ(r.triangles_examined, mesh.number_of_triangles());
    EXPECT_EQ(2 * r.edges_examined + mesh.hull().size(), 3 * mesh.number_of_triangles());
    EXPECT_EQ(r.signs_filtered + r.signs_exact + r.signs_on_host, r.triangles_examined + r.edges_examined);
    return r;
  }
};

TEST_P(VerifyOnDevice, FilterDecidesRandomPoints) {
  const VerifyReport r = report(uniform_points(50000));
  EXPECT_LT(r.signs_exact, 50U);
  EXPECT_EQ(r.signs_on_host, 0U);
}

TEST_P(VerifyOnDevice, ExactSumsDecideLattices) {
  const VerifyReport r = report(grid_points(300, 200));
  EXPECT_EQ(r.ties, 299U * 199U);
  EXPECT_EQ(r.signs_exact, r.ties);
  EXPECT_EQ(r.signs_on_host, 0U);
  const VerifyReport far = report(moved(grid_points(300, 200), 500000, 5600000));
  EXPECT_EQ(far.ties, r.ties);
  EXPECT_EQ(far.signs_on_host, 0U);
}

TEST_P(VerifyOnDevice, FewSignsOfTiltedLatticesGoToTheHost) {
  Points xy;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j) xy.insert(xy.end(), {0.6 * i - 0.8 * j + 0.1, 0.8 * i + 0.6 * j + 0.1});
  const VerifyReport r = report(xy);
  EXPECT_GT(r.signs_exact, 10000U);
  EXPECT_LT(r.signs_on_host, 2000U);
  EXPECT_GT(r.signs_on_host, 0U);
}

TEST_P(VerifyOnDevice, HostDecidesExtremeExponents) {
  for (const int exponent : {-1030, -600, 400, 1000}) {
    const VerifyReport r = report(scaled(grid_points(60, 50), exponent));
    EXPECT_EQ(r.ties, 59U * 49U);
    EXPECT_GE(r.signs_on_host, r.edges_examined) << exponent;
  }
  const VerifyReport r =
      report({DBL_MAX, DBL_MAX, -DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX, DBL_MAX, -DBL_MAX, 0, 0, 1, 1});
  EXPECT_EQ(r.signs_on_host, r.triangles_examined + r.edges_examined);
}

TEST_P(VerifyOnDevice, AnyFormOfTheInput) {
  const TestMesh m = lattice(6, 5);
  const std::vector<float> single(m.xy.begin(), m.xy.end());
  std::vector<double> x, y;
  for (std::size_t i = 0; i < m.xy.size(); i += 2) x.push_back(m.xy[i]), y.push_back(m.xy[i + 1]);
  EXPECT_TRUE(verify_on_device(std::span<const float>(single), m.view(), GetParam().options()).ok);
  EXPECT_TRUE(verify_on_device(PointsView(x, y), m.bare(), GetParam().options()).ok);
  std::swap(x[0], x[29]);
  EXPECT_FALSE(verify_on_device(PointsView(x, y), m.view(), GetParam().options()).ok);
}

TEST_P(VerifyOnDevice, NamesTheFirstPointThatIsNotFinite) {
  const TestMesh m = lattice(100, 100);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    std::vector<double> xy = m.xy;
    xy[9001] = bad, xy.back() = bad;
    try {
      (void)verify_on_device(std::span<const double>(xy), m.view(), GetParam().options());
      FAIL() << "accepted";
    } catch (const InputError& e) {
      EXPECT_EQ(e.index(), 4500U);
    }
  }
}

TEST_P(VerifyOnDevice, OwnResultIsHeldToMore) {
  const Points xy = uniform_points(200), other = uniform_points(201);
  expect_killed_by(verify_on_device(std::span<const double>(other), mesh_of(xy), GetParam().options()), "counts");
}

TEST_P(VerifyOnDevice, StopsAndRespectsTheMemoryBound) {
  const Points xy = uniform_points(20000);
  const Triangulation mesh = mesh_of(xy);
  Options options = GetParam().options();
  cadt::stop_source stop;
  options.stop = stop.get_token();
  options.progress = [&](const Progress& progress) {
    EXPECT_EQ(progress.phase, "verify");
    stop.request_stop();
  };
  EXPECT_THROW((void)verify_on_device(std::span<const double>(xy), mesh, options), Cancelled);
  options = GetParam().options();
  options.max_memory = 1000;
  EXPECT_THROW((void)verify_on_device(std::span<const double>(xy), mesh, options), OutOfMemory);
}
CADT_ON_MAIN_BACKENDS(VerifyOnDevice);

/// A host device that does not run one kernel, or not for all of its work-items.
class Lazy final : public Device {
 public:
  Lazy(Device& device, KernelId kernel, bool half) : device_(device), kernel_(kernel), half_(half) {}
  int skipped = 0;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return device_.info(); }
  [[nodiscard]] LaunchShape shape() const noexcept override { return device_.shape(); }
  [[nodiscard]] unsigned threads() const noexcept override { return device_.threads(); }
  [[nodiscard]] std::unique_ptr<Buffer> allocate(std::size_t bytes) override { return device_.allocate(bytes); }
  [[nodiscard]] std::unique_ptr<Buffer> alias(const void* data, std::size_t bytes) override {
    return device_.alias(data, bytes);
  }
  [[nodiscard]] std::unique_ptr<Buffer> wrap(void* handle, std::size_t bytes) override {
    return device_.wrap(handle, bytes);
  }
  [[nodiscard]] void* handle(const Buffer& buffer) const noexcept override { return device_.handle(buffer); }
  void write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) override {
    device_.write(to, offset, from, bytes);
  }
  void read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) override {
    device_.read(from, offset, to, bytes);
  }
  void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) override {
    device_.fill(to, offset, bytes, word);
  }
  using Device::launch;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant build,
              std::uint32_t group) override {
    if (kernel == kernel_) ++skipped, items = half_ ? items / 2 : 0;
    if (items != 0) device_.launch(kernel, items, args, build, group);
  }
  void finish() override { device_.finish(); }

 private:
  Device& device_;
  KernelId kernel_;
  bool half_;
};

TEST(OnDevices, KernelThatDoesNotRunIsNoticed) {
  // every stage has work, and there are duplicates
  Points xy = scaled(grid_points(40, 40), 400);
  for (const double v : grid_points(40, 40)) xy.push_back(v + 1);
  for (std::size_t i = 0; i < 400; ++i) xy.push_back(xy[i]);
  const Triangulation mesh = mesh_of(xy);
  const MeshView view{mesh.triangles(), mesh.neighbors(), mesh.hull(), mesh.duplicates(), true};
  const OpenDevice& host = open_devices().front();
  const PointsView points = std::span<const double>(xy);
  const VerifyReport good = verify_on_device(*host.device, points, view, host.options, {});
  ASSERT_TRUE(good.ok) << good.summary();
  ASSERT_GT(good.signs_exact, 1000U);
  ASSERT_GT(good.signs_on_host, 1000U);
  ASSERT_EQ(mesh.duplicates().size(), 200U);
  for (const bool half : {false, true})
    for (const KernelId kernel :
         {KernelId::cadt_verify_structure, KernelId::cadt_verify_points, KernelId::cadt_verify_duplicates,
          KernelId::cadt_verify_boundary, KernelId::cadt_verify_filter, KernelId::cadt_verify_exact,
          KernelId::cadt_verify_gather}) {
      SCOPED_TRACE(kernel_names[static_cast<std::size_t>(kernel)]);
      Lazy lazy(*host.device, kernel, half);
      const VerifyReport report = verify_on_device(lazy, points, view, host.options, {});
      EXPECT_GT(lazy.skipped, 0);
      expect_killed_by(report, "counts");
    }
}

/// Without coordinates and triangles on the host.
TEST(OnDevices, MeshThatIsOnlyInDeviceMemory) {
  for (const bool flipped : {false, true})
    for (const bool listed : {false, true}) {
      TestMesh m = lattice(30, 20);
      m.xy.insert(m.xy.end(), {m.xy[8], m.xy[9]});
      m.complete();
      if (flipped) std::swap(m.triangles[300], m.triangles[301]);
      const VerifyReport expected =
          verify(m.points(), MeshView{m.triangles, m.neighbors, m.hull, m.duplicates, listed});
      EXPECT_EQ(expected.ok, !flipped);
      for (const OpenDevice& d : open_devices()) {
        SCOPED_TRACE(d.name);
        Statistics statistics;
        cadt::Memory memory(*d.device, false);
        cadt::Context ctx(*d.device, memory, d.options, statistics);
        const Allocation points = ctx.memory.import(m.xy.data(), m.xy.size() * sizeof(double));
        const Allocation triangles = ctx.memory.import(m.triangles.data(), m.triangles.size() * 4);
        const Allocation neighbors = ctx.memory.import(m.neighbors.data(), m.neighbors.size() * 4);
        const Allocation no_flags;
        const auto count = static_cast<std::uint32_t>(m.size());
        const VerifyInput input{
            {points, triangles, neighbors, no_flags, count, count, 0}, m.xy.size() / 2, m.hull, m.duplicates, listed};
        expect_same_report(verify_on_device(ctx, input, {}), expected);
      }
    }
}

}  // namespace
}  // namespace cadt::test
