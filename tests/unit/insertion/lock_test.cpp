// SPDX-License-Identifier: Apache-2.0
// The protocol of a claim, one step at a time: order of the records, what a lost claim leaves, versions. That threads
// keep each other out is what tests/concurrency and tests/models are for.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/flip.dev.h"
#include "common/insertion/split.dev.h"
#pragma GCC diagnostic pop

constexpr std::uint32_t free_version = 10;

/// Eight free records, each with another version.
class Locks : public testing::Test {
 protected:
  void SetUp() override {
    mesh.locked = records.data();
    for (std::uint32_t t = 0; t < records.size(); ++t) lock(t) = free_version + 2 * t;
    cadt_counters_clear(&counters);
  }
  std::uint32_t& lock(std::uint32_t t) { return records[t].word[CADT_WORD_LOCK]; }
  static std::uint32_t version(std::uint32_t t) { return free_version + 2 * t; }
  static cadt_lock_set claim_of(std::array<std::uint32_t, 4> wanted) {
    cadt_lock_set claim;
    for (std::size_t i = 0; i < 4; ++i) {
      claim.triangle[i] = wanted[i];
      claim.version[i] = wanted[i] == CADT_NONE ? 0 : version(wanted[i]);
    }
    return claim;
  }
  void expect_untouched() {
    for (std::uint32_t t = 0; t < records.size(); ++t) EXPECT_EQ(lock(t), version(t)) << t;
  }

  std::vector<cadt_locked_triangle> records = std::vector<cadt_locked_triangle>(8);
  cadt_locked_mesh mesh{};
  cadt_counters counters;
};

TEST_F(Locks, RecordsAreClaimedInAscendingOrderWhateverTheyAreGivenIn) {
  for (const bool three : {false, true}) {
    std::array<std::uint32_t, 4> given = {1, 3, 4, three ? std::uint32_t{CADT_NONE} : 6};
    const std::array<std::uint32_t, 4> sorted = given;
    do {
      cadt_lock_set claim = claim_of(given);
      ASSERT_EQ(cadt_try_lock(&mesh, &claim, &counters), 1u);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(claim.triangle[i], sorted[i]);
        if (sorted[i] == CADT_NONE) continue;
        EXPECT_EQ(claim.version[i], version(sorted[i])) << "a version goes with its record";
        EXPECT_EQ(lock(sorted[i]), version(sorted[i]) | 1u);
      }
      for (const std::uint32_t t : {0u, 2u, 5u, 7u}) EXPECT_EQ(lock(t), version(t));
      cadt_unlock_unchanged(&mesh, &claim, 4);
      expect_untouched();
    } while (std::ranges::next_permutation(given).found);
  }
}

// Who comes too late gives back what it has, as it was, and has not touched what comes behind.
TEST_F(Locks, ALostClaimLeavesEverythingAsItWas) {
  const std::array<std::uint32_t, 4> given = {6, 1, 4, 3};
  for (const std::uint32_t taken : given) {
    for (const std::uint32_t word : {version(taken) | 1u, 0u, version(taken) + 2}) {  // claimed, not there, changed
      lock(taken) = word;
      cadt_lock_set claim = claim_of(given);
      counters.count[CADT_COUNT_LOCK_FAILURES] = 0;
      EXPECT_EQ(cadt_try_lock(&mesh, &claim, &counters), 0u) << taken << " is " << word;
      EXPECT_EQ(counters.count[CADT_COUNT_LOCK_FAILURES], 1u);
      EXPECT_EQ(lock(taken), word);
      lock(taken) = version(taken);
      expect_untouched();
    }
  }
}

TEST_F(Locks, AVersionThatIsNotKnownIsTakenAsItIs) {
  cadt_lock_set claim = claim_of({5, 2, CADT_NONE, CADT_NONE});
  claim.version[0] = claim.version[1] = CADT_ANY_VERSION;
  lock(2) = 444;
  ASSERT_EQ(cadt_try_lock(&mesh, &claim, &counters), 1u);
  EXPECT_EQ(claim.version[0], 444u);
  EXPECT_EQ(claim.version[1], version(5));
  EXPECT_EQ(lock(2), 445u);
  cadt_unlock_unchanged(&mesh, &claim, 4);
  EXPECT_EQ(lock(2), 444u);
  lock(2) = version(2);
  expect_untouched();
}

// Who has read a record before the change must not be able to claim it afterwards.
TEST_F(Locks, AChangeRaisesTheVersion) {
  const cadt_lock_set before = claim_of({1, 3, 4, 6});
  cadt_lock_set claim = before;
  ASSERT_EQ(cadt_try_lock(&mesh, &claim, &counters), 1u);
  cadt_unlock(&mesh, &claim);
  for (const std::uint32_t t : {1u, 3u, 4u, 6u}) {
    EXPECT_EQ(lock(t), version(t) + 2);
    EXPECT_TRUE(cadt_is_unlocked(lock(t)));
    cadt_lock_set late = claim_of({t, CADT_NONE, CADT_NONE, CADT_NONE});
    EXPECT_EQ(cadt_try_lock(&mesh, &late, &counters), 0u);
  }
  for (const std::uint32_t t : {0u, 2u, 5u, 7u}) EXPECT_EQ(lock(t), version(t));
  // The number after the largest must be neither "not there" nor odd.
  EXPECT_EQ(cadt_next_version(0xFFFFFFFEu), 2u);
  EXPECT_EQ(cadt_next_version(2u), 4u);
}

TEST_F(Locks, ANewRecordIsFree) {
  lock(7) = 0;
  EXPECT_FALSE(cadt_is_unlocked(lock(7)));
  cadt_publish_triangle(&mesh, 7);
  EXPECT_TRUE(cadt_is_unlocked(lock(7)));
  EXPECT_FALSE(cadt_is_unlocked(lock(7) | 1u));
}

}  // namespace
