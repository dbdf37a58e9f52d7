// SPDX-License-Identifier: Apache-2.0
#include "tests/system/tiles/tile_runs.hpp"

#include <unistd.h>
#include <atomic>

namespace cadt::test {

TemporaryFolder::TemporaryFolder() {
  static std::atomic<int> serial{0};
  path_ = std::filesystem::temp_directory_path() /
          ("cadt-tiles-" + std::to_string(::getpid()) + "-" + std::to_string(serial.fetch_add(1)));
  std::filesystem::create_directories(path_);
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

tiles::RunOptions in_tiles(std::uint64_t tile_points, const Options& device) {
  tiles::RunOptions options;
  options.tile_points = tile_points;
  options.devices = {device};
  return options;
}

tiles::CollectedMesh run_in_memory(const tiles::PointSource& source, tiles::RunOptions options,
                                   tiles::RunResult* result) {
  std::vector<tiles::NodeData> nodes;
  options.collect = [&](tiles::NodeData&& node) { nodes.push_back(std::move(node)); };
  tiles::RunResult run = tiles::run(source, options);
  tiles::CollectedMesh mesh(run.plan.tree, std::move(nodes), options.first_id);
  if (result != nullptr) *result = std::move(run);
  return mesh;
}

testing::AssertionResult same_arrays(const tiles::MergedMesh& merged, const Points& xy, const Triangulation& mesh) {
  const auto same = [](const auto& a, const auto& b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); };
  if (!same(merged.xy, xy)) return testing::AssertionFailure() << "the points differ";
  if (!same(merged.triangles, mesh.triangles())) return testing::AssertionFailure() << "the triangles differ";
  if (!same(merged.neighbors, mesh.neighbors())) return testing::AssertionFailure() << "the neighbours differ";
  if (!same(merged.hull, mesh.hull())) return testing::AssertionFailure() << "the hulls differ";
  if (!same(merged.duplicates, mesh.duplicates())) return testing::AssertionFailure() << "the duplicates differ";
  return testing::AssertionSuccess();
}

testing::AssertionResult same_in_tiles(const Points& xy, std::span<const std::uint64_t> sizes, const Options& device) {
  const Triangulation mesh = triangulate(PointsView(std::span<const double>(xy)), device);
  const auto source = tiles::in_memory(xy);
  for (const std::uint64_t size : sizes) {
    tiles::RunResult result;
    const tiles::CollectedMesh nodes = run_in_memory(*source, in_tiles(size, device), &result);
    const testing::AssertionResult same = same_arrays(tiles::merge(nodes), xy, mesh);
    if (!same) return testing::AssertionFailure() << "tiles of " << size << ": " << same.message();
    if (result.hash != mesh.hash()) return testing::AssertionFailure() << "tiles of " << size << ": the hashes differ";
    if (result.whole.dimension != mesh.dimension())
      return testing::AssertionFailure() << "tiles of " << size << ": the dimensions differ";
    const VerifyReport report = tiles::verify(nodes);
    if (report.ok && report.edges_examined != (3 * mesh.number_of_triangles() - mesh.hull().size()) / 2)
      return testing::AssertionFailure() << "tiles of " << size << ": some edges were not examined";
    if (report.ok) continue;
    for (const Check& check : report.checks)
      if (!check.passed)
        return testing::AssertionFailure() << "tiles of " << size << ": " << check.name << ": " << check.what;
  }
  return testing::AssertionSuccess();
}

}  // namespace cadt::test
