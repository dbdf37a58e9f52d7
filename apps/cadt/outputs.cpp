// SPDX-License-Identifier: Apache-2.0
#include "outputs.hpp"

#include "failure.hpp"
#include "system.hpp"
#include "text.hpp"

#include <cadt/io/errors.hpp>
#include <cadt/io/segments_file.hpp>
#include <cadt/io/text_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace cadt::cli {
namespace fs = std::filesystem;
namespace {

std::string format_of(const std::string& path, const std::string& asked, const std::vector<std::string>& known) {
  const auto is_known = [&](const std::string& word) {
    return std::find(known.begin(), known.end(), word) != known.end();
  };
  if (!asked.empty() && asked != "auto") {
    if (is_known(asked)) return asked;
    throw Failure(exit_usage, fmt::format("-t: unknown format '{}'; there are: {}", asked, join(known)));
  }
  if (path == "-") {
    throw Failure(exit_usage,
                  fmt::format("standard output has no suffix; name its format with -t, one of: {}", join(known)));
  }
  std::string suffix = lower(fs::path(path).extension().string());
  if (!suffix.empty()) suffix.erase(0, 1);
  if (is_known(suffix)) return suffix;
  throw Failure(exit_usage,
                fmt::format("{}: {}; name the format with -t, or end the file's name in one of: {}", path,
                            suffix.empty() ? "no suffix" : "unknown suffix '." + suffix + "'", join(known)));
}

// One file under two names (./a and a, a link) is still one file.
bool same_file(const std::string& a, const std::string& b) {
  std::error_code code;
  if (fs::exists(a, code) && fs::exists(b, code)) return fs::equivalent(a, b, code);
  return fs::absolute(a, code).lexically_normal() == fs::absolute(b, code).lexically_normal();
}

bool is_device(const std::string& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

[[noreturn]] void refuse(const std::string& path, int why) {
  throw io::FileError(path, 0, std::string("cannot be written: ") + std::strerror(why));
}

}  // namespace

std::vector<Output> plan_outputs(const std::vector<std::string>& paths, const std::vector<std::string>& formats,
                                 const std::vector<std::string>& known, const std::vector<std::string>& inputs) {
  if (formats.size() > 1 && formats.size() != paths.size()) {
    throw Failure(exit_usage,
                  fmt::format("-t is given {} times for {} outputs; give it once for all of them, or once for "
                              "each (auto: from the suffix)",
                              formats.size(), paths.size()));
  }
  if (paths.empty() && !formats.empty()) {
    throw Failure(exit_usage, "-t without -o: name the output, for example -o - for standard output");
  }
  std::vector<Output> outputs;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string asked = formats.empty() ? std::string() : lower(formats[formats.size() == 1 ? 0 : i]);
    outputs.push_back({paths[i], format_of(paths[i], asked, known)});
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool twice =
        std::any_of(paths.begin(), paths.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const auto& other) { return paths[i] == other || same_output(paths[i], other); });
    if (twice)
      throw Failure(exit_usage, fmt::format("{} is named twice as output; give each -o its own name", paths[i]));
    if (paths[i] == "-") continue;
    require_no_input(paths[i], inputs);
    require_writable(paths[i]);
  }
  return outputs;
}

bool same_output(const std::string& a, const std::string& b) {
  return !a.empty() && !b.empty() && a != "-" && b != "-" && !is_device(a) && !is_device(b) && same_file(a, b);
}

void require_no_input(const std::string& path, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    if (same_output(path, input)) {
      throw Failure(exit_usage,
                    fmt::format("{}: this is the input, which would be lost; give the output another name", path));
    }
    if (path.ends_with(".node") && same_output(path, io::node_file_of(input))) {
      throw Failure(exit_usage, fmt::format("{}: this has the points of {}, which would be lost; give the output "
                                            "another name",
                                            path, input));
    }
  }
}

void require_outside(const std::string& path, const std::string& folder, std::string_view what) {
  if (path.empty() || path == "-" || is_device(path)) return;
  std::error_code code;
  const fs::path from_root = fs::absolute(path, code);  // so that all folders above are seen
  fs::path at = fs::weakly_canonical(from_root, code);
  if (code) at = from_root.lexically_normal();
  fs::path kept = fs::weakly_canonical(fs::absolute(folder, code), code);  // it may not be there yet
  if (!kept.has_filename()) kept = kept.parent_path();
  for (; !at.empty(); at = at.parent_path()) {
    if (at == kept || fs::equivalent(at, folder, code)) {
      throw Failure(exit_usage, fmt::format("{}: this is in {}, {}, which would be lost; name an output outside of it",
                                            path, folder, what));
    }
    if (at == at.parent_path()) return;
  }
}

void require_writable(const std::string& path) {
  if (path.empty()) throw Failure(exit_usage, "an output has an empty name");
  std::error_code code;
  if (fs::is_directory(path, code)) throw io::FileError(path, 0, "is a folder; name a file in it");
  if (is_device(path)) {  // /dev/null, a named pipe: written in place
    if (!may_write(path)) refuse(path, errno);
    return;
  }
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) {
    throw io::FileError(path, 0,
                        fmt::format("cannot be written: there is no folder '{}'; create it first", folder.string()));
  }
  if (!may_write(folder.string())) refuse(path, errno);
}

Phase writing_phase(const std::string& path) { return path == "-" || is_device(path) ? Phase::free : Phase::writing; }

void check_interrupt_after(const std::vector<std::string>& complete, ProgressLine* line) {
  try {
    check_interrupt();
  } catch (const Cancelled&) {
    if (line != nullptr) line->clear();
    say(fmt::format("cadt: complete before the interruption: {}\n", join(complete)));
    throw;
  }
}

void write_text(const std::string& path, const std::string& text) {
  if (path == "-") return print(text);
  const InPhase phase(writing_phase(path));
  io::write_text(path, text);
}

}  // namespace cadt::cli
