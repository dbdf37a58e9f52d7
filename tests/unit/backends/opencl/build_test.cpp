// SPDX-License-Identifier: Apache-2.0
// Builds: the self-test refuses wrong arithmetic by name, errors carry the log, both ways to build the atomics work.
#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

class OpenClBuild : public OpenClTest {
 protected:
  void expect_refused(const opencl::OpenRequest& request, const std::string& probe) const {
    try {
      static_cast<void>(opencl::open_device(request));
      if (info.platform == "Portable Computing Language") FAIL() << "wrong arithmetic was accepted";
    } catch (const BackendUnavailable& error) {
      EXPECT_NE(error.reason().find("fails the self-test '" + probe + "'"), std::string::npos) << error.what();
      EXPECT_NE(error.reason().find(info.name), std::string::npos) << error.what();
    }
  }
};

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << "the source has changed: " << from;
  text.replace(at, from.size(), to);
}

TEST_F(OpenClBuild, EmbeddedKernelsPassTheSelfTest) {
  const ScopedVariable no_cache("CADT_CACHE_DIR", "");  // to store a program PoCL compiles all of its kernels
  const auto device = opencl_backend().open(index, Options{});
  EXPECT_EQ(device->info().name, info.name);
  EXPECT_EQ(device->threads(), info.compute_units);
  EXPECT_EQ(device->shape().contiguous, !info.gpu);
  EXPECT_EQ(device->primitives() != nullptr, info.gpu);
  EXPECT_EQ(counted_items(*device, 1000), 1000u);
}

// PoCL breaks the arithmetic in both cases (measured); another compiler may not, and then is rightly accepted.
TEST_F(OpenClBuild, FastMathIsRefused) {
  opencl::OpenRequest request = small();
  request.extra_options = "-cl-fast-relaxed-math";
  expect_refused(request, "rounding error of a sum");
}

TEST_F(OpenClBuild, ContractionIsRefused) {
  opencl::OpenRequest request = small();
  replace(request.source, "#pragma OPENCL FP_CONTRACT OFF", "#pragma OPENCL FP_CONTRACT ON");
  expect_refused(request, "contraction of a*a+b");
}

// Each probe of the self-test notices the fault that it is for.
TEST_F(OpenClBuild, EachWrongOperationIsNamed) {
  struct Fault {
    const char *from, *to, *probe;
  };
  const Fault faults[] = {
      {"out[0] = in[0] * in[0] + in[1]", "out[0] = fma(in[0], in[0], in[1])", "contraction of a*a+b"},
      {"(in[2] - (s - t)) + (in[3] - t)", "(in[2] + in[3]) - s", "rounding error of a sum"},
      {"out[2] = in[4] * in[5]", "out[2] = 0.0", "gradual underflow of a product"},
      {"out[3] = in[6] - in[7]", "out[3] = 0.0", "gradual underflow of a difference"},
      {"out[4] = in[8] + in[9]", "out[4] = in[8]", "rounding of a sum"},
      {"out[5] = in[10] * in[11]", "out[5] = nextafter(in[10] * in[11], 2.0)", "rounding of a product"},
      {"out[6] = in[12] / in[13]", "out[6] = in[12] * (1.0 / in[13])", "division"},
      {"out[7] = ", "out[7] = 1.0 + ", "64 x 64 bit product"},
      {"words[0] = ", "words[0] = 1u + ", "64 x 64 bit product, low word"},
      {"words[1] = ", "words[1] = 1u + ", "64 x 64 bit product, second word"},
      {"cadt_add_relaxed(words + 2, 1u)", "words[2] = cadt_item", "atomic addition"},
      {"cadt_cas_acq_rel(words + 3, 0u, 7u)", "cadt_item < 2u", "compare-and-swap"},
      {"cadt_min_relaxed(words + 4,", "if (cadt_item == 0u) cadt_min_relaxed(words + 4,", "atomic minimum"},
  };
  for (const Fault& fault : faults) {
    opencl::OpenRequest request = small();
    replace(request.source, fault.from, fault.to);
    try {
      static_cast<void>(opencl::open_device(request));
      ADD_FAILURE() << "accepted: " << fault.to;
    } catch (const BackendUnavailable& error) {
      EXPECT_NE(error.reason().find("'" + std::string(fault.probe) + "'"), std::string::npos)
          << fault.to << ": " << error.what();
    }
  }
}

