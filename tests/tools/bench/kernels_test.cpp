// SPDX-License-Identifier: Apache-2.0
// The bytes of the kernels, and what a profiler wrote.
#include "bench/kernel_bytes.hpp"
#include "bench/profiler.hpp"
#include "common/driver/kernel_id.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace cadt::bench {
namespace {

namespace fs = std::filesystem;

TEST(KernelBytes, HaveKernelsOfTheList) {
  for (const KernelBytes& line : kernel_bytes()) {
    const std::string name(line.kernel);
    EXPECT_TRUE(name == "sort" || name == "scan" || std::ranges::find(kernel_names, name) != kernel_names.end())
        << name;
    EXPECT_GT(line.read + line.written, 0U) << name;
    EXPECT_FALSE(line.what.empty()) << name;
  }
}

TEST(KernelBytes, OfARunWithLocks) {
  Statistics run;
  run.points = 1000;
  run.distinct = 900;
  run.splits = 800;
  run.edge_splits = 97;
  run.legality_sweeps = 2;
  EXPECT_EQ(least_bytes("cadt_gather_points", run, 1780), 1000U * (4 + 16 + 16));
  EXPECT_EQ(least_bytes("cadt_insert", run, 1780), 897U * (16 + 32 + 3 * 32 + 4));
  EXPECT_EQ(least_bytes("cadt_legality_sweep", run, 1780), 2U * 900 * (2 * 32 + 16));
  EXPECT_EQ(least_bytes("cadt_drop_locks", run, 1780), 900U * (2 * 36 + 4) + 1780 * 24);
  // 14 bits are two passes; the places are not read in the first one
  EXPECT_EQ(least_bytes("cadt_radix_scatter", run, 1780), 1000U * (2 * 12 + 4));
  EXPECT_EQ(least_bytes("sort", run, 1780), 1000U * 2 * 16);
  EXPECT_EQ(least_bytes("cadt_hilbert_keys", run, 1780), 1000U * 20);
  EXPECT_EQ(least_bytes("cadt_legalize_edges", run, 1780), std::nullopt);
  EXPECT_EQ(least_bytes("no kernel", run, 1780), std::nullopt);
}

TEST(KernelBytes, OfARunWithStars) {
  Statistics run;
  run.points = run.distinct = 1000;
  run.proven_stars = 990;
  run.splits = 7;
  EXPECT_EQ(least_bytes("cadt_prove_stars", run, 1980), 1000U * (16 + 4) + 990 * 28);
  EXPECT_EQ(least_bytes("cadt_pack_residual", run, 1980), 1000U * 4 + 10 * 36);
  EXPECT_EQ(least_bytes("cadt_star_counts", run, 1980), 1000U * 14 + 990 * 28);
  EXPECT_EQ(least_bytes("cadt_insert", run, 1980), 7U * 148);
}

// With less columns than ncu has, which are found by their names.
constexpr const char* profiled =
    "==PROF== Connected to process 17\n"
    "0123456789abcdef0123456789abcdef\n"
    "==PROF== Disconnected from process 17\n"
    "\"ID\",\"Process Name\",\"Kernel Name\",\"gpu__time_duration.sum\",\"dram__bytes.sum\","
    "\"smsp__issue_active.avg.pct_of_peak_sustained_active\",\"dram__throughput.avg.pct_of_peak_sustained_elapsed\","
    "\"smsp__sass_thread_inst_executed_op_dadd_pred_on.sum\",\"smsp__sass_thread_inst_executed_op_ffma_pred_on.sum\"\n"
    "\"\",\"\",\"\",\"ns\",\"byte\",\"%\",\"%\",\"inst\",\"inst\"\n"
    "\"0\",\"cadt-bench\",\"cadt_insert\",\"1,000\",\"500\",\"20\",\"10\",\"70\",\"5\"\n"
    "\"1\",\"cadt-bench\",\"DeviceRadixSortOnesweepKernel\",\"10\",\"100\",\"1\",\"2\",\"0\",\"0\"\n"
    "\"2\",\"cadt-bench\",\"cadt_insert\",\"3000\",\"1,500.5\",\"60\",\"50\",\"30\",\"10\"\n"
    "\"3\",\"cadt-bench\",\"(anonymous namespace)::cadt_bounds(const cadt_point *, unsigned "
    "int)\",\"5\",\"7\",\"1\",\"2\",\"3\",\"4\"\n";

TEST(Profile, AddsUpTheLaunchesOfAKernel) {
  const Profile found = read_profile(profiled);
  EXPECT_EQ(found.failure, "");
  ASSERT_EQ(found.kernels.size(), 3U);
  const Profiled& insert = found.kernels.at("cadt_insert");
  EXPECT_DOUBLE_EQ(insert.nanoseconds, 4000);
  EXPECT_DOUBLE_EQ(insert.issue_active, (1000 * 20 + 3000 * 60) / 4000.0);
  EXPECT_DOUBLE_EQ(insert.dram_throughput, (1000 * 10 + 3000 * 50) / 4000.0);
  EXPECT_DOUBLE_EQ(insert.dram_bytes, 2000.5);
  EXPECT_DOUBLE_EQ(insert.operations, 100 + 2 * 15);
  EXPECT_EQ(found.kernels.count("sort"), 1U);
  EXPECT_DOUBLE_EQ(found.kernels.at("cadt_bounds").dram_bytes, 7);
}

TEST(Profile, SaysWhyThereIsNone) {
  EXPECT_EQ(read_profile("").failure, "ncu wrote no kernels");
  EXPECT_EQ(read_profile("==PROF== x\n==ERROR== ERR_NVGPUCTRPERM - no permission\n==ERROR== more\n").failure,
            "ncu: ERR_NVGPUCTRPERM - no permission");
}

/// A folder with a program `ncu` as the only one on the path, or with none.
class FakeProfiler : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "cadt-profiler-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    if (const char* path = std::getenv("PATH")) path_ = path;
    ::setenv("PATH", folder_.c_str(), 1);
  }
  void TearDown() override {
    ::setenv("PATH", path_.c_str(), 1);
    fs::remove_all(folder_);
  }
  void put(const std::string& script) const {
    std::ofstream(folder_ / "ncu") << "#!/bin/sh\n" << script;
    fs::permissions(folder_ / "ncu", fs::perms::owner_all);
  }
  fs::path folder_;
  std::string path_;
};

