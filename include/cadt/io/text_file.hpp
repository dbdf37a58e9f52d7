// SPDX-License-Identifier: Apache-2.0
// Text to a file, such as a report.
#pragma once

#include <string>
#include <string_view>

namespace cadt::io {

/// Writes to a temporary file in the same folder and renames it, so the file is complete or as it was. A symbolic link
/// stays; pipes and devices are written directly, and "-" is standard output. \throws FileError
void write_text(const std::string& path, std::string_view text);

}  // namespace cadt::io
