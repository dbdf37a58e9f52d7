// SPDX-License-Identifier: Apache-2.0
// The verifier on every device of this machine beside that of the host: both must say the same.
#pragma once

#include "common/driver/device.hpp"

#include <cadt/verify.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

struct OpenDevice {
  std::string name;
  cadt::Options options;
  std::unique_ptr<cadt::Device> device;
};

/// One device of each back end that is there, opened once; of the host also one that works in tiny pieces and
/// one that works as a GPU does. A back end in CADT_REQUIRE_BACKENDS that is not there fails the test.
const std::vector<OpenDevice>& open_devices();

/// The report of the host, after all devices have been held against it: every check, every count.
cadt::VerifyReport on_host_and_devices(cadt::PointsView points, const cadt::MeshView& mesh,
                                       const cadt::VerifyOptions& options = {});
