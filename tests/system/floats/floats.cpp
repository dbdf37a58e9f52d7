// SPDX-License-Identifier: Apache-2.0
#include "tests/system/floats/floats.hpp"

#include "tests/support/device_choice.hpp"
#include "tests/support/mesh_checks.hpp"

#include <algorithm>
#include <limits>

namespace cadt::test {

bool are_floats(const Points& xy) {
  return std::ranges::all_of(xy, [](double v) { return static_cast<double>(static_cast<float>(v)) == v; });
}

Floats floats_of(const Points& xy) {
  constexpr double most = std::numeric_limits<float>::max();
  Floats floats;
  for (const double v : xy) floats.push_back(static_cast<float>(std::clamp(v, -most, most)));
  return floats;
}

Points doubles_of(const Floats& xy) { return {xy.begin(), xy.end()}; }

Options float_options() {
  Options options;
  options.backend = Backend::opencl;
  options.device = chosen_device(Backend::opencl);
  return options;
}

Options host_options() {
  Options options;
  options.backend = Backend::host;
  return options;
}

void FloatTest::SetUp() {
  for (const DeviceInfo& device : list_devices())
    if (device.backend == Backend::opencl && device.reason.find("cl_khr_fp64") != std::string::npos)
      FAIL() << device.name << ": " << device.reason;
  if (const std::string reason = unavailable(Backend::opencl); !reason.empty()) {
    if (required(Backend::opencl)) FAIL() << reason;
    GTEST_SKIP() << reason;
  }
}

void FloatTest::check(const Floats& xy, const std::string& name, Options options) {
  const Triangulation mesh = triangulate(FloatSpan(xy), options), host = triangulate(FloatSpan(xy), host_options());
  EXPECT_EQ(mesh.hash(), host.hash()) << name;
  EXPECT_EQ(mesh.dimension(), host.dimension()) << name;
  EXPECT_TRUE(std::ranges::equal(mesh.triangles(), host.triangles())) << name;
  EXPECT_TRUE(std::ranges::equal(mesh.neighbors(), host.neighbors())) << name;
  EXPECT_TRUE(std::ranges::equal(mesh.hull(), host.hull())) << name;
  EXPECT_TRUE(mesh.statistics().certified) << name;
  EXPECT_EQ(mesh.statistics().backend, "opencl") << name;
  const Points same = doubles_of(xy);
  EXPECT_TRUE(same_mesh(mesh, expected_mesh(same))) << name;
  EXPECT_TRUE(verified(same, mesh)) << name;
}

}  // namespace cadt::test
