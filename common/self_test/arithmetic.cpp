// SPDX-License-Identifier: Apache-2.0
#include "common/self_test/self_test.hpp"

#include <array>
#include <cadt/errors.hpp>
#include <cstdio>

#include "common/points/device_points.hpp"

namespace cadt {
namespace {

// Everything is a bit pattern: nothing is computed here, so no option of this compiler can spoil the answers.
struct Probe {
  const char* name;
  std::uint64_t a, b, answer;
};

// One entry for each output of cadt_selftest (common/self_test/arithmetic.dev.h), in its order.
constexpr std::array<Probe, 8> probes = {{
    // a = 1 + 2^-27, b = -(1 + 2^-26). a*a = 1 + 2^-26 + 2^-54 rounds to 1 + 2^-26. Fused: 2^-54.
    {"contraction of a*a+b", 0x3FF0000002000000, 0xBFF0000004000000, 0x0000000000000000},
    // 1 + 2^-60 rounds to 1; the error is 2^-60. Simplified as if real numbers: 0.
    {"rounding error of a sum", 0x3FF0000000000000, 0x3C30000000000000, 0x3C30000000000000},
    // 3 * 2^-1074 times 1/2 is a tie between 1 and 2 units of 2^-1074. Flushed: 0.
    {"gradual underflow of a product", 0x0000000000000003, 0x3FE0000000000000, 0x0000000000000002},
    // 1.5 * 2^-1022 - 2^-1022 = 2^-1023. Flushed: 0.
    {"gradual underflow of a difference", 0x0018000000000000, 0x0010000000000000, 0x0008000000000000},
    // (1 + 2^-52) + 2^-53 is a tie; even is 1 + 2^-51. Downwards or to zero: 1 + 2^-52.
    {"rounding of a sum", 0x3FF0000000000001, 0x3CA0000000000000, 0x3FF0000000000002},
    // (1 + 2^-26) * (1 + 2^-27) = 1 + 2^-26 + 2^-27 + 2^-53 is a tie; even is without the last term. Upwards: with
    // 2^-52.
    {"rounding of a product", 0x3FF0000004000000, 0x3FF0000002000000, 0x3FF0000006000000},
    // 5 / 49 = 0x1.A1F58D0FAC687D6..., so ...688. By the rounded reciprocal: ...687.
    {"division", 0x4014000000000000, 0x4048800000000000, 0x3FBA1F58D0FAC688},
    // The bits as integers, the second one negated: the upper 64 bits of the product are -273407988852.
    {"64 x 64 bit product", 0x3FF123456789ABCD, 0x000000FEDCBA9871, 0xC24FD4316A3A0000},
}};

// The same for floats, in the lower words. Nothing relies on underflow or division there (CADT_GRADUAL_UNDERFLOW).
constexpr std::array<Probe, 8> float_probes = {{
    // a = 1 + 2^-13, b = -(1 + 2^-12). a*a = 1 + 2^-12 + 2^-26 rounds to 1 + 2^-12. Fused: 2^-26.
    {"contraction of a*a+b", 0x3F800400, 0xBF800800, 0x00000000},
    // 1 + 2^-30 rounds to 1; the error is 2^-30.
    {"rounding error of a sum", 0x3F800000, 0x30800000, 0x30800000},
    // 3 * 2^-149 and -5 * 2^-149
    {"a copy of a subnormal number", 0x00000003, 0x00000000, 0x00000003},
    {"a choice of subnormal numbers", 0x00000003, 0x80000005, 0x80000005},
    // (1 + 2^-23) + 2^-24 is a tie; even is 1 + 2^-22.
    {"rounding of a sum", 0x3F800001, 0x33800000, 0x3F800002},
    // (1 + 2^-12) * (1 + 2^-12) = 1 + 2^-11 + 2^-24 is a tie; even is without the last term.
    {"rounding of a product", 0x3F800800, 0x3F800800, 0x3F801000},
    {"division without a remainder", 0x41400000, 0x40800000, 0x40400000},
    // The bits as integers, repeated in the upper word, the second one negated: the upper 64 bits of the product are
    // -2283273547427657051.
    {"64 x 64 bit product", 0x3FF12345, 0x7EDCBA98, 0xDDFD7E8A},
}};

struct WordProbe {
  const char* name;
  std::uint32_t start, answer;
};

// Enough for several groups of every device, and no multiple of any group size, so that a launch is rounded up.
constexpr std::uint32_t items = 1001;
constexpr std::array<std::uint32_t, 2> product_words = {0x8F477283, 0x999E39D2},
                                       float_product_words = {0x8FE6ED08, 0x001E08DE};
constexpr std::array<WordProbe, 5> word_probes = {{
    {"64 x 64 bit product, low word", 0, 0},  // these two are above
    {"64 x 64 bit product, second word", 0, 0},
    {"atomic addition", 0, items},
    {"compare-and-swap", 0, 14},  // exactly one work-item swaps 0 for 7 and adds 7
    {"atomic minimum", 0xFFFFFFFF, 5},
}};

std::string hexadecimal(std::uint64_t value) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "0x%016llX", static_cast<unsigned long long>(value));
  return text.data();
}

void compare(const DeviceInfo& info, const char* name, std::uint64_t expected, std::uint64_t found) {
  if (expected == found) return;
  throw BackendUnavailable(std::string(to_string(info.backend)), "'" + info.name + "' fails the self-test '" + name +
                                                                     "': expected " + hexadecimal(expected) +
                                                                     ", found " + hexadecimal(found));
}

/// `Bits`: an integer as wide as a coordinate of the device.
template <class Bits>
void run_probes(Device& device, const std::array<Probe, 8>& of, const std::array<std::uint32_t, 2>& product,
                KernelVariant variant) {
  std::array<Bits, 2 * probes.size()> inputs{};
  for (std::size_t i = 0; i < of.size(); ++i) {
    inputs[2 * i] = static_cast<Bits>(of[i].a);
    inputs[2 * i + 1] = static_cast<Bits>(of[i].b);
  }
  std::array<Bits, probes.size()> outputs{};
  std::array<std::uint32_t, word_probes.size()> words{};
  for (std::size_t i = 0; i < word_probes.size(); ++i) words[i] = word_probes[i].start;

  const auto in = device.allocate(sizeof inputs), out = device.allocate(sizeof outputs),
             counters = device.allocate(sizeof words);
  device.write(*in, 0, inputs.data(), sizeof inputs);
  device.fill(*out, 0, sizeof outputs,
              0xA5A5A5A5u);  // no answer has these bits: an output that is not written is noticed
  device.write(*counters, 0, words.data(), sizeof words);
  const std::array<Arg, 4> arguments = {Arg(in), Arg(out), Arg(counters), Arg(items)};
  device.launch(KernelId::cadt_selftest, items, arguments, variant);
  device.finish();
  device.read(*out, 0, outputs.data(), sizeof outputs);
  device.read(*counters, 0, words.data(), sizeof words);

  for (std::size_t i = 0; i < of.size(); ++i) compare(device.info(), of[i].name, of[i].answer, outputs[i]);
  for (std::size_t i = 0; i < word_probes.size(); ++i)
    compare(device.info(), word_probes[i].name, i < product.size() ? product[i] : word_probes[i].answer, words[i]);
}

}  // namespace

void run_selftest(Device& device, KernelVariant variant) {
  if (takes_floats_only(device))
    run_probes<std::uint32_t>(device, float_probes, float_product_words, variant);
  else
    run_probes<std::uint64_t>(device, probes, product_words, variant);
}

}  // namespace cadt
