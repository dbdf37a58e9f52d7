// SPDX-License-Identifier: Apache-2.0
// Runs of the engine in tiles, against one call for the same points.
#pragma once

#include "tests/support/families.hpp"
#include "tiles/mesh_directory.hpp"
#include "tiles/run.hpp"

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cadt::test {

/// A folder that is removed in the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// Options of a run on one device, in memory.
[[nodiscard]] tiles::RunOptions in_tiles(std::uint64_t tile_points, const Options& device);

/// The nodes of a run in memory. `result` may be null.
[[nodiscard]] tiles::CollectedMesh run_in_memory(const tiles::PointSource& source, tiles::RunOptions options,
                                                 tiles::RunResult* result = nullptr);

/// Array by array, and the hash.
[[nodiscard]] testing::AssertionResult same_arrays(const tiles::MergedMesh& merged, const Points& xy,
                                                   const Triangulation& mesh);

/// A run in tiles of each size gives the arrays and the hash of one call, and passes tiles::verify.
[[nodiscard]] testing::AssertionResult same_in_tiles(const Points& xy, std::span<const std::uint64_t> sizes,
                                                     const Options& device);

}  // namespace cadt::test
