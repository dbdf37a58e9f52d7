// SPDX-License-Identifier: Apache-2.0
// The table of what CGAL makes of every set of points of the tests, so that machines without CGAL can compare with it.
#pragma once

#include "tests/support/families.hpp"
#include "tests/support/oracle.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cadt::test {

struct GoldenSet {
  std::string name;  ///< "family/tiny/none", "generated/...", "hard/FILE", "catalogue/ID", "real/NAME"
  std::function<Points()> make;
  bool refused = false;        ///< has NaN or infinity
  bool from_script = false;    ///< written by a script that calls the sin and cos of the C library
  std::size_t points = 0;      ///< as an index says; 0 if none does
  std::filesystem::path file;  ///< empty if it is computed
};

/// The families, and larger sets of the tests that are not in a family.
[[nodiscard]] std::vector<GoldenSet> family_sets();
[[nodiscard]] std::vector<GoldenSet> generated_sets();
/// Those of data_folder(), which must be there.
[[nodiscard]] std::vector<GoldenSet> hard_sets();
[[nodiscard]] std::vector<GoldenSet> catalogue_sets();
[[nodiscard]] std::vector<GoldenSet> real_golden_sets();
/// All of these; without a data folder the first two kinds.
[[nodiscard]] std::vector<GoldenSet> golden_sets();

/// A line of the table.
struct GoldenRow {
  std::string name;
  std::size_t points = 0, triangles = 0;
  std::string points_hash;  ///< of the bits of all coordinates: other points have another mesh
  std::string mesh_hash;    ///< as Triangulation::hash() of the mesh, or "refused"
  friend bool operator==(const GoldenRow&, const GoldenRow&) = default;
  [[nodiscard]] std::string line() const;
};

/// Is its set one of the data folder?
[[nodiscard]] bool is_row_of_file(const GoldenRow& row);

/// Throws std::runtime_error for a line that is not one.
[[nodiscard]] std::vector<GoldenRow> read_table(const std::filesystem::path& file);

[[nodiscard]] std::string hash_of_points(const Points& xy);
/// What Triangulation::hash() gives for this mesh, computed without the library.
[[nodiscard]] std::string hash_of_mesh(const OracleMesh& mesh);

}  // namespace cadt::test