// Each test of what work-items share notices the fault that it is for. Most faults need two threads that meet, so there
// are several tries.
TEST_F(OpenClBuild, EachFaultOfSharingIsNamed) {
  if (info.gpu) GTEST_SKIP() << "the faults are planted in the text for CPUs";
  struct Fault {
    const char* what;
    std::vector<std::array<const char*, 2>> edits;
    const char* test;
  };
  const Fault faults[] = {
      {"loops end", {{"turn < turns", "turn < turns && turn < 65535u"}}, "a loop of 100000 turns"},
      {"a plain store for a compare-and-swap",
       {{"return atomic_compare_exchange_strong_explicit(CADT_ATOMIC(p), &expected, desired, memory_order_acq_rel,",
         "const cadt_u32 old = *(volatile CADT_GLOBAL cadt_u32*)p;\n"
         "for (volatile cadt_u32 wait = 0u; wait < 100u; ++wait);\n"
         "if (old == expected) *(volatile CADT_GLOBAL cadt_u32*)p = desired;\n"
         "if (1) return old == expected ? 1u : 0u;\n"
         "return atomic_compare_exchange_strong_explicit(CADT_ATOMIC(p), &expected, desired, memory_order_acq_rel,"}},
       ""},
      {"stores that others see after the unlock",
       {{"    cadt_store_vertices(m, t[k], s[k].v0 + 1u,",
         "    if (k == 0u) cadt_unlock(m, &locks);\n"
         "    for (volatile cadt_u32 wait = 0u; wait < 100u; ++wait);\n    cadt_store_vertices(m, t[k], s[k].v0 + 1u,"},
        {"cadt_fence_before_unlock();\n  cadt_unlock(m, &locks);\n  return 1u;", "return 1u;"}},
       ""},
      {"fields from a cache, older than the lock word",
       {{"*w3 = cadt_load_field(p + 3);", ""},
        {"*w7 = cadt_load_field(p + 7);",
         "*w7 = cadt_load_field(p + 7);\n"
         "for (volatile cadt_u32 wait = 0u; wait < 100u; ++wait);\n*w3 = cadt_load_field(p + 3);"}},
       ""},
      {"a lock that is not given up",
       {{"+ CADT_WORD_LOCK, cadt_next_version(c->version[i]));", "+ CADT_WORD_LOCK, c->version[i] | 1u);"}},
       "locks are given up"},
      {"what a launch has left is not seen by the next",
       {{"locks.version[k] = s[k].lock;", "locks.version[k] = items == 1u ? 4u : s[k].lock;"},
        {"cadt_u32* torn) {", "cadt_u32* torn, cadt_u32 items) {"},
        {"&counters, &torn)", "&counters, &torn, items)"}},
       "locks of one work-item alone"},
  };
  for (const Fault& fault : faults) {
    opencl::OpenRequest request = small();
    for (const auto& [from, to] : fault.edits) replace(request.source, from, to);
    bool refused = false;
    for (int tries = 0; tries < 200 && !refused; ++tries) try {
        static_cast<void>(opencl::open_device(request));
      } catch (const BackendUnavailable& error) {
        refused = true;
        EXPECT_NE(error.reason().find("fails the self-test '" + std::string(fault.test)), std::string::npos)
            << fault.what << ": " << error.what();
      }
    EXPECT_TRUE(refused) << "accepted: " << fault.what;
  }
}

TEST_F(OpenClBuild, SelfTestIsRepeatedUntilItPasses) {
  opencl::OpenRequest request = small();
  request.fresh = false;
  replace(request.source, "words[0] = ", "words[0] = 1u + ");
  for (int i = 0; i < 2; ++i) EXPECT_THROW(static_cast<void>(opencl::open_device(request)), BackendUnavailable) << i;
}

