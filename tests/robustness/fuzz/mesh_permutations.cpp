// SPDX-License-Identifier: Apache-2.0
// The same points in two orders.
#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/robustness/fuzz/fuzz.hpp"
#include "tests/robustness/fuzz/mesh_oracle.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cadt::fuzz::Bytes bytes(data, size);
  std::vector<double> xy;
  std::vector<std::uint8_t> keys;
  while (bytes.left() >= 3 && keys.size() < 96) {
    keys.push_back(bytes.take<std::uint8_t>());
    xy.push_back(bytes.take<std::int8_t>());
    xy.push_back(bytes.take<std::int8_t>());
  }
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  cadt::fuzz::check_order(xy, order);
  return 0;
}
