// SPDX-License-Identifier: Apache-2.0
// Control of the tests on an OpenCL device: a fault in each stage of the predicates, planted in the text that the
// device's compiler gets, must show in the words of the kernel. It also proves that the stage ran on the device.
// mutants.py plants many more on the host.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "backends/opencl/open.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/device_choice.hpp"
#include "tests/unit/predicates/cases.hpp"
#include "tests/unit/predicates/words.hpp"

namespace cadt::opencl {
[[nodiscard]] std::string signs_source();
}  // namespace cadt::opencl

namespace cadt::test {
namespace {

struct Fault {
  const char *name, *set, *from, *to;
};

const Fault faults[] = {
    {"none", "near_line", "", ""},
    {"orientation_bound", "near_line", "3.3306690738754716e-16", "4.1633363423443395e-17"},
    {"contraction", "near_line", "det = left - right;", "det = fma(ux, vy, -right);"},
    {"incircle_bound", "near_circle", "CADT_INCIRCLE_BOUND 1.1102230246251577e-15",
     "CADT_INCIRCLE_BOUND 1.3877787807814471e-16"},
    {"carry_128", "longest_integers", " + (r.low < a.low ? 1ul : 0ul))", ")"},
    {"carry_192", "longest_integers", "high += middle < right ? 1ul : 0ul;", ""},
    {"carry_256", "longest_integers", "over += product[1] < right ? 1ul : 0ul;", ""},
    {"carry_limbs", "far_octets", "out[i + m] = CADT_CAST(cadt_u32, carry);", "out[i + m] = 0u;"},
    {"tie_order", "lattices", "return cadt_less(a.x, b.x) ||", "return cadt_less(b.x, a.x) ||"},
};

class OpenClFaults : public testing::TestWithParam<Fault> {};

TEST_P(OpenClFaults, AreSeen) {
  if (const std::string reason = unavailable(Backend::opencl); !reason.empty()) {
    if (required(Backend::opencl)) FAIL() << reason;
    GTEST_SKIP() << reason;
  }
  opencl::OpenRequest request;
  request.source = opencl::signs_source();
  request.fresh = true;
  const std::vector<DeviceInfo> devices = list_devices();
  const auto chosen = std::find_if(devices.begin(), devices.end(), [](const DeviceInfo& d) {
    return d.backend == Backend::opencl && d.usable && is_chosen(d);
  });
  ASSERT_NE(chosen, devices.end());
  request.index = chosen->index;
  const Fault& fault = GetParam();
  if (*fault.from != '\0') {
    const std::size_t at = request.source.find(fault.from);
    ASSERT_NE(at, std::string::npos) << "the text has changed: " << fault.from;
    request.source.replace(at, std::string(fault.from).size(), fault.to);
  }
  const std::unique_ptr<Device> device = opencl::open_device(request);
  const SignSet set = generated_set(fault.set);
  const WrongSigns wrong = compare(set.narrow, words_of(*device, set.narrow, KernelVariant::narrow));
  if (*fault.from == '\0')
    EXPECT_EQ(wrong.fields, 0u);
  else
    EXPECT_NE(wrong.fields, 0u) << "nobody saw it";
}

INSTANTIATE_TEST_SUITE_P(Planted, OpenClFaults, testing::ValuesIn(faults),
                         [](const auto& fault) { return std::string(fault.param.name); });

}  // namespace
}  // namespace cadt::test
