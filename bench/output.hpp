// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace cadt::bench {

/// Makes the folder too. The file has its name once it is complete, also if the process is interrupted.
/// \throws io::FileError
void write_file(const std::filesystem::path& path, std::string_view text);

/// Lines "x,y" below that header.
[[nodiscard]] std::string points_text(std::span<const double> xy);
/// Lines "a,b,c" below that header: indices of points, from 0.
[[nodiscard]] std::string triangles_text(std::span<const std::int32_t> triangles);

}  // namespace cadt::bench
