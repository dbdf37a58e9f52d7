// SPDX-License-Identifier: Apache-2.0
#include "common/finalization/children.hpp"

#include <string>

#include "common/finalization/finish.hpp"

namespace cadt::finalization {

Children::Children(std::span<const Open> children) {
  constexpr std::size_t longest = std::size_t{1} << 13;
  Piece at;
  for (const Open& child : children) {
    if (child.xy.size() != 2 * child.ids.size())
      throw InputError("the open vertices of a child have not two coordinates each", child.ids.size());
    at.open = &child;
    for (std::size_t begin = 0; begin < child.sides.size(); begin += longest)
      stretches_.push_back({pieces_.size(), begin, std::min(child.sides.size(), begin + longest)});
    pieces_.push_back(at);
    at.first_vertex += child.ids.size();
    at.first_side += child.sides.size();
  }
  at.open = nullptr;
  pieces_.push_back(at);
  if (vertices() > max_points())
    throw LimitError(
        std::to_string(vertices()) + " vertices are open in a join, more than " + std::to_string(max_points()) +
            ": most circles are larger than the tiles, as those of points on one circle; take fewer points",
        vertices(), max_points());
}

std::uint64_t Children::largest_id() const noexcept {
  std::uint64_t largest = 0;
  for (const Piece& piece : pieces_)
    if (piece.open != nullptr && !piece.open->ids.empty()) largest = std::max(largest, piece.open->ids.back());
  return largest;
}

void Children::write(Device& device, const Allocation& points, const Allocation& ids) const {
  for (const Piece& piece : pieces_) {
    if (piece.open == nullptr || piece.open->ids.empty()) continue;
    const std::size_t first = piece.first_vertex, count = piece.open->ids.size();
    device.write(*points, 2 * sizeof(double) * first, piece.open->xy.data(), 2 * sizeof(double) * count);
    device.write(*ids, id_bytes * first, piece.open->ids.data(), id_bytes * count);
  }
}

void Children::refuse(const Piece& piece, std::size_t side) {
  throw InputError("a side of a child is not one between two of its open vertices", piece.first_side + side);
}

}  // namespace cadt::finalization
