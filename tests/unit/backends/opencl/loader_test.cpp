// SPDX-License-Identifier: Apache-2.0
// Functions that the loader does not have. That there is no loader is tested with the program, in tests/system/cli.
#include "backends/opencl/loader.hpp"

#include <gtest/gtest.h>

namespace cadt::opencl {
namespace {

// A loader older than the function. The declarations are some that the library does not use, for their types.
constexpr auto& returns_code = loader::Function<::clFlush>::call<"clNoSuchFunction">;
constexpr auto& returns_object = loader::Function<::clCreateUserEvent>::call<"clNoSuchFunction">;

TEST(OpenClLoader, MissingFunctionIsAnErrorCode) {
  const cl_int expected = loader_failure().empty() ? CL_INVALID_OPERATION : -1001;
  EXPECT_EQ(returns_code(nullptr), expected);
  cl_int code = CL_SUCCESS;
  EXPECT_EQ(returns_object(nullptr, &code), nullptr);
  EXPECT_EQ(code, expected);
  EXPECT_EQ(returns_object(nullptr, nullptr), nullptr) << "the code need not be asked for";
}

TEST(OpenClLoader, FunctionIsTheLoadersOwn) {
  if (!loader_failure().empty()) GTEST_SKIP() << loader_failure();
  EXPECT_EQ(clGetPlatformIDs(0, nullptr, nullptr), CL_INVALID_VALUE) << "its own answer to a call without sense";
  EXPECT_NE(loader::find("clGetPlatformIDs"), nullptr);
  EXPECT_EQ(loader::find("clNoSuchFunction"), nullptr);
}

}  // namespace
}  // namespace cadt::opencl
