// SPDX-License-Identifier: Apache-2.0
// What a program from the cache depends on. A driver that is updated keeps its device's name, so each word of the
// identity is changed alone here.
#include <functional>

#include "backends/opencl/kernel_source.hpp"
#include "backends/opencl/program.hpp"
#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

constexpr const char* source = "__kernel void nothing(__global int* p) { *p = 1; }";
constexpr const char* options = "-cl-std=CL1.2";

class OpenClProgram : public OpenClTest {
 protected:
  void SetUp() override {
    OpenClTest::SetUp();
    if (index < 0) return;
    found = opencl::find_devices().devices.at(static_cast<std::size_t>(index));
    context = cl::Context(found.device);
  }

  /// Builds for a device that calls itself `device`; whether the program came from the cache.
  bool hit(const opencl::FoundDevice& device, const std::string& text = source, const std::string& with = options) {
    bool from_cache = true;
    const cl::Program program = opencl::build_program(context, device, text, with, &from_cache);
    EXPECT_NE(program(), nullptr);
    return from_cache;
  }

  opencl::FoundDevice found;
  cl::Context context;
};

// The list of kernels and the files of kernels_cl say the same.
TEST(OpenClSource, EachKernelIsInTheProgramOfItsStage) {
  for (std::size_t kernel = 0; kernel < kernel_count; ++kernel) {
    const std::string head = std::string(kernel_names[kernel]) + ", ";
    EXPECT_NE(opencl::kernel_source(stage_of(static_cast<KernelId>(kernel))).find(head), std::string::npos) << head;
  }
}

struct Change {
  const char* what;
  std::function<std::string*(opencl::FoundDevice&)> word;
};

TEST_F(OpenClProgram, EachWordOfTheIdentityIsInTheKey) {
  const std::array<Change, 5> changes = {{
      {"name of the device", [](opencl::FoundDevice& d) { return &d.info.name; }},
      {"vendor", [](opencl::FoundDevice& d) { return &d.vendor; }},
      {"version of the device", [](opencl::FoundDevice& d) { return &d.device_version; }},
      {"version of the driver", [](opencl::FoundDevice& d) { return &d.info.driver; }},
      {"version of the platform", [](opencl::FoundDevice& d) { return &d.platform_version; }},
  }};
  ASSERT_FALSE(hit(found));
  ASSERT_TRUE(hit(found));
  for (const Change& change : changes) {
    opencl::FoundDevice other = found;
    ASSERT_FALSE(change.word(other)->empty()) << change.what << ": the driver has none, so that it tells nothing";
    *change.word(other) += '1';
    EXPECT_FALSE(hit(other)) << change.what;
    EXPECT_TRUE(hit(other)) << change.what;
    // An end that moves from one word to the next is another identity as well.
    opencl::FoundDevice shorter = found;
    change.word(shorter)->pop_back();
    EXPECT_FALSE(hit(shorter)) << change.what;
  }
  EXPECT_FALSE(hit(found, std::string(source) + "\n"));
  EXPECT_FALSE(hit(found, source, std::string(options) + " -DMARK"));
  EXPECT_TRUE(hit(found));
}

}  // namespace
}  // namespace cadt::test
