// SPDX-License-Identifier: Apache-2.0
// What control groups leave, by files as Linux has them.
#include "tests/unit/tiles/tiles_support.hpp"
#include "tiles/machine.hpp"
#include "tiles/system_memory.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace cadt::tiles {
namespace {

class GroupMemory : public testing::Test {
 protected:
  Folder folder_;
  std::string root_ = folder_ / "cgroup", process_ = folder_ / "self";

  void write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path) << text;
  }
  void group_2(const std::string& path, const std::string& most, std::uint64_t used, const std::string& stat) const {
    write(root_ + path + "/memory.max", most + "\n");
    write(root_ + path + "/memory.current", std::to_string(used) + "\n");
    write(root_ + path + "/memory.stat", stat);
  }
  [[nodiscard]] std::optional<std::uint64_t> left(const std::string& groups) const {
    write(process_, groups);
    return memory_of_groups(process_.c_str(), root_.c_str());
  }
};

TEST_F(GroupMemory, IsWhatTheLowestLimitLeaves) {
  group_2("/job", "1000000", 700000, "anon 500000\nfile 160000\ninactive_file 100000\nactive_file 50000\n");
  group_2("/job/step", "max", 600000, "inactive_file 90000\n");
  EXPECT_EQ(left("0::/job/step\n"), 450000U) << "files in the cache are given back";
  group_2("/job/step", "800000", 600000, "anon 500000\ninactive_file 1\nactive_file 2\n");
  EXPECT_EQ(left("0::/job/step\n"), 200003U);
  EXPECT_EQ(left("0::/job/step/task_0\n"), 200003U) << "a group that is not there";
  EXPECT_EQ(left("0::/job\n"), 450000U);
  group_2("/job/step", "800000", 900000, "inactive_file 50000\n");
  EXPECT_EQ(left("0::/job/step"), 1U) << "0 would be unknown";
  group_2("/job/step", "0", 900000, "");
  EXPECT_EQ(left("0::/job/step"), 1U);
  group_2("/job/step", "800000", 900000, "inactive_file 900000\n");
  write(root_ + "/job/step/memory.high", "300000\n");
  EXPECT_EQ(left("0::/job/step"), 300000U) << "above, it would be throttled";
  write(root_ + "/job/step/memory.high", "max\n");
  EXPECT_EQ(left("0::/job/step"), 450000U);
}

TEST_F(GroupMemory, OfAContainerIsTheUppermost) {
  group_2("", "5000", 1000, "");
  for (const char* groups : {"0::/\n", "0::/docker/0123abcd\n", "0::/../..\n"})
    EXPECT_EQ(left(groups), 4000U) << groups;
}

TEST_F(GroupMemory, HasOtherFilesInVersion1) {
  write(root_ + "/memory/slurm/job_7/memory.limit_in_bytes", "9000\n");
  write(root_ + "/memory/slurm/job_7/memory.usage_in_bytes", "8000\n");
  write(root_ + "/memory/slurm/job_7/memory.stat",
        "inactive_file 1\nactive_file 1\ntotal_inactive_file 500\ntotal_active_file 30\n");
  EXPECT_EQ(left("12:cpu,cpuacct:/other\n9:memory:/slurm/job_7\n0::/slurm\n"), 1530U);
  for (const char* controllers : {"memory", "memory,cpu", "hugetlb,memory", "cpu,memory,pids"})
    EXPECT_EQ(left("9:" + std::string(controllers) + ":/slurm/job_7\n"), 1530U) << controllers;
  for (const char* controllers : {"memory_of_another", "name=memory", "cpu"})
    EXPECT_EQ(left("9:" + std::string(controllers) + ":/slurm/job_7\n"), std::nullopt) << controllers;
  const std::string others = "1:name=" + std::string(9000, 'x') + ":/\n";
  EXPECT_EQ(left(others + "9:memory:/slurm/job_7\n"), 1530U);
}

TEST_F(GroupMemory, IsUnknownWithoutLimits) {
  group_2("/job", "max", 7, "inactive_file 1\n");
  for (const char* groups : {"0::/job\n", "0::/none\n", "", "\n", "0:/job\n", "0::"})
    EXPECT_EQ(left(groups), std::nullopt);
  group_2("/job", "", 7, "");
  EXPECT_EQ(left("0::/job\n"), std::nullopt);
  EXPECT_EQ(memory_of_groups((process_ + "-none").c_str(), root_.c_str()), std::nullopt);
  EXPECT_EQ(left("0::/" + std::string(5000, 'a') + "\n"), std::nullopt);
}

TEST_F(GroupMemory, IsOfTheSystemToo) {
  group_2("/job", "70000", 20000, "");
  EXPECT_EQ(left("0::/job\n"), 50000U);
  EXPECT_EQ(memory_of_system(process_.c_str(), root_.c_str()), 50000U);
  EXPECT_GT(memory_of_system((process_ + "-none").c_str(), root_.c_str()), std::uint64_t{1} << 24) << "of the machine";
  EXPECT_GT(available_memory(), std::uint64_t{1} << 24);
}

}  // namespace
}  // namespace cadt::tiles
