// SPDX-License-Identifier: Apache-2.0
// The predicates on the device, in both builds of the very program that makes meshes: every stage by itself and all of
// them together, against whole numbers of any length.
#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <memory>
#include <utility>

#include "common/driver/registry.hpp"
#include "tests/support/backends.hpp"
#include "tests/unit/predicates/cases.hpp"
#include "tests/unit/predicates/counted.hpp"
#include "tests/unit/predicates/words.hpp"
#include "tests/unit/verify/truth.hpp"

namespace cadt::test {

Lengths& Lengths::operator+=(const Lengths& other) {
  orientation_128 += other.orientation_128, orientation_long += other.orientation_long;
  incircle_192 += other.incircle_192, incircle_256 += other.incircle_256, incircle_long += other.incircle_long;
  incircle_pairs += other.incircle_pairs, mirrored += other.mirrored;
  return *this;
}

namespace {

/// Opened once, never closed: the runtimes of some devices are gone before static objects are.
Device& device_of(const BackendCase& backend) {
  static auto* const devices = new std::map<Backend, std::unique_ptr<Device>>;
  std::unique_ptr<Device>& device = (*devices)[backend.backend];
  if (!device) device = open_device(backend.options());
  return *device;
}

struct Found {
  StageCounts narrow, wide;
};

class Signs : public BackendTest {
 protected:
  void check(const SignSet& set, Found& sums) const {
    for (const bool wide : {false, true}) {
      const std::vector<SignCase>& cases = wide ? set.wide : set.narrow;
      const std::vector<std::uint32_t> words =
          words_of(device_of(GetParam()), cases, wide ? KernelVariant::wide : KernelVariant::narrow);
      const WrongSigns wrong = compare(cases, words);
      ASSERT_EQ(wrong.fields, 0u) << set.name << (wide ? ", wide: " : ", narrow: ") << wrong.signs
                                  << " wrong signs, further wrong stages " << wrong.stages << ", bits " << std::hex
                                  << wrong.fields << ", found " << words[wrong.first] << ", first "
                                  << text(cases[wrong.first]);
      const StageCounts found = stages_of(words);
      StageCounts& sum = wide ? sums.wide : sums.narrow;
      sum.filtered_orientations += found.filtered_orientations, sum.exact_orientations += found.exact_orientations;
      sum.filtered_incircles += found.filtered_incircles, sum.exact_incircles += found.exact_incircles;
      sum.ties += found.ties;
    }
  }
  void check_file(const std::string& name, std::size_t at_least) const {
    const auto folder = truth::hard_data();
    if (folder.empty() || !std::filesystem::exists(folder / name))
      GTEST_SKIP() << name << " is missing: set CADT_DATA_DIR";
    const SignSet set = file_set(folder, name);
    EXPECT_GE(set.wide.size(), at_least);
    Found found;
    check(set, found);
  }
  void check_generated(std::initializer_list<const char*> names) const {
    Found found;
    for (const char* name : names) ASSERT_NO_FATAL_FAILURE(check(generated_set(name), found));
  }
};

TEST_P(Signs, ClassicOrientations) { check_file("predicates_pscico_orient2d.txt", 1000); }
TEST_P(Signs, ClassicIncircles) { check_file("predicates_pscico_incircle.txt", 1000); }
TEST_P(Signs, ThresholdOrientations) { check_file("gen_threshold_orient2d.txt", 500); }
TEST_P(Signs, ThresholdIncircles) { check_file("gen_threshold_incircle.txt", 500); }
TEST_P(Signs, Cocircular) { check_generated({"cocircular"}); }
TEST_P(Signs, Rectangles) { check_generated({"rectangles"}); }
TEST_P(Signs, NearTheBoundsOfFilters) { check_generated({"near_line", "near_circle", "near_arms"}); }
TEST_P(Signs, IntegersOfAllLengths) {
  check_generated({"lines", "octets", "far_octets", "longest_integers", "long_integers", "tiny_determinants",
                   "polygons", "window"});
}
TEST_P(Signs, EveryFiniteDouble) { check_generated({"any_bits", "every_scale", "far_and_tiny"}); }

// Each stage has decided a thousand cases on this device, in either build, and each length of integers was taken so
// often. The device says which stage it was; which length follows from the points alone, by the same text on the host.
TEST_P(Signs, EveryStageDecidesAThousandCases) {
  Found found;
  Lengths narrow, wide;
  for (const char* name :
       {"near_line", "near_circle", "lines", "octets", "longest_integers", "lattices", "every_scale"}) {
    const SignSet set = generated_set(name);
    ASSERT_NO_FATAL_FAILURE(check(set, found));
    narrow += count_narrow(set.narrow);
    wide += count_wide(set.wide);
  }
  for (const StageCounts& s : {found.narrow, found.wide}) {
    EXPECT_GE(s.filtered_orientations, 1000u);
    EXPECT_GE(s.exact_orientations, 1000u);
    EXPECT_GE(s.filtered_incircles, 1000u);
    EXPECT_GE(s.exact_incircles, 1000u);
    EXPECT_GE(s.ties, 1000u);
    std::cout << "filter " << s.filtered_orientations << " + " << s.filtered_incircles << ", exact "
              << s.exact_orientations << " + " << s.exact_incircles << ", ties " << s.ties << '\n';
  }
  for (const auto& [s, l] : {std::pair(found.narrow, narrow), std::pair(found.wide, wide)}) {
    EXPECT_EQ(s.exact_orientations, l.orientation_128 + l.orientation_long) << "the device took another way";
    EXPECT_EQ(s.exact_incircles + s.ties,
              l.incircle_192 + l.incircle_256 + l.incircle_pairs + l.incircle_long + l.mirrored);
    EXPECT_GE(l.orientation_128, 1000u);
    EXPECT_GE(l.orientation_long, 1000u);
    EXPECT_GE(l.incircle_256, 1000u);
    EXPECT_GE(l.incircle_long, 1000u);
    EXPECT_GE(l.mirrored, 1000u);
    std::cout << "orientation in 128 bits " << l.orientation_128 << ", long " << l.orientation_long
              << ", incircle in 192 bits " << l.incircle_192 << ", in 256 " << l.incircle_256 << ", in pairs "
              << l.incircle_pairs << ", long " << l.incircle_long << ", mirrored " << l.mirrored << '\n';
  }
  EXPECT_GE(narrow.incircle_192, 1000u);
  EXPECT_GE(narrow.incircle_pairs, 1000u);
  EXPECT_EQ(wide.incircle_192 + wide.incircle_pairs, 0u) << "the wide build knows no bound of the determinant";
}
CADT_ON_MAIN_BACKENDS(Signs);

}  // namespace
}  // namespace cadt::test