// A driver that advertises doubles, whose compiler takes floats for them or does not know them. One that computes
// wrongly is above.
TEST_F(OpenClBuild, DriverThatLiesAboutDoubles) {
  if (!info.fp64) GTEST_SKIP() << "the device does not claim to have doubles";
  for (const char* lie : {"-Ddouble=float", "-Ddouble=no_such_type"}) {
    opencl::OpenRequest request = small();
    request.extra_options = lie;
    EXPECT_THROW(static_cast<void>(opencl::open_device(request)), KernelBuildError) << lie;
  }
}

TEST_F(OpenClBuild, FailureCarriesDeviceOptionsAndLog) {
  opencl::OpenRequest request = small();
  request.source += "\n#line 77 \"broken.h\"\n__kernel void cadt_broken(__global int* p) { *p = no_such_word; }\n";
  request.extra_options = "-DCADT_TEST_MARK=1";
  const auto error = caught<KernelBuildError>([&] { static_cast<void>(opencl::open_device(request)); });
  EXPECT_EQ(error.device(), info.name);
  EXPECT_NE(error.options().find("-DCADT_TEST_MARK=1"), std::string::npos) << error.options();
  EXPECT_NE(error.options().find("-DCADT_WIDE=0"), std::string::npos) << error.options();
  EXPECT_EQ(error.options().find("-cl-nv-") != std::string::npos, info.platform == "NVIDIA CUDA") << error.options();
  EXPECT_NE(error.log().find("no_such_word"), std::string::npos) << error.log();
  // NVIDIA's compiler counts the lines itself.
  if (info.platform != "NVIDIA CUDA") {
    EXPECT_NE(error.log().find("broken.h"), std::string::npos) << error.log();
  }
  EXPECT_NE(error.log().find("CL_BUILD_PROGRAM_FAILURE"), std::string::npos) << error.log();
}

TEST_F(OpenClBuild, WideVariantIsBuiltAtItsFirstLaunch) {
  opencl::OpenRequest request = small();
  request.source += "\n#if CADT_WIDE\n#error only the wide build fails\n#endif\n";
  const auto device = opencl::open_device(request);  // the narrow one is all that is needed
  const std::vector<Arg> none;
  const auto error =
      caught<KernelBuildError>([&] { device->launch(KernelId::cadt_selftest, 1, none, KernelVariant::wide); });
  EXPECT_NE(error.options().find("-DCADT_WIDE=1"), std::string::npos) << error.options();
  EXPECT_NE(error.log().find("only the wide build fails"), std::string::npos) << error.log();
  EXPECT_EQ(counted_items(*device, 10), 10u);
}

TEST_F(OpenClBuild, MissingKernelIsNamed) {
  const auto device = open_small();
  const std::vector<Arg> none;
  const auto error =
      caught<KernelBuildError>([&] { device->launch(KernelId::cadt_insert, 1, none, KernelVariant::narrow); });
  EXPECT_NE(std::string(error.what()).find("cadt_insert"), std::string::npos) << error.what();
}

TEST_F(OpenClBuild, BestEffortAtomicsSayThatTheyAre) {
  if (info.platform == "NVIDIA CUDA")
    GTEST_SKIP() << "its compiler takes no macros with variable arguments in OpenCL C 1.2, and has acquire/release";
  opencl::OpenRequest request = small();
  request.best_effort_atomics = true;
  const auto device = opencl::open_device(request);
  EXPECT_EQ(device->info().atomics, "CL1.2 best effort");
  EXPECT_EQ(counted_items(*device, 1000), 1000u);
}

// As on a device whose driver compiles acquire/release without advertising it.
TEST_F(OpenClBuild, ProbeFindsAcquireRelease) {
  if (info.atomics != "CL3.0 acquire/release, device scope") GTEST_SKIP() << "not advertised: " << info.atomics;
  opencl::OpenRequest request = small();
  request.probe_atomics = true;
  EXPECT_EQ(opencl::open_device(request)->info().atomics, info.atomics);
}

}  // namespace
}  // namespace cadt::test
