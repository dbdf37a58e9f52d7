// SPDX-License-Identifier: Apache-2.0
#include "tests/system/golden/golden.hpp"

#include "tests/support/data_files.hpp"

#include <bit>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace cadt::test {
namespace {

// The hash of the library, once more: a sum of mixed items, so that their order does not count.
constexpr std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93U;
  x ^= x >> 29;
  x *= 0x9e3779b97f4a7c15U;
  return x ^ (x >> 32);
}
constexpr std::uint64_t mix(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return mix(mix(mix(seed + a) + b) + c);
}

class MeshHash {
 public:
  void add(std::uint64_t kind, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    high_ += mix(0x243f6a8885a308d3U + kind, a, b, c);
    low_ += mix(0x13198a2e03707344U ^ (kind << 32), c, a, b);
  }
  [[nodiscard]] std::uint64_t high() const { return high_; }
  [[nodiscard]] std::uint64_t low() const { return low_; }

 private:
  std::uint64_t high_ = 0, low_ = 0;
};

std::string hexadecimal(std::uint64_t value) {
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[(value >> shift) & 15u];
  return text;
}

}  // namespace

std::vector<GoldenSet> family_sets() {
  std::vector<GoldenSet> sets;
  for (const FamilyGroup& group : family_groups()) {
    for (Family& family : group.families())
      sets.push_back(
          {"family/" + std::string(group.name) + "/" + family.name, std::move(family.make), false, false, 0, {}});
  }
  return sets;
}

std::vector<GoldenSet> generated_sets() {
  const auto set = [](const char* name, std::function<Points()> make) {
    return GoldenSet{std::string("generated/") + name, std::move(make), false, false, 0, {}};
  };
  return {
      set("uniform_100000", [] { return uniform_points(100000); }),
      set("999_of_1000_in_1e-12", [] { return skewed_points(100000); }),
      set("gaussians_1e-6", [] { return cluster_points(100000); }),
      set("two_clusters_1e12_apart", [] { return two_clusters(100000); }),
      set("grid_300x300_shuffled", [] { return shuffled(grid_points(300, 300), 7); }),
      set("hub_10000", [] { return hub_points(10000); }),
      set("uniform_1000000", [] { return uniform_points(1000000); }),
  };
}

std::vector<GoldenSet> hard_sets() {
  std::vector<GoldenSet> sets;
  for (const ExactCounts& counts : expected_of_files()) {
    const std::string name = counts.name;
    sets.push_back({"hard/" + name, [name] { return hard_file(name); }, counts.not_finite, false, counts.points,
                    *data_folder() / "hard" / name});
  }
  return sets;
}

std::vector<GoldenSet> catalogue_sets() {
  std::vector<GoldenSet> sets;
  for (const ExactCounts& counts : expected_of_catalogue()) {
    const std::string id = counts.name;
    sets.push_back({"catalogue/" + id, [id] { return catalogue_set(id); }, counts.not_finite, true, counts.points, {}});
  }
  return sets;
}

std::vector<GoldenSet> real_golden_sets() {
  std::vector<GoldenSet> sets;
  for (const RealSet& set : real_sets())
    sets.push_back({"real/" + set.name, [set] { return read(set); }, false, false, set.points, set.file});
  return sets;
}

std::vector<GoldenSet> golden_sets() {
  std::vector<GoldenSet> all = family_sets();
  const auto add = [&](std::vector<GoldenSet> more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  add(generated_sets());
  if (!data_folder()) return all;
  add(hard_sets());
  add(catalogue_sets());
  add(real_golden_sets());
  return all;
}

std::string GoldenRow::line() const {
  return name + '\t' + std::to_string(points) + '\t' + std::to_string(triangles) + '\t' + points_hash + '\t' +
         mesh_hash;
}

bool is_row_of_file(const GoldenRow& row) {
  return row.name.starts_with("hard/") || row.name.starts_with("catalogue/") || row.name.starts_with("real/");
}

std::vector<GoldenRow> read_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  std::vector<GoldenRow> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    GoldenRow row;
    std::istringstream fields(line);
    fields >> row.name >> row.points >> row.triangles >> row.points_hash >> row.mesh_hash;
    if (!fields || row.line() != line) throw std::runtime_error(file.string() + ": not a row: " + line);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string hash_of_points(const Points& xy) {
  std::uint64_t hash = xy.size();
  for (const double value : xy) hash = mix(hash + std::bit_cast<std::uint64_t>(value));
  return hexadecimal(hash);
}

std::string hash_of_mesh(const OracleMesh& mesh) {
  MeshHash hash;
  for (const Triangle& t : mesh.triangles) {
    hash.add(1, static_cast<std::uint64_t>(t[0]), static_cast<std::uint64_t>(t[1]), static_cast<std::uint64_t>(t[2]));
  }
  std::size_t distinct = 0;
  for (std::size_t i = 0; i < mesh.representative.size(); ++i) {
    const auto r = static_cast<std::size_t>(mesh.representative[i]);
    if (r != i) hash.add(2, i, r, 0);
    distinct += r == i;
  }
  const std::size_t n = mesh.triangles.size(), hull = mesh.dimension < 2 ? 0 : 2 * distinct - 2 - n;
  hash.add(3, mesh.representative.size(), n, hull);
  hash.add(4, static_cast<std::uint64_t>(mesh.dimension + 1), 0, 0);
  return hexadecimal(hash.high()) + hexadecimal(hash.low());
}

}  // namespace cadt::test
