// SPDX-License-Identifier: Apache-2.0
#include "terrain.hpp"

#include "failure.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#ifndef _WIN32
#include <unistd.h>
#endif

namespace cadt::cli {
namespace fs = std::filesystem;
namespace {

constexpr std::array terrain_commands{"contour", "tin"};
constexpr std::array terrain_suffixes{".las", ".laz", ".gpkg", ".geojson", ".fgb", ".parquet", ".tif", ".tiff"};
constexpr std::array terrain_options{"--align", "--breaklines", "--class", "--crs", "--dtype", "--fill"};

template <class List>
bool contains(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool is_for_terrain(std::string_view word) {
  if (contains(terrain_options, word.substr(0, word.find('=')))) return true;
  // --output=dem.tif and -odem.tif name a file, as a word of its own does.
  return contains(terrain_suffixes, lower(fs::path(word).extension().string()));
}

#ifndef _WIN32

/// The folders where it may be: beside this program, also where a link to it leads, then those of PATH.
std::vector<fs::path> places(const char* self) {
  std::vector<fs::path> folders;
  std::error_code code;
  if (std::strchr(self, '/') != nullptr) folders.push_back(fs::absolute(self, code).parent_path());
  const fs::path executable = fs::read_symlink("/proc/self/exe", code);  // only Linux has it
  if (!code) folders.push_back(executable.parent_path());
  if (const char* const path = std::getenv("PATH")) {
    const std::string_view list(path);
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(':', begin), list.size());
      if (end > begin) folders.emplace_back(list.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return folders;
}

#endif

}  // namespace

void add_terrain_commands(CLI::App& app) {
  app.add_subcommand("contour", "contour lines from LAS, LAZ or GIS points, as GIS lines (cadt-terrain)");
  app.add_subcommand("tin", "the triangulated terrain as .ply, .glb or GIS polygons (cadt-terrain)");
}

bool is_for_terrain(int count, char** words) {
  if (count < 2) return false;
  if (contains(terrain_commands, words[1])) return true;
  if (std::string_view(words[1]) != "raster") return false;
  for (int i = 2; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--segments") {
      ++i;  // its file is read here, also a .geojson
    } else if (!word.starts_with("--segments=") && is_for_terrain(word)) {
      return true;
    }
  }
  return false;
}

void become_terrain(int count, char** words) {
  std::string what = "is not installed";
#ifndef _WIN32
  std::vector<char*> passed(words, words + count);
  passed.push_back(nullptr);
  for (const fs::path& folder : places(words[0])) {
    std::string file = (folder / "cadt-terrain").string();
    if (access(file.c_str(), X_OK) != 0 || fs::is_directory(file)) continue;
    passed[0] = file.data();
    execv(file.c_str(), passed.data());
    what = fmt::format("cannot be started: {}: {}", file, std::strerror(errno));
    break;
  }
#else
  static_cast<void>(count);
  what = "is not started from here on Windows: run it yourself, with the same words";
#endif
  throw Failure(exit_device,
                fmt::format("cadt {}: LAS, LAZ, GIS files and GeoTIFF need the program cadt-terrain, which {}. "
                            "To install it: pip install \"cadt[terrain]\"",
                            words[1], what));
}

}  // namespace cadt::cli