TEST_F(FakeProfiler, NotThere) {
  const Profile found = profile({"/bin/true"}, 10);
  EXPECT_TRUE(found.kernels.empty());
  EXPECT_NE(found.failure.find("ncu: cannot start ncu: No such file"), std::string::npos) << found.failure;
}

TEST_F(FakeProfiler, WritesWhereItIsTold) {
  std::ofstream(folder_ / "answer") << profiled;
  put("while [ $# -gt 1 ]; do [ \"$1\" = --log-file ] && log=$2; shift; done\n"
      "while read -r line; do echo \"$line\"; done < " +
      (folder_ / "answer").string() + " > \"$log\"\n");
  const Profile found = profile({"/bin/true"}, 10);
  EXPECT_EQ(found.failure, "");
  EXPECT_EQ(found.kernels.count("cadt_insert"), 1U);
}

TEST_F(FakeProfiler, MayNotLook) {
  put("echo '==ERROR== ERR_NVGPUCTRPERM - ask the administrator'\nexit 1\n");
  EXPECT_EQ(profile({"/bin/true"}, 10).failure, "ncu: ERR_NVGPUCTRPERM - ask the administrator");
  put("exit 9\n");
  EXPECT_EQ(profile({"/bin/true"}, 10).failure, "ncu: exit code 9");
}

}  // namespace
}  // namespace cadt::bench
