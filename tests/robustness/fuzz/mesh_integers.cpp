// SPDX-License-Identifier: Apache-2.0
// Small integers, scaled and moved: ties, rows, duplicates.
#include <cmath>
#include <vector>

#include "tests/robustness/fuzz/fuzz.hpp"
#include "tests/robustness/fuzz/mesh_oracle.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cadt::fuzz::Bytes bytes(data, size);
  const auto mode = bytes.take<std::uint8_t>();
  const int exponent = bytes.take<std::int8_t>() * 8;
  const double shift = mode & 1u ? std::ldexp(1.0, 30) + 0.5 : 0.0;
  const int mask = mode & 2u ? 7 : 127;  // a lattice with as many points as places
  std::vector<double> xy;
  while (bytes.left() >= 2 && xy.size() < 2 * 96) {
    for (int axis = 0; axis < 2; ++axis) {
      const int value = bytes.take<std::int8_t>();
      xy.push_back(std::ldexp((value < 0 ? -(-value & mask) : value & mask) + shift, exponent));
    }
  }
  cadt::fuzz::check_mesh(xy, mode >> 2 == 0);
  return 0;
}
