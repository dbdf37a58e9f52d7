// SPDX-License-Identifier: Apache-2.0
#include "tests/support/data_files.hpp"

#include "tests/support/portable.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace cadt::test {
namespace {

namespace fs = std::filesystem;

fs::path folder() {
  const auto found = data_folder();
  if (!found) throw std::runtime_error("no data folder: set CADT_DATA_DIR");
  return *found;
}

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string quoted(const fs::path& path) {
  std::string text(1, '\'');
  text += path.string();
  return text += '\'';
}

// Output of a command, kept as a file of the build folder, apart for each data folder, until `source` changes. Tests of
// several processes may want it at a time: each writes under a name of its own and renames.
fs::path made_by(const std::string& command, const fs::path& source, const std::string& name) {
  std::string of_folder = folder().string();
  for (const char separator : {'/', '\\', ':'}) std::replace(of_folder.begin(), of_folder.end(), separator, '_');
  const fs::path result = fs::path(CADT_TEST_CACHE_DIR) / of_folder / name;
  std::error_code missing;
  const auto made = fs::last_write_time(result, missing);
  if (!missing && made >= fs::last_write_time(source)) return result;
  fs::create_directories(result.parent_path());
  const fs::path part = result.string() + "." + std::to_string(process_number());
  if (std::system((command + " > " + quoted(part)).c_str()) != 0) throw std::runtime_error("failed: " + command);
  fs::rename(part, result);
  return result;
}

Points parse_text(const std::string& text) {
  Points xy;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && std::strchr(" \t\r\n", *at)) ++at;
    if (at == end) break;
    char* next = nullptr;  // not std::from_chars(), which takes no double in libc++ before version 20
    errno = 0;
    const double value = std::strtod(at, &next);
    if (next == at || (errno == ERANGE && std::isinf(value)))  // "inf" is a number, and what is subnormal
      throw std::runtime_error("not a number: " + std::string(at, std::min(at + 20, end)));
    xy.push_back(value);
    at = next;
  }
  if (xy.size() % 2 != 0) throw std::runtime_error("odd number of coordinates");
  return xy;
}

Points parse_doubles(const std::string& bytes) {
  if (bytes.size() % 16 != 0) throw std::runtime_error("truncated binary points");
  Points xy(bytes.size() / sizeof(double));
  std::memcpy(xy.data(), bytes.data(), bytes.size());
  return xy;
}

std::vector<ExactCounts> read_counts(const fs::path& file) {
  std::vector<ExactCounts> result;
  std::istringstream lines(contents(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    ExactCounts counts;
    fields >> counts.name >> counts.points;
    if (!(fields >> counts.duplicates >> counts.hull >> counts.triangles)) counts.not_finite = true;
    result.push_back(counts);
  }
  return result;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

}  // namespace

std::optional<fs::path> data_folder() {
  const char* variable = std::getenv("CADT_DATA_DIR");
  const fs::path path = variable && *variable ? variable : CADT_DEFAULT_DATA_DIR;
  if (!fs::is_directory(path / "hard")) return std::nullopt;
  return fs::canonical(path);
}

std::vector<ExactCounts> expected_of_files() { return read_counts(folder() / "hard" / "EXPECTED.tsv"); }
std::vector<ExactCounts> expected_of_catalogue() { return read_counts(folder() / "hard" / "CATALOGUE_EXPECTED.tsv"); }

Points hard_file(const std::string& name) { return parse_text(contents(folder() / "hard" / name)); }

Points catalogue_set(const std::string& id, unsigned factor) {
  const fs::path script = folder() / "hard" / "gen_catalogue.py";
  if (factor == 1)
    return parse_text(contents(made_by("python3 " + quoted(script) + " " + id, script, "catalogue/" + id + ".xy")));
  const std::string times = std::to_string(factor);
  return parse_text(
      contents(made_by("python3 " + quoted(CADT_ENLARGE_CATALOGUE) + " " + quoted(script) + " " + id + " " + times,
                       script, "catalogue/" + id + "x" + times + ".xy")));
}

std::vector<RealSet> real_sets() {
  std::vector<RealSet> result;
  const fs::path base = folder();
  if (!fs::exists(base / "real" / "INDEX.md")) return result;
  std::istringstream lines(contents(base / "real" / "INDEX.md"));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trimmed(cell));
    // | name | split | core | n | distinct | ... | `real/FILE` (MB) | ...
    const std::size_t at = line.rfind("`real/"), orig = line.rfind("`real/orig/");
    const std::size_t start = at == orig && at != std::string::npos ? line.rfind("`real/", at - 1) : at;
    if (cells.size() < 6 || start == std::string::npos) continue;
    const fs::path file = base / line.substr(start + 1, line.find('`', start + 1) - start - 1);
    if (!fs::exists(file)) continue;
    result.push_back({cells[1], std::stoul(cells[4]), file});
  }
  std::sort(result.begin(), result.end(), [](const RealSet& a, const RealSet& b) { return a.points < b.points; });
  return result;
}

fs::path unpacked(const fs::path& file, const std::string& kind) {
  if (file.extension() != ".xz") return file;
  const std::string python =
      "python3 -c 'import lzma, shutil, sys; shutil.copyfileobj(lzma.open(sys.argv[1]), sys.stdout.buffer)' ";
  const std::string unpack =
      "{ if command -v xz > /dev/null; then xz -dkc " + quoted(file) + "; else " + python + quoted(file) + "; fi; }";
  return made_by(unpack, file, kind + "/" + file.stem().string());
}

Points read(const RealSet& set) {
  const fs::path file = unpacked(set.file, "real");
  const std::string bytes = contents(file);
  return file.extension() == ".f64" ? parse_doubles(bytes) : parse_text(bytes);
}

}  // namespace cadt::test
