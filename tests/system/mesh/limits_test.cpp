// SPDX-License-Identifier: Apache-2.0
// Bad input, limits, cancellation, progress, and back ends that are not there.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <limits>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

// The index that InputError carries, or -1 if there was none.
long refused_at(PointsView points, const Options& options) {
  try {
    (void)triangulate(points, options);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(error.index())), std::string::npos) << error.what();
    return static_cast<long>(error.index());
  }
  return -1;
}

class Limits : public BackendTest {};

TEST_P(Limits, NamesTheFirstBadPoint) {
  const Options options = GetParam().options();
  for (const std::size_t n : {1u, 2u, 3u, 1000u, 50000u}) {
    for (const double bad : {nan, infinity, -infinity}) {
      for (const std::size_t at : {std::size_t{0}, n / 2, n - 1}) {
        for (const std::size_t axis : {0u, 1u}) {
          Points xy = uniform_points(n);
          xy[2 * at + axis] = bad;
          xy[2 * n - 1] = bad;  // a later one must not be the one that is named
          ASSERT_EQ(refused_at(Reals(xy), options), static_cast<long>(at)) << n << " points, axis " << axis;
        }
      }
    }
  }
}

TEST_P(Limits, NamesTheFirstBadFloat) {
  std::vector<float> x(5000, 1.0f), y(5000, 2.0f);
  y[1234] = std::numeric_limits<float>::quiet_NaN();
  x[1235] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(refused_at(PointsView(std::span<const float>(x), std::span<const float>(y)), GetParam().options()), 1234);
}

TEST_P(Limits, RefusesTooManyPoints) {
  // Both arrays are one mapping of pages that nobody ever touched: the refusal must come before any work.
  const std::size_t count = max_points() + 1, bytes = count * sizeof(float);
  void* pages = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(pages, MAP_FAILED);
  const std::span<const float> zeros(static_cast<const float*>(pages), count);
  try {
    (void)triangulate(PointsView(zeros, zeros), GetParam().options());
    ADD_FAILURE() << "accepted";
  } catch (const LimitError& error) {
    EXPECT_EQ(error.count(), count);
    EXPECT_EQ(error.limit(), max_points());
  }
  munmap(pages, bytes);
}

TEST_P(Limits, MaxMemoryIsABound) {
  const Points xy = uniform_points(20000);
  Options options = GetParam().options();
  const Triangulation unbounded = triangulate(Reals(xy), options);
  const auto peak = static_cast<std::size_t>(unbounded.statistics().bytes_device_peak);

  options.max_memory = peak / 4;
  try {
    (void)triangulate(Reals(xy), options);
    ADD_FAILURE() << "ran in a quarter of the memory";
  } catch (const OutOfMemory& error) {
    EXPECT_GT(error.needed(), options.max_memory);
    EXPECT_EQ(error.available(), options.max_memory);
  }

  options.max_memory = 2 * peak;
  const Triangulation bounded = triangulate(Reals(xy), options);
  EXPECT_EQ(bounded.hash(), unbounded.hash());
  EXPECT_LE(bounded.statistics().bytes_device_peak, options.max_memory);
}

TEST_P(Limits, StopsBeforeAndDuringTheWork) {
  const Points xy = uniform_points(20000);
  const ExpectedMesh expected = expected_mesh(xy);
  for (const double when : {-1.0, 0.0, 0.3, 0.6}) {
    cadt::stop_source source;
    Options options = GetParam().options();
    options.stop = source.get_token();
    bool asked = false;
    options.progress = [&](const Progress& progress) {
      if (progress.fraction >= when && when >= 0.0) source.request_stop(), asked = true;
    };
    if (when < 0.0) source.request_stop(), asked = true;
    EXPECT_THROW((void)triangulate(Reals(xy), options), Cancelled) << when;
    EXPECT_TRUE(asked) << "no progress was told at " << when;
    EXPECT_TRUE(same_mesh(triangulate(Reals(xy), GetParam().options()), expected)) << "after a cancelled run";
  }
}

TEST_P(Limits, AnUntouchedStopTokenChangesNothing) {
  cadt::stop_source source;
  const Points xy = uniform_points(1000);
  Options options = GetParam().options();
  options.stop = source.get_token();
  EXPECT_TRUE(same_mesh(triangulate(Reals(xy), options), expected_mesh(xy)));
}

