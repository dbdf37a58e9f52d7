// SPDX-License-Identifier: Apache-2.0
#include "bench/output.hpp"

#include "bench/interrupt.hpp"
#include "io/support/atomic_file.hpp"

#include <cadt/io/errors.hpp>

#include <fmt/format.h>

#include <system_error>

namespace cadt::bench {

void write_file(const std::filesystem::path& path, std::string_view text) {
  std::error_code failed;
  std::filesystem::create_directories(path.parent_path(), failed);
  if (failed) throw io::FileError(path.parent_path().string(), 0, "cannot be made: " + failed.message());
  const Writing writing;
  io::detail::AtomicFile file(path.string());
  file.write(text);
  file.commit();
}

std::string points_text(std::span<const double> xy) {
  std::string text = "x,y\n";
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2)
    fmt::format_to(std::back_inserter(text), "{},{}\n", xy[i], xy[i + 1]);
  return text;
}

std::string triangles_text(std::span<const std::int32_t> triangles) {
  std::string text = "a,b,c\n";
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    fmt::format_to(std::back_inserter(text), "{},{},{}\n", triangles[t], triangles[t + 1], triangles[t + 2]);
  return text;
}

}  // namespace cadt::bench
