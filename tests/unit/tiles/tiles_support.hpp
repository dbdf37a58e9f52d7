// SPDX-License-Identifier: Apache-2.0
// Small meshes in tiles for the tests of their parts.
#pragma once

#include "tiles/mesh_directory.hpp"
#include "tiles/run.hpp"
#include "tiles/tree.hpp"

#include <cadt/io/generate.hpp>

#include <unistd.h>
#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::tiles {

inline std::vector<double> points_of(std::string_view name, std::size_t n) {
  io::GenerateOptions options;
  options.n = n;
  return io::generate(name, options).xy;
}

/// Each pass in so many parts.
inline TileTree tree_of(const std::vector<double>& xy, std::uint64_t tile_points, std::size_t parts = 1) {
  TreeBuilder builder(xy.size() / 2, tile_points);
  while (!builder.done()) {
    TreePass sum = builder.new_pass();
    for (std::size_t part = parts; part-- > 0;) {
      const std::size_t begin = xy.size() / 2 * part / parts, end = xy.size() / 2 * (part + 1) / parts;
      TreePass pass = builder.new_pass();
      builder.look_at(pass, begin, std::span(xy).subspan(2 * begin, 2 * (end - begin)));
      sum += pass;
    }
    builder.finish_pass(std::move(sum));
  }
  return builder.take();
}

struct Nodes {
  Plan plan;
  std::vector<NodeData> nodes;
};
/// Those of a run on the host.
inline Nodes nodes_of(const std::vector<double>& xy, std::uint64_t tile_points) {
  Nodes result;
  RunOptions options;
  options.tile_points = tile_points;
  options.devices.front().backend = Backend::host;
  options.collect = [&](NodeData&& node) { result.nodes.push_back(std::move(node)); };
  result.plan = run(*in_memory(xy), options).plan;
  return result;
}

class Folder {
 public:
  Folder() {
    static std::atomic<int> serial{0};
    path_ = std::filesystem::temp_directory_path() /
            ("cadt-parts-" + std::to_string(::getpid()) + "-" + std::to_string(serial.fetch_add(1)));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

}  // namespace cadt::tiles
