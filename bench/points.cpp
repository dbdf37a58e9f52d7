// SPDX-License-Identifier: Apache-2.0
#include "bench/points.hpp"

#include "bench/interrupt.hpp"

#include <cadt/io/errors.hpp>
#include <cadt/io/generate.hpp>
#include <cadt/io/points_file.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <new>
#include <sstream>
#include <utility>

extern char** environ;

namespace cadt::bench {
namespace {

namespace fs = std::filesystem;

/// A temporary file, empty at first, that goes with the object or with an interrupt.
class Temporary {
 public:
  explicit Temporary(std::string_view suffix) {
    const char* folder = std::getenv("TMPDIR");
    std::string name = fmt::format("{}/cadt-bench-XXXXXX{}", folder && *folder ? folder : "/tmp", suffix);
    const Writing from_name_to_removal;  // an interrupt in between would leave the file
    const int descriptor = ::mkstemps(name.data(), static_cast<int>(suffix.size()));
    if (descriptor < 0) throw Skip("cannot make a temporary file in " + fs::path(name).parent_path().string());
    ::close(descriptor);
    path_ = name;
    remove_on_interrupt(name);
  }
  ~Temporary() { remove(); }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  [[nodiscard]] const fs::path& path() const noexcept { return path_; }
  /// From now on somebody else removes it.
  [[nodiscard]] fs::path release() noexcept { return std::exchange(path_, {}); }

 private:
  void remove() noexcept {
    if (path_.empty()) return;
    std::error_code ignored;
    fs::remove(path_, ignored);
    remove_on_interrupt({});
  }
  fs::path path_;
};

/// xz -dc FILE > TARGET, without a shell: names may hold anything.
void unpack(const fs::path& file, const fs::path& target) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, target.c_str(), O_WRONLY, 0600);
  std::string words[] = {"xz", "-dc", "--", file.string()};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, "xz", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw Skip("the program xz is needed for " + file.string());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Skip("xz cannot unpack " + file.string());
}

fs::path find_real(const fs::path& data, const std::string& name) {
  for (const char* suffix : {".f64.xz", ".xy", ".xy.xz", ".f64"}) {
    fs::path file = data / "real" / (name + suffix);
    if (fs::exists(file)) return file;
  }
  return {};
}

std::vector<double> read_real(const fs::path& file) {
  const bool packed = file.extension() == ".xz";
  io::ReadOptions options;
  options.format = (packed ? file.stem() : file).extension().string().substr(1);
  if (!packed) return io::read_points(file.string(), options).xy;
  const Temporary plain("." + options.format);
  unpack(file, plain.path());
  return io::read_points(plain.path().string(), options).xy;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

}  // namespace

PointStore::PointStore(fs::path data) : data_(std::move(data)) {}

PointStore::~PointStore() { remove_file(); }

void PointStore::remove_file() noexcept {
  if (file_.empty()) return;
  std::error_code ignored;
  fs::remove(file_, ignored);
  remove_on_interrupt({});
  file_.clear();
}

std::span<const double> PointStore::get(const SetId& id) {
  if (id_ == id) return xy_;
  remove_file();
  id_.reset();
  xy_ = {};
  try {
    if (id.real) {
      if (const std::string reason = no_data(); !reason.empty()) throw Skip(reason);
      const fs::path file = find_real(data_, id.name);
      if (file.empty()) throw Skip(fmt::format("{} has no set {}", (data_ / "real").string(), id.name));
      xy_ = read_real(file);
    } else {
      io::GenerateOptions options;
      options.n = id.points;
      xy_ = io::generate(id.name, options).xy;
    }
  } catch (const io::FileError& error) {
    throw Skip(error.what());
  } catch (const std::bad_alloc&) {
    throw Skip(fmt::format("out of memory: {} points do not fit", id.points));
  }
  id_ = id;
  return xy_;
}

fs::path PointStore::file(const SetId& id) {
  const std::span<const double> xy = get(id);
  if (!file_.empty()) return file_;
  Temporary file(".f64");
  std::error_code unknown;
  const fs::space_info space = fs::space(file.path(), unknown);
  // The peer's result may go there too: 12 bytes a triangle, hence the factor.
  if (!unknown && space.available / 2 < xy.size_bytes()) {
    throw Skip(
        fmt::format("{} has no room for a file of {} MiB", file.path().parent_path().string(), xy.size_bytes() >> 20));
  }
  std::ofstream out(file.path(), std::ios::binary);
  out.write(reinterpret_cast<const char*>(xy.data()), static_cast<std::streamsize>(xy.size_bytes()));
  if (!out.flush()) throw Skip("cannot write " + file.path().string());
  return file_ = file.release();
}

std::string PointStore::no_data() const {
  if (fs::exists(data_ / "real" / "INDEX.md")) return {};
  return fmt::format("no data folder: {} has no real/INDEX.md; name it with --data or CADT_DATA_DIR",
                     data_.empty() ? "." : data_.string());
}

std::vector<SetId> PointStore::real_sets(std::size_t least, std::size_t most) const {
  std::vector<SetId> sets;
  std::ifstream index(data_ / "real" / "INDEX.md");
  for (std::string line; std::getline(index, line);) {
    // | name | split | core | n | ...
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trimmed(cell));
    if (cells.size() < 5) continue;
    SetId id{cells[1], 0, true};
    const std::string& n = cells[4];
    const auto [end, error] = std::from_chars(n.data(), n.data() + n.size(), id.points);
    if (error != std::errc() || end != n.data() + n.size()) continue;
    if (id.points >= least && id.points <= most && !find_real(data_, id.name).empty()) sets.push_back(id);
  }
  std::ranges::stable_sort(sets, {}, &SetId::points);
  return sets;
}

}  // namespace cadt::bench
