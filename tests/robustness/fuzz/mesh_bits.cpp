// SPDX-License-Identifier: Apache-2.0
// Points of any bits: subnormal numbers, the largest ones, NaN and infinities among them.
#include <bit>
#include <vector>

#include "tests/robustness/fuzz/fuzz.hpp"
#include "tests/robustness/fuzz/mesh_oracle.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cadt::fuzz::Bytes bytes(data, size);
  const auto mode = bytes.take<std::uint8_t>();
  std::vector<double> xy;
  while (bytes.left() >= 8 && xy.size() < 2 * 64) {
    for (int axis = 0; axis < 2; ++axis) {
      if (mode & 1u) {
        xy.push_back(static_cast<double>(bytes.take<float>()));
      } else if (mode & 2u) {  // exponents of a few binades: coordinates that meet each other
        auto bits = bytes.take<std::uint64_t>();
        bits = (bits & 0x800FFFFFFFFFFFFFu) | (std::uint64_t{0x3F8} + (bits >> 52 & 7u)) << 52;
        xy.push_back(std::bit_cast<double>(bits));
      } else {
        xy.push_back(bytes.take<double>());
      }
    }
  }
  cadt::fuzz::check_mesh(xy, mode >> 2 == 0);
  return 0;
}
