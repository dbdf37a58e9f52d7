// SPDX-License-Identifier: Apache-2.0
// The last error of a thread of the C interface, when the thread ends.
#include <cadt/cadt.h>

#include <gtest/gtest.h>

#include <string>
#include <thread>

namespace {

struct Seen {
  std::string before, message;
  cadt_status status = CADT_OK;
};

/// Calls the library when the thread has ended what was made later.
struct Late {
  Seen* seen;
  ~Late() {
    seen->before = cadt_last_error_message();
    seen->status = cadt_triangulator_open(nullptr, nullptr);
    seen->message = cadt_last_error_message();
  }
};

TEST(LastError, AfterTheStringsOfTheThread) {
  Seen seen;
  std::thread([&] {
    thread_local const Late late{&seen};
    EXPECT_EQ(late.seen, &seen);
    EXPECT_EQ(cadt_triangulator_open(nullptr, nullptr), CADT_INVALID_ARGUMENT);
    EXPECT_STRNE(cadt_last_error_message(), "");
  }).join();
  EXPECT_EQ(seen.before, "");
  EXPECT_EQ(seen.status, CADT_INVALID_ARGUMENT);
  EXPECT_EQ(seen.message, "the thread is ending, and keeps no messages");
}

}  // namespace
