// SPDX-License-Identifier: Apache-2.0
// Point sets that are not part of this repository: CADT_DATA_DIR names the folder that has `hard/` and `real/`.
#pragma once

#include "tests/support/families.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cadt::test {

/// The folder, or nothing if it is not there. Default: ../shared/data beside the source tree.
[[nodiscard]] std::optional<std::filesystem::path> data_folder();

struct ExactCounts {
  std::string name;  ///< file name, or id of a generator
  std::uint64_t points = 0, duplicates = 0, hull = 0, triangles = 0;
  bool not_finite = false;  ///< must be refused
};

/// Counts that were computed with whole numbers, from `hard/EXPECTED.tsv` and `hard/CATALOGUE_EXPECTED.tsv`.
[[nodiscard]] std::vector<ExactCounts> expected_of_files();
[[nodiscard]] std::vector<ExactCounts> expected_of_catalogue();

/// A file of `hard/`, and the output of a generator (made once, kept in the build folder); `factor`: with about so many
/// times its points (tests/support/catalogue.py).
[[nodiscard]] Points hard_file(const std::string& name);
[[nodiscard]] Points catalogue_set(const std::string& id, unsigned factor = 1);

struct RealSet {
  std::string name;
  std::size_t points = 0;  ///< as the index says
  std::filesystem::path file;
};
/// The sets of `real/INDEX.md` whose file is there, smallest first.
[[nodiscard]] std::vector<RealSet> real_sets();
[[nodiscard]] Points read(const RealSet& set);

/// The file itself, or what it is once unpacked if it ends in .xz, with the name that it then has, kept in the build
/// folder under `kind`. `file`: of the data folder
[[nodiscard]] std::filesystem::path unpacked(const std::filesystem::path& file, const std::string& kind);

}  // namespace cadt::test
