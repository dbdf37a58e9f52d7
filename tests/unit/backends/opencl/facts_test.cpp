// SPDX-License-Identifier: Apache-2.0
// Devices that this machine does not have.
#include "backends/opencl/facts.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace cadt::opencl {
namespace {

TEST(OpenClFacts, CompleteDeviceIsUsable) { EXPECT_EQ(unusable_reason(Facts{}), ""); }

TEST(OpenClFacts, EachMissingPropertyIsNamed) {
  struct Case {
    std::function<void(Facts&)> spoil;
    const char* named;
  };
  const Case cases[] = {
      {[](Facts& f) { f.available = false; }, "not available"},
      {[](Facts& f) { f.compiler = false; }, "compiler"},
      {[](Facts& f) { f.little_endian = false; }, "endian"},
      {[](Facts& f) { f.fp64 = f.float_round_to_nearest = false; }, "cl_khr_fp64"},
      {[](Facts& f) { f.denormals = false; }, "CL_FP_DENORM"},
      {[](Facts& f) { f.version = 110; }, "offers 1.1"},
      {[](Facts& f) { f.round_to_nearest = false; }, "CL_FP_ROUND_TO_NEAREST"},
  };
  for (const Case& c : cases) {
    Facts facts;
    c.spoil(facts);
    EXPECT_NE(unusable_reason(facts).find(c.named), std::string::npos) << c.named << ": " << unusable_reason(facts);
  }
}

// docs/decisions/0004-exact-integers-and-floats.md
TEST(OpenClFacts, WithoutDoublesFloatsMustBeRoundedToNearest) {
  Facts facts;
  facts.fp64 = facts.denormals = facts.round_to_nearest = facts.float_denormals = false;
  EXPECT_EQ(unusable_reason(facts), "");
  facts.float_round_to_nearest = false;
  EXPECT_NE(unusable_reason(facts), "");
}

TEST(OpenClFacts, Version) {
  EXPECT_EQ(parse_version("OpenCL 1.2 CUDA"), 120);
  EXPECT_EQ(parse_version("OpenCL 3.0 PoCL HSTR: x"), 300);
  EXPECT_EQ(parse_version("OpenCL 12.4"), 1240);
  for (const char* text : {"", "OpenCL", "OpenCL ", "OpenCL 3", "OpenCL 3.", "OpenCL x.y", "opencl 3.0"})
    EXPECT_EQ(parse_version(text), 0) << text;
}

TEST(OpenClFacts, Atomics) {
  Facts facts;
  facts.acquire_release = true;
  EXPECT_EQ(expected_atomics(facts), "CL3.0 acquire/release, device scope");
  facts.version = 210;
  EXPECT_EQ(expected_atomics(facts), "CL2.0 acquire/release, device scope");
  facts.version = 300;
  facts.acquire_release = false;
  EXPECT_NE(expected_atomics(facts).find("tried when opened"), std::string::npos);
  facts.version = 120;
  EXPECT_EQ(expected_atomics(facts), best_effort_atomics);
}

}  // namespace
}  // namespace cadt::opencl
