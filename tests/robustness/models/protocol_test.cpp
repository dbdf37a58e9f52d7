// SPDX-License-Identifier: Apache-2.0
// The lock protocol in random orders of steps, with all that C++'s memory model allows loads to see.
#include "tests/robustness/models/protocol.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <utility>

namespace {

// CADT_MODEL_RUNS: runs of each search.
unsigned long runs() {
  const char* variable = std::getenv("CADT_MODEL_RUNS");
  const long value = variable != nullptr ? std::atol(variable) : 0;
  return value > 0 ? static_cast<unsigned long>(value) : 20000;
}

void expect_clean(const model::Found& found) {
  ASSERT_TRUE(found.claims_passed) << found.text;
  ASSERT_TRUE(found.mesh_passed) << found.text;
  // A search in which nobody met anybody would show nothing.
  EXPECT_GE(found.illegal, 3U);
  EXPECT_GT(found.totals.flips, runs());
  EXPECT_GT(found.totals.splits, runs() / 2);
  EXPECT_GT(found.totals.lost, found.totals.invalid);
  EXPECT_GT(found.totals.invalid, 0U);
  for (const auto& [name, count] : {std::pair{"flips", found.totals.flips},
                                    {"splits", found.totals.splits},
                                    {"lock_failures", found.totals.lost},
                                    {"invalid", found.totals.invalid}})
    testing::Test::RecordProperty(name, std::to_string(count));
}

TEST(Protocol, NoOrderOfStepsBreaksTheMesh) { expect_clean(model::search_cpu(runs())); }
TEST(ProtocolOfGpus, NoOrderOfStepsBreaksTheMesh) { expect_clean(model::search_gpu(runs())); }

}  // namespace
