// SPDX-License-Identifier: Apache-2.0
// A test with OpenGL, which ends without an OpenGL error. Skipped where there is no display, unless
// CADT_REQUIRE_DISPLAY is set.
#pragma once

#include "viewer/gl/context.hpp"
#include "viewer/gl/errors.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

namespace cadt::viewer {

class WithDisplay : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      context_ = std::make_unique<gl::HeadlessContext>();
    } catch (const DisplayError& error) {
      const char* required = std::getenv("CADT_REQUIRE_DISPLAY");
      if (required != nullptr && *required != '\0') FAIL() << error.what();
      GTEST_SKIP() << error.what();
    }
  }
  void TearDown() override {
    if (context_ != nullptr) {
      EXPECT_EQ(gl::errors_seen(), 0) << "CADT_GL_DEBUG=1 prints them";
    }
  }
  [[nodiscard]] const gl::DriverInfo& driver() const { return context_->driver(); }

 private:
  std::unique_ptr<gl::HeadlessContext> context_;
};

}  // namespace cadt::viewer
