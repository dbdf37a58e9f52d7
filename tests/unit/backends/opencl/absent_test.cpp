// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cadt/errors.hpp>

#include "common/driver/backend.hpp"

namespace cadt {
namespace {

void expect_absent(BackendEntry& entry, Backend id, const char* name, const std::string& reason) {
  EXPECT_EQ(entry.id(), id);
  const std::vector<DeviceInfo> devices = entry.devices();
  ASSERT_EQ(devices.size(), 1u);
  EXPECT_EQ(devices[0].backend, id);
  EXPECT_EQ(devices[0].index, -1);
  EXPECT_FALSE(devices[0].usable);
  EXPECT_EQ(devices[0].reason, reason);
  try {
    static_cast<void>(entry.open(0, Options{}));
    ADD_FAILURE() << name << " was opened";
  } catch (const BackendUnavailable& error) {
    EXPECT_EQ(error.backend(), name);
    EXPECT_EQ(error.reason(), reason);
  }
}

TEST(AbsentBackend, GivesItsReason) {
  expect_absent(opencl_backend(), Backend::opencl, "opencl", "not compiled in (test reason)");
  expect_absent(cuda_backend(), Backend::cuda, "cuda", "not compiled in (other reason)");
}

}  // namespace
}  // namespace cadt
