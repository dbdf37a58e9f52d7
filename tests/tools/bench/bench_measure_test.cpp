// SPDX-License-Identifier: Apache-2.0
// Repetitions within a budget, and predictions.
#include "bench/measure.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace cadt::bench {
namespace {

TEST(Repeat, AllRunsWithinTheBudget) {
  int calls = 0;
  const Repeats all = repeat(2, 3, 1e9, std::nullopt, [&] { return static_cast<double>(++calls); });
  EXPECT_EQ(all.warmups, 2U);
  EXPECT_EQ(all.milliseconds, (std::vector<double>{3, 4, 5}));
}

TEST(Repeat, OneRunHoweverLongItIsPredictedToTake) {
  const Repeats all = repeat(2, 3, 10, 1000.0, [] { return 1000.0; });
  EXPECT_EQ(all.warmups, 0U);
  EXPECT_EQ(all.milliseconds.size(), 1U);
}

TEST(Repeat, AWarmUpThatUsesUpTheBudgetIsTheRun) {
  int calls = 0;
  const Repeats all = repeat(2, 3, 5, std::nullopt, [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(6));
    return 100.0 + ++calls;
  });
  EXPECT_EQ(all.warmups, 0U);
  EXPECT_EQ(all.milliseconds, std::vector<double>{101});
  EXPECT_EQ(calls, 1);
}

TEST(Repeat, NoWarmUpWithoutTimeForARun) {
  const Repeats all = repeat(1, 3, 15, 10.0, [] { return 10.0; });
  EXPECT_EQ(all.warmups, 0U);
}

TEST(Predictor, LinearAndATenthMore) {
  Predictor predictor;
  EXPECT_FALSE(predictor.predict("host", "uniform", 1000).has_value());
  predictor.learn("host", "uniform", 1000, 2.0, true);
  EXPECT_DOUBLE_EQ(predictor.predict("host", "uniform", 4000).value(), 8.8);
  EXPECT_DOUBLE_EQ(predictor.predict("host", "grid", 4000).value(), 8.8);
  EXPECT_FALSE(predictor.predict("cuda", "uniform", 4000).has_value());
}

TEST(Predictor, OfItsOwnKindFirstAndOnlyFromWhatIsLargeEnough) {
  Predictor predictor;
  predictor.learn("host", "grid", 1000, 5.0, true);
  predictor.learn("host", "uniform", 10000, 10.0, true);
  EXPECT_DOUBLE_EQ(predictor.predict("host", "grid", 2000).value(), 11.0);
  // The grid is too small to tell anything about 500,000 points, uniform points are not.
  EXPECT_DOUBLE_EQ(predictor.predict("host", "grid", 500000).value(), 550.0);
  EXPECT_FALSE(predictor.predict("host", "grid", 50000000).has_value());
}

TEST(Predictor, TheUnusualTellsNothingOfOthers) {
  Predictor predictor;
  predictor.learn("host", "block 32", 1000, 5.0, false);
  EXPECT_TRUE(predictor.predict("host", "block 32", 1000).has_value());
  EXPECT_FALSE(predictor.predict("host", "uniform", 1000).has_value());
}

TEST(Predictor, WhatWasGivenUpIsNotTriedWithMore) {
  Predictor predictor;
  EXPECT_FALSE(predictor.given_up("cupy", "uniform", 1000).has_value());
  predictor.give_up("cupy", "uniform", 4000);
  EXPECT_FALSE(predictor.given_up("cupy", "uniform", 3999).has_value());
  EXPECT_EQ(predictor.given_up("cupy", "uniform", 4000), 4000U);
  EXPECT_EQ(predictor.given_up("cupy", "uniform", 900000), 4000U);
  EXPECT_FALSE(predictor.given_up("cupy", "grid", 900000).has_value());
  EXPECT_FALSE(predictor.given_up("cgal", "uniform", 900000).has_value());
  predictor.give_up("cupy", "uniform", 9000);
  EXPECT_EQ(predictor.given_up("cupy", "uniform", 9000), 4000U);
}

}  // namespace
}  // namespace cadt::bench
