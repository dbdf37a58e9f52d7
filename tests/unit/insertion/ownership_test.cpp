// SPDX-License-Identifier: Apache-2.0
// Every store to a record is made by its owner: the kernels of this program assert it (kernels_checked.cpp).
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace {

std::vector<double> uniform(std::size_t n) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> xy(2 * n);
  for (double& v : xy) v = unit(random);
  return xy;
}
std::vector<double> lattice(int m) {
  std::vector<double> xy;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) xy.insert(xy.end(), {static_cast<double>(i), static_cast<double>(j)});
  return xy;
}

TEST(Ownership, EveryStoreIsMadeByTheOwner) {
  // the larger ones are inserted in ranges first, which have owners without locks
  for (const auto& xy : {uniform(20000), lattice(120), uniform(150000), lattice(300)}) {
    cadt::Options options;
    options.backend = cadt::Backend::host;
    for (const unsigned threads : {1U, 2U, 8U}) {
      options.threads = threads;
      const auto mesh = cadt::triangulate(std::span<const double>(xy), options);
      EXPECT_TRUE(cadt::verify(std::span<const double>(xy), mesh).ok);
    }
  }
}

}  // namespace
