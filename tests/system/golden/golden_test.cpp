// SPDX-License-Identifier: Apache-2.0
// Every back end against the table of what CGAL finds, on every family and every file; needs no CGAL. The runs of a set
// go through all configurations (threads, block sizes) of the back end in turn; CADT_GOLDEN_RUNS says how many. The
// first one is compared with the table, the others with its arrays.
#include "tests/system/golden/golden.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/data_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cadt::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* no_data = "no data folder: CADT_DATA_DIR is not set and the default is not there";
constexpr std::size_t small_up_to = 16000;

const std::map<std::string, GoldenRow>& table() {
  static const auto rows = [] {
    std::map<std::string, GoldenRow> result;
    for (GoldenRow& row : read_table(CADT_GOLDEN_TABLE)) result.emplace(row.name, row);
    return result;
  }();
  return rows;
}

std::size_t runs(std::size_t otherwise) {
  const char* variable = std::getenv("CADT_GOLDEN_RUNS");
  const int value = variable ? std::atoi(variable) : 0;
  return value > 0 ? static_cast<std::size_t>(value) : otherwise;
}

class Golden : public BackendTest {
 protected:
  void check(const std::vector<GoldenSet>& sets) { check(sets, runs(cases_of(GetParam().backend).size())); }
  // One run unless more are asked for.
  void check_large(const std::vector<GoldenSet>& sets) { check(sets, runs(1)); }

 private:
  void check(const std::vector<GoldenSet>& sets, std::size_t times) {
    ASSERT_FALSE(sets.empty());
    std::size_t compared = 0;
    for (const GoldenSet& set : sets) {
      const auto row = table().find(set.name);
      if (row == table().end()) {
        ADD_FAILURE() << set.name << " has no row in the table: write it anew with cadt-make-golden";
        continue;
      }
      const Points xy = set.make();
      const bool same_points = hash_of_points(xy) == row->second.points_hash;
      if (!same_points && !set.from_script) {
        ADD_FAILURE() << set.name << ": the points differ from those that the table was made of (" << xy.size() / 2
                      << " points, " << row->second.points << " in the table), so the meshes cannot be compared";
        continue;
      }
      if (!same_points) {
        std::cout << set.name << ": this machine's sin and cos make other points than those of the table; verified\n";
      }
      const std::vector<BackendCase> configurations = cases_of(GetParam().backend);
      Triangulation first;
      for (std::size_t run = 0; run < times && !HasFatalFailure(); ++run) {
        const BackendCase& c = configurations[run % configurations.size()];
        const std::string what = set.name + " on " + c.name + ", run " + std::to_string(run);
        if (row->second.mesh_hash == "refused") {
          EXPECT_THROW((void)opened(c).triangulate(std::span<const double>(xy)), InputError) << what;
        } else if (run == 0) {
          first = opened(c).triangulate(std::span<const double>(xy));
          compare(xy, first, row->second, same_points, what);
          expect_same_arrays(deferring(c, xy), first, what + ", deferring edges that are flipped often");
          expect_same_arrays(with_stars(c, xy), first, what + ", with stars");
        } else {
          expect_same_arrays(opened(c).triangulate(std::span<const double>(xy)), first, what);
        }
        ++compared;
      }
    }
    RecordProperty("meshes_compared", std::to_string(compared));
  }

  /// Each configuration is opened once in a process.
  static Triangulator& opened(const BackendCase& c) {
    static auto& all = *new std::map<std::string, Triangulator>;  // drivers may be gone before static objects
    const std::string name = std::string(to_string(c.backend)) + '/' + c.name;
    const auto found = all.find(name);
    return found != all.end() ? found->second : all.emplace(name, Triangulator(c.options())).first->second;
  }

  /// The mesh with Stabilize::defer, which must not show.
  static Triangulation deferring(const BackendCase& c, const Points& xy) {
    struct Scope {
      Options& options;
      ~Scope() { options.tuning.stabilize = Stabilize::off; }
    } const scope{opened(c).options()};
    scope.options.tuning.stabilize = Stabilize::defer;
    return opened(c).triangulate(std::span<const double>(xy));
  }

  /// The mesh with Strategy::stars, which must not show.
  static Triangulation with_stars(const BackendCase& c, const Points& xy) {
    struct Scope {
      Options& options;
      ~Scope() { options.tuning.strategy = Strategy::automatic; }
    } const scope{opened(c).options()};
    scope.options.tuning.strategy = Strategy::stars;
    return opened(c).triangulate(std::span<const double>(xy));
  }

  static void expect_same_arrays(const Triangulation& mesh, const Triangulation& first, const std::string& what) {
    EXPECT_TRUE(std::ranges::equal(mesh.triangles(), first.triangles())) << what;
    EXPECT_TRUE(std::ranges::equal(mesh.neighbors(), first.neighbors())) << what;
    EXPECT_TRUE(std::ranges::equal(mesh.hull(), first.hull())) << what;
    EXPECT_TRUE(std::ranges::equal(mesh.duplicates(), first.duplicates())) << what;
    EXPECT_EQ(mesh.dimension(), first.dimension()) << what;
  }

