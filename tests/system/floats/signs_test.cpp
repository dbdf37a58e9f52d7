// SPDX-License-Identifier: Apache-2.0
// The predicates of the build for floats on the device, each stage by itself and all together, against whole numbers.
#include <iostream>
#include <memory>

#include "common/driver/registry.hpp"
#include "tests/system/floats/floats.hpp"
#include "tests/unit/predicates/cases.hpp"
#include "tests/unit/predicates/counted.hpp"
#include "tests/unit/predicates/words.hpp"

namespace cadt::test {
namespace {

Device& device() {
  static auto* const opened = new std::unique_ptr<Device>(open_device(float_options()));  // never closed, on purpose
  return **opened;
}

class FloatSigns : public FloatTest {
 protected:
  static StageCounts check(const SignSet& set) {
    const std::vector<std::uint32_t> words = words_of(device(), set.floats, KernelVariant::narrow);
    const WrongSigns wrong = compare(set.floats, words);
    EXPECT_EQ(wrong.fields, 0u) << set.name << ": " << wrong.signs << " wrong signs, further wrong stages "
                                << wrong.stages << ", bits " << std::hex << wrong.fields << ", found "
                                << words[wrong.first] << ", first " << text(set.floats[wrong.first]);
    return stages_of(words);
  }
};

// Each stage decides a thousand cases or more, and the device takes the way that the host takes, where subnormal
// numbers are not flushed.
TEST_F(FloatSigns, SetsAgainstWholeNumbersAndEveryStage) {
  StageCounts sum;
  Lengths lengths{};
  for (const std::string& name : float_sets()) {
    const SignSet set = float_set(name);
    EXPECT_GE(set.floats.size(), 5000u) << name;
    const StageCounts found = check(set);
    sum.filtered_orientations += found.filtered_orientations, sum.exact_orientations += found.exact_orientations;
    sum.filtered_incircles += found.filtered_incircles, sum.exact_incircles += found.exact_incircles;
    sum.ties += found.ties;
    const Lengths here = count_floats(set.floats);
    lengths.orientation_128 += here.orientation_128, lengths.orientation_long += here.orientation_long;
    lengths.incircle_256 += here.incircle_256, lengths.incircle_long += here.incircle_long;
    lengths.incircle_192 += here.incircle_192, lengths.mirrored += here.mirrored;
  }
  std::cout << "filter " << sum.filtered_orientations << " + " << sum.filtered_incircles << ", exact "
            << sum.exact_orientations << " + " << sum.exact_incircles << ", ties " << sum.ties
            << "; orientation in 128 bits " << lengths.orientation_128 << ", long " << lengths.orientation_long
            << ", incircle in 256 bits " << lengths.incircle_256 << ", long " << lengths.incircle_long << '\n';
  for (const std::uint64_t count :
       {sum.filtered_orientations, sum.filtered_incircles, sum.exact_orientations, sum.exact_incircles, sum.ties,
        lengths.orientation_128, lengths.orientation_long, lengths.incircle_256, lengths.incircle_long})
    EXPECT_GE(count, 1000u);
  // ties ask for orientations that the device does not count
  EXPECT_LE(sum.exact_orientations, lengths.orientation_128 + lengths.orientation_long);
  EXPECT_GE(sum.exact_orientations + sum.ties, lengths.orientation_128 + lengths.orientation_long);
  EXPECT_EQ(sum.exact_incircles + sum.ties, lengths.incircle_256 + lengths.incircle_long);
  EXPECT_EQ(lengths.incircle_192 + lengths.mirrored, 0u) << "they rely on gradual underflow";
}

TEST_F(FloatSigns, NearTheBoundsOfFilters) {
  for (const char* name : {"float_near_line", "float_near_circle", "float_small", "float_bits"}) check(float_set(name));
}

}  // namespace
}  // namespace cadt::test
