// SPDX-License-Identifier: Apache-2.0
#include "mesh_directory.hpp"

#include "failure.hpp"
#include "text.hpp"

#ifdef CADT_HAS_TILES
#include "tile_errors.hpp"
#include "tiles/machine.hpp"
#include "tiles/mesh_directory.hpp"
#endif

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace cadt::cli {

std::string check_line(const Check& check) {
  if (check.passed) return fmt::format("pass  {}\n", check.name);
  std::string text =
      fmt::format("FAIL  {:<12} {} {}", check.name, check.failures, check.failures == 1 ? "failure" : "failures");
  if (check.first >= 0) text += fmt::format(", first at {}", check.first);
  if (!check.what.empty()) text += fmt::format(": {}", check.what);
  return text + '\n';
}

#ifdef CADT_HAS_TILES

namespace {

std::string directory_text(const tiles::Manifest& manifest, const std::string& path) {
  const tiles::TileTree& tree = manifest.plan.tree;
  std::string text = key_line("format", "mesh in tiles");
  text += key_line("points", std::to_string(tree.number_of_points()));
  if (manifest.complete) {
    text += key_line("distinct", std::to_string(manifest.whole.distinct));
    text += key_line("duplicates", std::to_string(manifest.whole.points - manifest.whole.distinct));
    text += key_line("triangles", std::to_string(manifest.whole.triangles));
    text += key_line("hull", std::to_string(manifest.whole.hull_edges));
  }
  std::uint64_t largest = 0;
  for (const std::uint32_t leaf : tree.leaves()) largest = std::max(largest, tree.node(leaf).points);
  text += key_line("tiles", fmt::format("{} of at most {} points, the largest has {}; {} joins", tree.leaves().size(),
                                        manifest.plan.tile_points, largest, tree.size() - tree.leaves().size()));
  text += key_line("size", human_bytes(tiles::bytes_in_folder(path)));
  text += key_line("complete", manifest.complete ? "yes" : "no; continue it with: cadt tiles --resume");
  if (manifest.complete) text += key_line("hash", manifest.hash.to_string());
  return text;
}

}  // namespace

bool is_mesh_directory(const std::string& path) { return tiles::is_mesh_directory(path); }

int print_directory(const std::string& path, bool json) {
  with_tile_errors([&] {
    const tiles::Manifest manifest = tiles::read_manifest(path);
    print(json ? tiles::to_json(manifest) : directory_text(manifest, path));
  });
  return exit_done;
}

int verify_directory(const std::string& path, unsigned threads, bool quiet) {
  VerifyReport report;
  with_tile_errors([&] {
    const tiles::MeshDirectory mesh(path);
    VerifyOptions options;
    options.threads = threads;
    report = tiles::verify(mesh, options);
  });
  if (!quiet) {
    std::string text;
    for (const Check& check : report.checks) text += check_line(check);
    text += fmt::format("{} points, {} triangles, {} edges examined, {} on the hull, {} cocircular\n", report.points,
                        report.triangles_examined, report.edges_examined, report.hull_vertices, report.ties);
    print(text);
  }
  if (report.ok) return exit_done;
  const auto failed =
      std::find_if(report.checks.begin(), report.checks.end(), [](const Check& c) { return !c.passed; });
  throw Failure(exit_verify, fmt::format("{}: not the Delaunay triangulation of its points: {}: {}", path, failed->name,
                                         failed->what));
}

#else

bool is_mesh_directory(const std::string& /*path*/) { return false; }
int print_directory(const std::string& /*path*/, bool /*json*/) { return exit_internal; }
int verify_directory(const std::string& /*path*/, unsigned /*threads*/, bool /*quiet*/) { return exit_internal; }

#endif

}  // namespace cadt::cli
