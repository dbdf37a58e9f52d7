// SPDX-License-Identifier: Apache-2.0
// Child processes: what they say, how they end, and that they do end.
#include "bench/child.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace cadt::bench {
namespace {

ChildResult shell(const std::string& script, double timeout = 60.0) { return run_child({"sh", "-c", script}, timeout); }

TEST(Child, OutputErrorsAndStatus) {
  const ChildResult child = shell("echo out; echo err >&2; exit 7");
  EXPECT_EQ(child.output, "out\n");
  EXPECT_EQ(child.errors, "err\n");
  EXPECT_EQ(child.status, 7);
  EXPECT_EQ(child.failure, "");
}

TEST(Child, ArgumentsAreNotReadByAShell) {
  EXPECT_EQ(run_child({"printf", "%s|", "a b", "$HOME", "*"}, 60.0).output, "a b|$HOME|*|");
}

TEST(Child, InputIsEmpty) { EXPECT_EQ(shell("cat; echo end").output, "end\n"); }

TEST(Child, ASignalIsTold) { EXPECT_EQ(shell("kill -SEGV $$").status, 128 + 11); }

TEST(Child, WhatIsNotThereIsNamed) {
  EXPECT_NE(run_child({"/no/such/program"}, 60.0).failure.find("/no/such/program"), std::string::npos);
  EXPECT_FALSE(run_child({}, 60.0).failure.empty());
}

TEST(Child, KilledInTime) {
  const auto start = std::chrono::steady_clock::now();
  // The second closes both pipes, the third leaves them to a grandchild, the fourth ignores polite signals.
  for (const char* script :
       {"exec sleep 60", "exec sleep 60 >&- 2>&-", "sleep 60 & wait", "trap '' TERM; exec sleep 60"}) {
    const ChildResult child = shell(script, 0.3);
    EXPECT_EQ(child.failure, "killed after 0.3 s") << script;
    EXPECT_EQ(child.status, 128 + 9) << script;
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(Child, EndlessOutputIsStopped) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(shell("exec yes").failure, "wrote too much");
  const ChildResult child =
      shell("i=0; while [ $i -lt 20000 ]; do echo a line of errors >&2; i=$((i+1)); done; echo last >&2");
  EXPECT_EQ(child.failure, "");
  EXPECT_LT(child.errors.size(), 10000u);
  EXPECT_TRUE(child.errors.ends_with("last\n"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(50));
}

}  // namespace
}  // namespace cadt::bench
