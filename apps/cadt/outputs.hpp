// SPDX-License-Identifier: Apache-2.0
// Output files. Everything that can be known to be wrong about an output is found before the work starts.
#pragma once

#include "interrupt.hpp"
#include "progress.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace cadt::cli {

struct Output {
  std::string path;    ///< "-" is standard output
  std::string format;  ///< one of the formats of the writer
};

/// Pairs the paths of -o with the formats of -t: none (from the suffixes), one for all, or one each ("auto": from the
/// suffix). Throws Failure (usage) for an unknown suffix or format, a missing -t for "-", one name given twice, or as
/// require_no_input(); io::FileError for a folder that does not exist or is not writable.
[[nodiscard]] std::vector<Output> plan_outputs(const std::vector<std::string>& paths,
                                               const std::vector<std::string>& formats,
                                               const std::vector<std::string>& known,
                                               const std::vector<std::string>& inputs);

/// Throws Failure (usage) if `path` is one of the files that are read, or the .node file beside one of them that has
/// its points. Names that are empty or "-" are no files.
void require_no_input(const std::string& path, const std::vector<std::string>& inputs);

/// Throws Failure (usage) if `path` lies within `folder`, which is `what`, whatever links lead there. "-" and devices
/// do not.
void require_outside(const std::string& path, const std::string& folder, std::string_view what = "the input");

/// Whether both names are those of one file; "-" and devices are none.
[[nodiscard]] bool same_output(const std::string& a, const std::string& b);

/// Throws io::FileError if `path` cannot become a file: its folder does not exist or is not writable, or it is a folder
/// itself.
void require_writable(const std::string& path);

/// The phase while `path` is written: a file gets its name before the process ends, a pipe may block for ever.
[[nodiscard]] Phase writing_phase(const std::string& path);

/// check_interrupt() after a file was written: the message names those that are complete.
void check_interrupt_after(const std::vector<std::string>& complete, ProgressLine* line = nullptr);

/// Text to a file that appears only when complete; "-" is standard output. Throws io::FileError.
void write_text(const std::string& path, const std::string& text);

}  // namespace cadt::cli
