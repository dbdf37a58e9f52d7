// SPDX-License-Identifier: Apache-2.0
// Numbers with units, as options take them and as messages give them.
#include "apps/cadt/text.hpp"

#include "apps/cadt/failure.hpp"

#include <gtest/gtest.h>

#include <array>

namespace cadt::cli {
namespace {

TEST(Text, Bytes) {
  constexpr std::uint64_t kib = 1024, mib = kib * kib, gib = kib * mib;
  for (const auto& [text, bytes] : std::vector<std::pair<const char*, std::uint64_t>>{{"1048576", mib},
                                                                                      {"7b", 7},
                                                                                      {"4k", 4 * kib},
                                                                                      {"4K", 4 * kib},
                                                                                      {"512M", 512 * mib},
                                                                                      {"4G", 4 * gib},
                                                                                      {"2T", 2 * kib * gib},
                                                                                      {"4Ki", 4 * kib},
                                                                                      {"4GiB", 4 * gib},
                                                                                      {"1.5GiB", 3 * gib / 2},
                                                                                      {"1.5 GiB", 3 * gib / 2},
                                                                                      {"4KB", 4000},
                                                                                      {"4MB", 4000000},
                                                                                      {"4GB", 4000000000},
                                                                                      {"4TB", 4000000000000},
                                                                                      {"0.5k", 512}}) {
    EXPECT_EQ(parse_bytes(text), bytes) << text;
  }
  for (const char* text : {"", "0", "-4G", "4X", "4GiBs", "G", "nan", "inf", "1e30", "4 4", "0.2", "4P"})
    EXPECT_THROW(static_cast<void>(parse_bytes(text)), Failure) << text;
}

TEST(Text, Counts) {
  for (const auto& [text, count] :
       std::vector<std::pair<const char*, std::size_t>>{{"0", 0},
                                                        {"250000", 250000},
                                                        {"1k", 1000},
                                                        {"1.5k", 1500},
                                                        {"2M", 2000000},
                                                        {"2m", 2000000},
                                                        {"1e6", 1000000},
                                                        {"3G", 3000000000},
                                                        {"9007199254740992", 9007199254740992}}) {
    EXPECT_EQ(parse_count(text), count) << text;
  }
  for (const char* text : {"", "-1", "many", "1.5", "1.0005k", "1e18", "2T", "2Ki", "2MB", "nan", "inf"})
    EXPECT_THROW(static_cast<void>(parse_count(text)), Failure) << text;
}

TEST(Text, HumanBytes) {
  for (const auto& [bytes, text] :
       std::vector<std::pair<std::uint64_t, const char*>>{{0, "0 bytes"},
                                                          {1023, "1023 bytes"},
                                                          {1024, "1.0 KiB"},
                                                          {1536, "1.5 KiB"},
                                                          {std::uint64_t{1} << 20, "1.0 MiB"},
                                                          {std::uint64_t{5} << 30, "5.0 GiB"},
                                                          {std::uint64_t{1} << 40, "1.0 TiB"},
                                                          {(std::uint64_t{1} << 20) - 1, "1.0 MiB"},
                                                          {(std::uint64_t{1} << 20) - 51, "1.0 MiB"},
                                                          {(std::uint64_t{1} << 20) - 52, "1023.9 KiB"},
                                                          {std::uint64_t{1} << 51, "2.0 PiB"}}) {
    EXPECT_EQ(human_bytes(bytes), text);
  }
}

TEST(Text, Numbers) {
  EXPECT_EQ(parse_number("-1.5e3"), -1500.0);
  for (const char* text : {"", " 1", "1 ", "1,2", "nan", "inf", "1e999", "x"}) EXPECT_FALSE(parse_number(text)) << text;
  std::array<double, 3> numbers{};
  EXPECT_TRUE(parse_numbers("1,-2,3.5", numbers));
  EXPECT_EQ(numbers, (std::array<double, 3>{1, -2, 3.5}));
  for (const char* text : {"", "1,2", "1,2,", "1,,3", "1,2,3,4", "1,2,3,", "1;2;3", "1,nan,3"})
    EXPECT_FALSE(parse_numbers(text, numbers)) << text;
}

TEST(Text, Tables) {
  EXPECT_EQ(table({{"name", "n", "kind"}, {"a", "12345", ""}, {"longer", "1", "x"}}),
            "name    n      kind\na       12345\nlonger  1      x\n");
  EXPECT_EQ(join({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(join({"a", "b"}, "|"), "a|b");
  EXPECT_EQ(lower("AZaz-09[\xc3\x84"), "azaz-09[\xc3\x84");
}

}  // namespace
}  // namespace cadt::cli
