// SPDX-License-Identifier: Apache-2.0
// Records of a closed mesh from its faces, ghosts among them (common/mesh/locked_mesh.dev.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace cadt::test {

using Face = std::array<std::uint32_t, 3>;

/// `Record` is cadt_locked_triangle, which tests of the device code have as a type of their own.
template <class Record>
std::vector<Record> linked_faces(const std::vector<Face>& faces, std::size_t slots) {
  constexpr std::size_t lock = 3, links = 4;                                // of the words of a record
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> across;  // edge -> record * 4 + edge
  for (std::uint32_t t = 0; t < faces.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) across[{faces[t][(k + 1) % 3], faces[t][(k + 2) % 3]}] = 4 * t + k;
  std::vector<Record> records(slots);
  for (std::size_t t = 0; t < faces.size(); ++t) {
    records[t].word[lock] = 2;
    for (std::size_t k = 0; k < 3; ++k) {
      records[t].word[k] = faces[t][k];
      records[t].word[links + k] = across.at({faces[t][(k + 2) % 3], faces[t][(k + 1) % 3]});
    }
  }
  return records;
}

}  // namespace cadt::test
