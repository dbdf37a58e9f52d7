// SPDX-License-Identifier: Apache-2.0
#include <cadt/cadt.hpp>

#include <array>

extern "C" int triangles_of_a_square() {
  const std::array<double, 8> xy = {0, 0, 1, 0, 1, 1, 0, 1};
  return static_cast<int>(cadt::triangulate(xy).number_of_triangles());
}
