// SPDX-License-Identifier: Apache-2.0
// Rows as CSV and JSON.
#include "bench/row.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cadt::bench {
namespace {

std::string second_line(const std::string& text) {
  const std::size_t at = text.find('\n') + 1;
  return text.substr(at, text.find('\n', at) - at);
}

TEST(Row, AnEmptyRowHasAllItsCommas) {
  const std::string line = second_line(csv({Row()}));
  const std::string header = csv_header();
  EXPECT_EQ(line, std::string(static_cast<std::size_t>(std::ranges::count(header, ',')), ','));
}

TEST(Row, QuotesWhatWouldBreakTheLine) {
  Row row;
  row.device = "Card \"X\", 8 GB";
  EXPECT_NE(csv({row}).find(",\"Card \"\"X\"\", 8 GB\","), std::string::npos);
  EXPECT_NE(json({row}).find(R"("device": "Card \"X\", 8 GB")"), std::string::npos);
}

TEST(Row, CountsThatNobodyCountedAreEmpty) {
  Row row;
  row.statistics.emplace().lock_attempts = 7;
  row.statistics->launches = 5;
  row.detail = "counters";
  EXPECT_NE(json({row}).find("\"lock_attempts\": 7"), std::string::npos);
  row.detail = "none";
  EXPECT_NE(json({row}).find("\"lock_attempts\": null"), std::string::npos);
  EXPECT_NE(json({row}).find("\"launches\": 5"), std::string::npos);
}

TEST(Row, PhasesInTheirOrder) {
  Row row;
  row.phases = {{"sort", 1.5}, {"insert", 2}};
  EXPECT_NE(csv({row}).find(",sort=1.5000;insert=2.0000,"), std::string::npos);
}

TEST(Row, Median) {
  EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
}

}  // namespace
}  // namespace cadt::bench