  static void compare(const Points& xy, const Triangulation& mesh, const GoldenRow& row, bool same_points,
                      const std::string& what) {
    ASSERT_EQ(mesh.statistics().backend, to_string(GetParam().backend)) << what;
    if (!same_points) {
      EXPECT_TRUE(verify(std::span<const double>(xy), mesh).ok) << what;
      return;
    }
    EXPECT_EQ(mesh.number_of_points(), row.points) << what;
    EXPECT_EQ(mesh.number_of_triangles(), row.triangles) << what;
    EXPECT_EQ(mesh.hash().to_string(), row.mesh_hash) << what;
  }
};

std::vector<GoldenSet> real_between(std::size_t more_than, std::size_t up_to) {
  std::vector<GoldenSet> sets = real_golden_sets();
  std::erase_if(sets, [&](const GoldenSet& set) { return set.points <= more_than || set.points > up_to; });
  return sets;
}

TEST_P(Golden, Families) { check(family_sets()); }
TEST_P(Golden, Generated) { check_large(generated_sets()); }
TEST_P(Golden, HardFiles) {
  if (!data_folder()) GTEST_SKIP() << no_data;
  check(hard_sets());
}
TEST_P(Golden, Catalogue) {
  if (!data_folder()) GTEST_SKIP() << no_data;
  check(catalogue_sets());
}
TEST_P(Golden, SmallRealSets) {
  if (!data_folder()) GTEST_SKIP() << no_data;
  check(real_between(0, small_up_to));
}
TEST_P(Golden, LargerRealSets) {
  if (!data_folder()) GTEST_SKIP() << no_data;
  check_large(real_between(small_up_to, static_cast<std::size_t>(-1)));
}

// One instance of a back end: the tests themselves go through its configurations.
std::vector<BackendCase> every(Backend backend) {
  return cases_of(backend).empty() ? std::vector<BackendCase>{} : std::vector<BackendCase>{{"all", backend, 0, 0}};
}
std::vector<BackendCase> every_host() { return every(Backend::host); }
std::vector<BackendCase> every_opencl() { return every(Backend::opencl); }
std::vector<BackendCase> every_cuda() { return every(Backend::cuda); }
INSTANTIATE_TEST_SUITE_P(host, Golden, testing::ValuesIn(every_host()), case_name);
INSTANTIATE_TEST_SUITE_P(opencl, Golden, testing::ValuesIn(every_opencl()), case_name);
INSTANTIATE_TEST_SUITE_P(cuda, Golden, testing::ValuesIn(every_cuda()), case_name);

void expect_same_names(const std::vector<GoldenSet>& sets, bool of_files) {
  std::set<std::string> names;
  for (const GoldenSet& set : sets) {
    EXPECT_TRUE(names.insert(set.name).second) << set.name << " twice";
    EXPECT_TRUE(table().contains(set.name)) << set.name << " has no row: write the table anew with cadt-make-golden";
  }
  for (const auto& [name, row] : table()) {
    if (is_row_of_file(row) == of_files) {
      EXPECT_TRUE(names.contains(name)) << "nothing uses the row " << name;
    }
  }
}

TEST(GoldenTable, HasEachNameOnce) {
  const std::vector<GoldenRow> rows = read_table(CADT_GOLDEN_TABLE);
  EXPECT_EQ(rows.size(), table().size());
  EXPECT_GT(rows.size(), 500u);
}

TEST(GoldenTable, HasTheFamiliesAndNothingElse) {
  std::vector<GoldenSet> sets = family_sets(), more = generated_sets();
  sets.insert(sets.end(), more.begin(), more.end());
  expect_same_names(sets, false);
}

TEST(GoldenTable, HasTheFilesAndNothingElse) {
  if (!data_folder()) GTEST_SKIP() << no_data;
  std::vector<GoldenSet> sets = hard_sets(), catalogue = catalogue_sets(), real = real_golden_sets();
  sets.insert(sets.end(), catalogue.begin(), catalogue.end());
  sets.insert(sets.end(), real.begin(), real.end());
  expect_same_names(sets, true);
  // A file that no index names would never be read.
  std::set<fs::path> used;
  for (const GoldenSet& set : sets) used.insert(set.file);
  for (const char* folder : {"hard", "real"}) {
    for (const auto& entry : fs::directory_iterator(*data_folder() / folder)) {
      fs::path name = entry.path().filename();
      if (name.extension() == ".xz") name = name.stem();
      if (name.extension() != ".xy" && name.extension() != ".f64") continue;
      fs::path packed = entry.path();
      packed += ".xz";
      EXPECT_TRUE(used.contains(entry.path()) || used.contains(packed)) << entry.path() << " is in no index";
    }
  }
}

TEST(GoldenTable, TellsMeshesApart) {
  const OracleMesh square{2, {0, 1, 2, 3, 1}, {{0, 1, 2}, {0, 2, 3}}};
  OracleMesh other = square;
  other.triangles = {{0, 1, 3}, {1, 2, 3}};
  EXPECT_NE(hash_of_mesh(other), hash_of_mesh(square));
  other = square;
  other.representative[4] = 2;
  EXPECT_NE(hash_of_mesh(other), hash_of_mesh(square));
  other = square;
  std::swap(other.triangles[0], other.triangles[1]);
  EXPECT_EQ(hash_of_mesh(other), hash_of_mesh(square));
  EXPECT_NE(hash_of_points({0.0, 1.0}), hash_of_points({-0.0, 1.0}));
  EXPECT_NE(hash_of_points({0.0, 1.0}), hash_of_points({1.0, 0.0}));
}

}  // namespace
}  // namespace cadt::test
