// SPDX-License-Identifier: Apache-2.0
#include "common/host/selftest.hpp"

#include <array>
#include <cadt/errors.hpp>
#include <cstdio>

namespace cadt {
namespace {

// Everything is a bit pattern: nothing is computed here, so no option of this compiler can spoil the answers.
struct Probe {
  const char* name;
  std::uint64_t a, b, answer;
};

// One entry for each output of cadt_selftest (common/device/selftest.h), in its order.
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

struct WordProbe {
  const char* name;
  std::uint32_t start, answer;
};

// Enough for several groups of every device, and no multiple of any group size, so that a launch is rounded up.
constexpr std::uint32_t items = 1001;
constexpr std::array<WordProbe, 5> word_probes = {{
    {"64 x 64 bit product, low word", 0, 0x8F477283},
    {"64 x 64 bit product, second word", 0, 0x999E39D2},
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

}  // namespace

void run_selftest(Device& device) {
  std::array<std::uint64_t, 2 * probes.size()> inputs{};
  for (std::size_t i = 0; i < probes.size(); ++i) {
    inputs[2 * i] = probes[i].a;
    inputs[2 * i + 1] = probes[i].b;
  }
  std::array<std::uint64_t, probes.size()> outputs{};
  std::array<std::uint32_t, word_probes.size()> words{};
  for (std::size_t i = 0; i < word_probes.size(); ++i) words[i] = word_probes[i].start;

  const auto in = device.allocate(sizeof inputs), out = device.allocate(sizeof outputs),
             counters = device.allocate(sizeof words);
  device.write(*in, 0, inputs.data(), sizeof inputs);
  device.fill(*out, 0, sizeof outputs, 0xA5A5A5A5u);  // no answer has these bits: an output not written is seen
  device.write(*counters, 0, words.data(), sizeof words);
  const std::array<Arg, 4> arguments = {Arg(in), Arg(out), Arg(counters), Arg(items)};
  device.launch(KernelId::cadt_selftest, items, arguments, KernelBuild::narrow);
  device.finish();
  device.read(*out, 0, outputs.data(), sizeof outputs);
  device.read(*counters, 0, words.data(), sizeof words);

  for (std::size_t i = 0; i < probes.size(); ++i) compare(device.info(), probes[i].name, probes[i].answer, outputs[i]);
  for (std::size_t i = 0; i < word_probes.size(); ++i)
    compare(device.info(), word_probes[i].name, word_probes[i].answer, words[i]);
}

}  // namespace cadt
