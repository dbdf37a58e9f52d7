// SPDX-License-Identifier: Apache-2.0
#include "devices.hpp"
#include "strided_device.hpp"

#include "common/driver/registry.hpp"
#include "common/verify/device/verify_on_device.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/report_checks.hpp"

#include <gtest/gtest.h>

using cadt::Backend;

const std::vector<OpenDevice>& open_devices() {
  // Never closed: the runtimes of some devices are gone before static objects are.
  static const auto* const devices = [] {
    auto* list = new std::vector<OpenDevice>;
    const auto open = [&](std::string name, const cadt::Options& options) {
      list->push_back({std::move(name), options, cadt::open_device(options)});
    };
    for (const Backend backend : {Backend::host, Backend::opencl, Backend::cuda}) {
      cadt::Options options;
      options.backend = backend;
      options.threads = 2;
      if (const std::string reason = cadt::test::unavailable(backend); reason.empty()) {
        open(std::string(to_string(backend)), options);
      } else if (cadt::test::required(backend)) {
        ADD_FAILURE() << "back end '" << to_string(backend) << "' is required and not there: " << reason;
      }
    }
    cadt::Options tiny;
    tiny.backend = Backend::host;
    tiny.threads = 3;
    tiny.tuning.grain = 1;
    open("host in tiny pieces", tiny);
    list->push_back({"strided as on a GPU", tiny, strided_device(*list->front().device)});
    return list;
  }();
  return *devices;
}

cadt::VerifyReport on_host_and_devices(cadt::PointsView points, const cadt::MeshView& mesh,
                                       const cadt::VerifyOptions& options) {
  cadt::VerifyReport host = verify(points, mesh, options);
  for (const OpenDevice& d : open_devices()) {
    SCOPED_TRACE(d.name);
    cadt::test::expect_same_report(verify_on_device(*d.device, points, mesh, d.options, options), host);
  }
  return host;
}
