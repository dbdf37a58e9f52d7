// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/owners.hpp"

#include <algorithm>

namespace cadt::tiles::mpi {
namespace {

/// a * b / c without overflow of the product; 0 if c is 0. \pre the quotient is below 2^64
std::uint64_t share(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  __extension__ using Wide = unsigned __int128;
  return c == 0 ? 0 : static_cast<std::uint64_t>(Wide{a} * b / c);
}

}  // namespace

std::vector<int> owners(const TileTree& tree, const std::vector<bool>& valid, int ranks) {
  std::uint64_t all = 0;
  for (const std::uint32_t leaf : tree.leaves())
    if (!valid[leaf]) all += tree.node(leaf).points;
  std::vector<int> owner(tree.size(), 0);
  std::uint64_t before = 0;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    const TreeNode& node = tree.node(i);
    if (!node.is_leaf()) {
      owner[i] = owner[node.left];
      continue;
    }
    const std::uint64_t points = valid[i] ? 0 : node.points;
    // By the middle of the leaf, so that none is far from its share.
    const std::uint64_t rank = share(before + points / 2, static_cast<std::uint64_t>(ranks), all);
    owner[i] = std::min(static_cast<int>(rank), ranks - 1);
    before += points;
  }
  return owner;
}

std::pair<std::uint64_t, std::uint64_t> slice(std::uint64_t points, std::uint64_t block, int rank, int ranks) {
  const std::uint64_t blocks = (points + block - 1) / block;
  const auto begin = [&](int r) {
    return std::min(points, block * share(blocks, static_cast<std::uint64_t>(r), static_cast<std::uint64_t>(ranks)));
  };
  return {begin(rank), begin(rank + 1)};
}

}  // namespace cadt::tiles::mpi
