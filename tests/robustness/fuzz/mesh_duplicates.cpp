// SPDX-License-Identifier: Apache-2.0
// Few places, many points: a pool of sixteen points of any bits, then one byte a point. 0 and -0 are equal.
#include <array>
#include <vector>

#include "tests/robustness/fuzz/fuzz.hpp"
#include "tests/robustness/fuzz/mesh_oracle.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cadt::fuzz::Bytes bytes(data, size);
  const auto mode = bytes.take<std::uint8_t>();
  std::array<double, 32> pool{};
  for (double& v : pool) v = mode & 1u ? bytes.take<double>() : bytes.take<std::int8_t>() / 4.0;
  std::vector<double> xy;
  while (bytes.left() != 0 && xy.size() < 2 * 256) {
    const auto choice = bytes.take<std::uint8_t>();
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double v = pool[2 * (choice & 15u) + axis];
      xy.push_back(v == 0 && (choice >> (6 + axis) & 1u) != 0 ? -v : v);
    }
  }
  cadt::fuzz::check_mesh(xy, mode >> 2 == 0);
  return 0;
}
