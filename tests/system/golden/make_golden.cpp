// SPDX-License-Identifier: Apache-2.0
// Writes the table, or compares it with what CGAL finds now. Nothing of the library takes part.
#include "tests/support/data_files.hpp"
#include "tests/system/golden/golden.hpp"

#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace cadt::test;

GoldenRow row_of(const GoldenSet& set) {
  const Points xy = set.make();
  GoldenRow row{set.name, xy.size() / 2, 0, hash_of_points(xy), "refused"};
  if (set.refused) return row;
  const OracleMesh mesh = cgal_delaunay(xy);
  row.triangles = mesh.triangles.size();
  row.mesh_hash = hash_of_mesh(mesh);
  return row;
}

// Without the data folder the rows of its sets stay as they are.
int write(const std::string& file) {
  std::vector<GoldenRow> rows;
  for (const GoldenSet& set : golden_sets()) rows.push_back(row_of(set));
  if (!data_folder()) {
    for (GoldenRow& row : read_table(file)) {
      if (is_row_of_file(row)) rows.push_back(std::move(row));
    }
    std::cout << "no data folder (CADT_DATA_DIR): the rows of hard, catalogue and real were kept\n";
  }
  std::ofstream out(file);
  out << "# What CGAL's Delaunay_triangulation_2 with exact predicates makes of the sets of the tests; written by\n"
         "# cadt-make-golden, compared by tests/system/golden/golden_test.cpp. name, points, triangles, hash of the "
         "points,\n"
         "# hash of the mesh as Triangulation::hash() gives it\n";
  for (const GoldenRow& row : rows) out << row.line() << '\n';
  out.close();
  if (!out) std::cerr << "make_golden: cannot write " << file << '\n';
  return out ? 0 : 1;
}

int check(const std::string& file) {
  std::map<std::string, GoldenRow> rows;
  for (GoldenRow& row : read_table(file)) rows.emplace(row.name, row);
  int wrong = 0;
  std::size_t compared = 0;
  for (const GoldenSet& set : golden_sets()) {
    const GoldenRow now = row_of(set);
    const auto found = rows.find(set.name);
    ++compared;
    if (found == rows.end()) {
      std::cout << "no row: " << now.line() << '\n', ++wrong;
    } else if (now.points_hash != found->second.points_hash && set.from_script) {
      std::cout << set.name << ": not compared, this machine's sin and cos make other points\n", --compared;
    } else if (now != found->second) {
      std::cout << "table: " << found->second.line() << "\nCGAL:  " << now.line() << '\n', ++wrong;
    }
  }
  std::cout << compared << " of " << rows.size() << " rows compared, " << wrong << " differ\n";
  if (!data_folder()) std::cout << "no data folder (CADT_DATA_DIR): hard, catalogue and real were not compared\n";
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count == 2) return write(arguments[1]);
    if (count == 3 && std::string_view(arguments[1]) == "--check") return check(arguments[2]);
  } catch (const std::exception& error) {
    std::cerr << "make_golden: " << error.what() << '\n';
    return 1;
  }
  std::cerr << "usage: cadt-make-golden FILE   writes the table\n"
               "       cadt-make-golden --check FILE\n";
  return 2;
}
