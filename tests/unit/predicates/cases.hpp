// SPDX-License-Identifier: Apache-2.0
// Cases for the predicates: four points, and the word that the kernel cadt_predicate_probe
// (common/predicates/predicate_probe.dev.h) must give for them. Signs come from whole numbers of any length, stages
// from the bounds as they are documented.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace cadt::test {

struct PlanePoint {
  double x, y;
};
using Four = std::array<PlanePoint, 4>;

/// One case for one build. Plain data: tests/unit/predicates/evaluate.cpp reads it from a file.
struct SignCase {
  Four points;         ///< a, b, c, not clockwise, and p
  double most;         ///< at least the magnitude of the incircle determinant
  std::uint64_t word;  ///< what the kernel must give
};

/// Points in full precision, and the word in hexadecimal.
[[nodiscard]] std::string text(const SignCase& c);

struct SignSet {
  std::string name;
  std::vector<SignCase> narrow, wide;
  std::vector<SignCase> floats;  ///< coordinates are floats, for the build that takes nothing else
};

/// What a build got wrong.
struct WrongSigns {
  std::uint64_t signs = 0;   ///< cases with a wrong sign in one of the stages
  std::uint64_t stages = 0;  ///< all signs right, but not by the stage that the bounds ask for
  std::uint64_t fields = 0;  ///< bits of all words that were wrong
  std::size_t first = 0;     ///< the first wrong case
};
[[nodiscard]] WrongSigns compare(const std::vector<SignCase>& cases, const std::vector<std::uint32_t>& words);

/// How many cases the stages decide, by the words.
struct StageCounts {
  std::uint64_t filtered_orientations = 0, exact_orientations = 0, filtered_incircles = 0, exact_incircles = 0,
                ties = 0;
};
[[nodiscard]] StageCounts stages_of(const std::vector<std::uint32_t>& words);

/// Adds the points to the set, for both builds if the narrow one takes them. Points that are equal make no case.
void add_case(SignSet& set, Four points);
/// Adds the points to the set for the build for floats alone. \pre coordinates are floats, or too large for any: then
/// they make no case
void add_float_case(SignSet& set, Four points);

using Random = std::mt19937_64;

/// Names of the sets that need no files, and of those that do: the file in the folder `hard` of the test data.
[[nodiscard]] std::vector<std::string> generated_sets();
[[nodiscard]] std::vector<std::string> file_sets();
[[nodiscard]] SignSet generated_set(const std::string& name);
[[nodiscard]] std::vector<Four> generated_points(const std::string& name);
/// \pre the file is there
[[nodiscard]] SignSet file_set(const std::filesystem::path& folder, const std::string& name);

/// Sets for the build for floats: the generated ones rounded to floats, some of them off by units of a float, and those
/// of what floats alone have (float_sets.cpp).
[[nodiscard]] std::vector<std::string> float_sets();
[[nodiscard]] SignSet float_set(const std::string& name);

}  // namespace cadt::test