TEST_P(Limits, ProgressNeverDecreases) {
  const std::vector<std::string> order = {"sort", "insert", "certify", "output"};
  for (const std::size_t n : {3u, 20000u}) {
    const Points xy = uniform_points(n);
    double last = 0.0;
    std::size_t calls = 0, phase = 0;
    Options options = GetParam().options();
    options.progress = [&](const Progress& progress) {
      EXPECT_GE(progress.fraction, last);
      EXPECT_LE(progress.fraction, 1.0);
      last = progress.fraction;
      while (phase < order.size() && order[phase] != progress.phase) ++phase;
      EXPECT_LT(phase, order.size()) << "unknown phase, or one that came back: " << progress.phase;
      ++calls;
    };
    (void)triangulate(Reals(xy), options);
    if (n > 1000) {
      EXPECT_GE(calls, 5u);
      EXPECT_GT(last, 0.9);
    }
  }
}

TEST_P(Limits, UnknownDeviceIsRefused) {
  Options options = GetParam().options();
  const Points xy = uniform_points(10);
  for (const char* device : {"no such device", "99"}) {
    options.device = device;
    try {
      (void)triangulate(Reals(xy), options);
      ADD_FAILURE() << "took another device for '" << device << "'";
    } catch (const BackendUnavailable& error) {
      EXPECT_EQ(error.backend(), to_string(GetParam().backend));
      EXPECT_FALSE(error.reason().empty());
    }
  }
}

TEST_P(Limits, DevicesCanBeNamed) {
  const Points xy = uniform_points(100);
  for (const DeviceInfo& device : list_devices()) {
    if (device.backend != GetParam().backend || !device.usable) continue;
    EXPECT_FALSE(device.name.empty());
    EXPECT_TRUE(device.reason.empty()) << device.reason;
    EXPECT_GT(device.compute_units, 0u);
    for (const std::string& name : {std::to_string(device.index), device.name}) {
      Options options = GetParam().options();
      options.device = name;
      EXPECT_EQ(triangulate(Reals(xy), options).statistics().device, device.name) << name;
    }
  }
}
CADT_ON_EVERY_BACKEND(Limits);

TEST(Backends, HaveNames) {
  for (const Backend backend : {Backend::automatic, Backend::host, Backend::opencl, Backend::cuda}) {
    EXPECT_EQ(backend_from_string(to_string(backend)), backend);
  }
  EXPECT_EQ(to_string(Backend::automatic), "auto");
  for (const char* name : {"", "Host", "vulkan", "host "})
    EXPECT_THROW((void)backend_from_string(name), BackendUnavailable);
}

TEST(Backends, AllAreListedAndTheRestSaysWhyNot) {
  for (const Backend backend : {Backend::host, Backend::opencl, Backend::cuda}) {
    std::size_t entries = 0;
    for (const DeviceInfo& device : list_devices()) {
      if (device.backend != backend) continue;
      ++entries;
      EXPECT_EQ(device.usable, device.reason.empty()) << to_string(backend) << ": " << device.reason;
    }
    EXPECT_GT(entries, 0u) << to_string(backend);
  }
  EXPECT_TRUE(unavailable(Backend::host).empty());
}

TEST(Backends, RequiredOnesAreThere) {
  for (const Backend backend : {Backend::host, Backend::opencl, Backend::cuda}) {
    if (required(backend)) {
      EXPECT_EQ(unavailable(backend), "") << to_string(backend);
    }
  }
}

TEST(Backends, WhatIsNotThereIsNeverReplaced) {
  const Points xy = uniform_points(10);
  for (const Backend backend : {Backend::opencl, Backend::cuda}) {
    const std::string reason = unavailable(backend);
    if (reason.empty()) continue;
    const Options options = BackendCase{"", backend, 0, 0}.options();
    try {
      (void)triangulate(Reals(xy), options);
      ADD_FAILURE() << to_string(backend) << " is not there, and something ran";
    } catch (const BackendUnavailable& error) {
      EXPECT_EQ(error.backend(), to_string(backend));
      EXPECT_EQ(error.reason(), reason);
    }
  }
}

TEST(Backends, AutomaticTakesOneThatIsThere) {
  const Points xy = uniform_points(100);
  const Triangulation mesh = triangulate(Reals(xy));
  EXPECT_TRUE(unavailable(backend_from_string(mesh.statistics().backend)).empty());
  EXPECT_TRUE(same_mesh(mesh, expected_mesh(xy)));
}

TEST(Views, RefuseSizesThatDoNotFit) {
  const std::vector<double> odd(5), x(4), y(3);
  EXPECT_THROW((void)PointsView(Reals(odd)), InputError);
  try {
    (void)PointsView(Reals(x), Reals(y));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.index(), 3u);
  }
}

}  // namespace
}  // namespace cadt::test
