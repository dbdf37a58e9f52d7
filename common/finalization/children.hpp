// SPDX-License-Identifier: Apache-2.0
// What the children of a join pass to it. Their arrays stay where they are: what is open is a few thousandths of the
// points, but to copy it takes as long as to triangulate it.
#pragma once

#include <cadt/finalization.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/driver/context.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt::finalization {

/// The open vertices and the sides of all children, numbered one child after the other. Must not outlive them.
class Children {
 public:
  /// \throws LimitError, InputError
  explicit Children(std::span<const Open> children);
  [[nodiscard]] std::size_t vertices() const noexcept { return pieces_.back().first_vertex; }
  [[nodiscard]] std::size_t sides() const noexcept { return pieces_.back().first_side; }
  /// If the ids of each child ascend.
  [[nodiscard]] std::uint64_t largest_id() const noexcept;
  /// Copies coordinates and ids of the vertices to the device.
  void write(Device& device, const Allocation& points, const Allocation& ids) const;

  [[nodiscard]] verifier::Point point(std::size_t vertex) const {
    const Piece& piece = piece_of(vertex, &Piece::first_vertex);
    return point_of(*piece.open, vertex - piece.first_vertex);
  }
  /// The final triangle of a side.
  [[nodiscard]] TriangleId triangle(std::size_t side) const {
    const Piece& piece = piece_of(side, &Piece::first_side);
    return piece.open->sides[side - piece.first_side].triangle;
  }

  /// A side with its number, the numbers of its ends, and these.
  struct Side {
    std::size_t number;
    const OpenSide& side;
    std::uint32_t from, to;
    verifier::Point a, b;
  };
  /// Pieces of the list of sides, in its order, for threads.
  [[nodiscard]] std::size_t stretches() const noexcept { return stretches_.size(); }
  /// Number of the first side of a stretch.
  [[nodiscard]] std::size_t first_side(std::size_t stretch) const {
    const Stretch& s = stretches_[stretch];
    return pieces_[s.piece].first_side + s.begin;
  }
  [[nodiscard]] std::size_t end_side(std::size_t stretch) const {
    const Stretch& s = stretches_[stretch];
    return pieces_[s.piece].first_side + s.end;
  }
  /// Calls body(side) for those of a stretch. \throws InputError for one that is not between two vertices of its child
  template <class Body>
  void each_side(std::size_t stretch, const Body& body) const {
    const Stretch& s = stretches_[stretch];
    const Piece& piece = pieces_[s.piece];
    const Open& open = *piece.open;
    const auto first = static_cast<std::uint32_t>(piece.first_vertex);
    for (std::size_t i = s.begin; i < s.end; ++i) {
      const OpenSide& side = open.sides[i];
      if (side.from >= open.ids.size() || side.to >= open.ids.size() || side.from == side.to) refuse(piece, i);
      body(Side{piece.first_side + i, side, first + side.from, first + side.to, point_of(open, side.from),
                point_of(open, side.to)});
    }
  }

 private:
  struct Piece {
    const Open* open = nullptr;
    std::size_t first_vertex = 0, first_side = 0;
  };
  struct Stretch {
    std::size_t piece, begin, end;
  };
  [[nodiscard]] static verifier::Point point_of(const Open& open, std::size_t v) {
    return {open.xy[2 * v], open.xy[2 * v + 1]};
  }
  [[nodiscard]] const Piece& piece_of(std::size_t i, std::size_t Piece::*first) const {
    return *(std::ranges::upper_bound(pieces_, i, {}, first) - 1);
  }
  [[noreturn]] static void refuse(const Piece& piece, std::size_t side);

  std::vector<Piece> pieces_;  // of each child, and what comes behind the last
  std::vector<Stretch> stretches_;
};

}  // namespace cadt::finalization
