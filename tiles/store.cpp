// SPDX-License-Identifier: Apache-2.0
#include "tiles/store.hpp"

#include <cadt/io/errors.hpp>

#include "io/support/system_file.hpp"
#include "tiles/parallel.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

namespace cadt::tiles {
namespace {

namespace fs = std::filesystem;

template <class Number>
ArrayView array_of(std::string_view type, std::size_t columns, std::span<const Number> numbers) {
  std::vector<std::size_t> shape{numbers.size() / columns};
  if (columns != 1) shape.push_back(columns);
  return {type, std::move(shape), numbers.data(), numbers.size_bytes()};
}

ArrayView array_of(const std::vector<std::uint64_t>& words) {
  return array_of("<u8", 1, std::span<const std::uint64_t>(words));
}

/// Writes files into a temporary folder that gets its name in the end.
class NewFolder {
 public:
  NewFolder(const std::string& parent, const std::string& name)
      : path_(parent + "/" + name), temporary_(path_ + ".tmp"), prefix_(name + "/") {
    remove_folder(temporary_);
    remove_folder(path_);
    make_folder(temporary_);
  }
  ~NewFolder() {
    std::error_code ignored;
    if (!done_) fs::remove_all(temporary_, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  FileRecord add(const std::string& name, const ArrayView& array) {
    names_.push_back(name);
    return write(name, array);
  }
  /// Several at the same time.
  std::vector<FileRecord> add(std::span<const std::pair<std::string, ArrayView>> arrays, unsigned threads) {
    std::vector<FileRecord> records(arrays.size());
    std::vector<std::function<void()>> tasks;
    for (std::size_t i = 0; i < arrays.size(); ++i) {
      names_.push_back(arrays[i].first);
      tasks.emplace_back([&, i] { records[i] = write(arrays[i].first, arrays[i].second); });
    }
    run_tasks(tasks, threads);
    return records;
  }
  void add(const std::string& name, std::string_view text) {
    names_.push_back(name);
    write_text(temporary_ + "/" + name, text);
  }
  void sync() const {
    for (const std::string& name : names_) sync_file(temporary_ + "/" + name);
    sync_folder(temporary_);
  }
  void finish() {
    rename_folder(temporary_, path_);
    done_ = true;
  }

 private:
  [[nodiscard]] FileRecord write(const std::string& name, const ArrayView& array) const {
    FileRecord record = write_array(temporary_ + "/" + name, array);
    record.name = prefix_ + name;
    return record;
  }
  std::string path_, temporary_, prefix_;
  std::vector<std::string> names_;
  bool done_ = false;
};

/// Whether a folder holds nothing, or no more than what a process that was killed at once leaves.
bool is_empty_folder(const std::string& path) {
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, code)) {
    const bool left = entry.path().filename() == "manifest.json.tmp" ||
                      (entry.path().filename() == "unfinished" && fs::is_empty(entry.path(), code));
    if (!left) return false;
  }
  return !code;
}

/// Names in the record of a node before the links are complete.
std::vector<std::string> files_for_resuming(std::uint32_t node) {
  std::vector<std::string> names = node_files(node);
  names.pop_back();  // links.npy
  for (const char* file : {"links", "open", "messages"})
    names.push_back("unfinished/" + node_name(node) + "/" + file + ".npy");
  return names;
}

bool is_for_resuming(const FileRecord& file) { return file.name.starts_with("unfinished/"); }

}  // namespace

Store::Store(std::string path, const Plan& plan, Start start) : path_(std::move(path)), plan_(plan) {
  while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
  if (start == Start::join) {
    join();
    return;
  }
  std::error_code code;
  if (start == Start::create || !fs::exists(path_ + "/manifest.json", code)) {
    check_new_directory(path_);
    make_folder(path_);
    lock();
    check_new_directory(path_);  // again: another run may have begun and ended
    begin();
    return;
  }
  lock();
  const Manifest found = read_manifest(path_);
  check_same_plan(found);
  if (!found.complete) {
    make_folder(path_ + "/unfinished");  // a copy may have left out an empty folder
    return;
  }
  const auto is_intact = [&](const FileRecord& file) { return difference(path_ + "/" + file.name, file).empty(); };
  complete_ = std::all_of(found.nodes.begin(), found.nodes.end(), [&](const NodeRecord& node) {
    return std::all_of(node.files.begin(), node.files.end(), is_intact);
  });
  if (complete_) {
    remove_folder(path_ + "/unfinished");
  } else {
    begin();  // what is for resuming is gone: all nodes are made again
  }
}

void check_new_directory(const std::string& path) {
  std::error_code code;  // what cannot be looked at cannot be made: make_folder() says why
  if (fs::exists(path + "/manifest.json", code))
    throw ResumeError(path + ": there is a mesh already; --resume continues it if it is not complete, or remove it");
  if (!fs::exists(path, code)) return;
  if (!fs::is_directory(path, code)) throw io::FileError(path, 0, "is there already, and is no folder");
  if (!is_empty_folder(path))
    throw ResumeError(path + ": the folder is there already and holds no mesh; give another name, or remove it");
}

void Store::lock() {
  if (!lock_.take(path_))
    throw ResumeError(path_ + ": another run writes to this folder; wait until it has ended, or give another name");
}

void Store::join() const {
  std::error_code code;
  if (!fs::exists(path_ + "/manifest.json", code)) {
    throw io::FileError(path_, 0,
                        "this process does not see what another one of the run has begun there; choose a folder on a "
                        "file system of all machines");
  }
  const Manifest found = read_manifest(path_);
  if (found.complete || found.plan != plan_) {
    throw ResumeError(path_ +
                      ": this process sees another mesh there than the one that its run has begun; name the folder "
                      "from the root on, on a file system of all machines");
  }
}

void Store::begin() {
  sync_folder(io::detail::system_file::folder_of(path_));
  make_folder(path_ + "/unfinished");
  Manifest manifest;
  manifest.plan = plan_;
  replace_text(path_ + "/manifest.json", to_json(manifest));
}

void Store::check_same_plan(const Manifest& found) const {
  const auto refuse = [&](const std::string& what, const std::string& there, const std::string& here) {
    throw ResumeError(path_ + ": cannot be resumed: it was begun with " + what + " " + there + ", and this run has " +
                      here + "; give what it was begun with, or write to another folder");
  };
  const Plan& plan = found.plan;
  if (plan.tile_points != plan_.tile_points)
    refuse("--tile-points", std::to_string(plan.tile_points), std::to_string(plan_.tile_points));
  if (plan.tree.number_of_points() != plan_.tree.number_of_points()) {
    refuse("points,", std::to_string(plan.tree.number_of_points()), std::to_string(plan_.tree.number_of_points()));
  }
  if (plan.first_id != plan_.first_id)
    refuse("a first index", std::to_string(plan.first_id), std::to_string(plan_.first_id));
  if (plan.content != plan_.content) refuse("other points, hash", plan.content.to_string(), plan_.content.to_string());
  if (plan.tree != plan_.tree)
    refuse("another tree of tiles, by another version of cadt,", "of the same points", "its own");
}

std::string Store::node_folder(std::uint32_t node) const { return path_ + "/" + node_name(node); }
std::string Store::unfinished_folder(std::uint32_t node) const { return path_ + "/unfinished/" + node_name(node); }

bool Store::is_valid(std::uint32_t node) const {
  try {
    const NodeRecord record = read_record(node);
    return has_files(record, files_for_resuming(node)) &&
           std::all_of(record.files.begin(), record.files.end(),
                       [&](const FileRecord& file) { return difference(path_ + "/" + file.name, file).empty(); });
  } catch (const io::FileError&) {
    return false;
  }
}

NodeRecord Store::read_record(std::uint32_t node) const {
  const std::string path = unfinished_folder(node) + "/node.json";
  return record_from_json(read_text(path), path);
}

Open Store::read_open(std::uint32_t node) const {
  const std::string path = unfinished_folder(node) + "/open.npy";
  try {
    return unpack_open(read_words(path));
  } catch (const io::FileError&) {
    throw;
  } catch (const Error& e) {
    throw io::FileError(path, 0, e.what());
  }
}

void Store::write(const NodeData& node, unsigned threads) const {
  NodeRecord record{.points = node.ids.size(),
                    .triangles = node.triangles.size() / 3,
                    .links = node.links.size(),
                    .duplicates = node.duplicates.size(),
                    .open = node.open.ids.size(),
                    .sums = node.sums,
                    .files = {}};
  const std::string name = node_name(node.node);
  std::vector<std::uint64_t> duplicates;
  duplicates.reserve(2 * node.duplicates.size());
  for (const DuplicateId& d : node.duplicates) duplicates.insert(duplicates.end(), {d.point, d.representative});

  NewFolder arrays(path_, name);
  const std::vector<std::pair<std::string, ArrayView>> all = {
      {"points.npy", array_of("<f8", 2, std::span<const double>(node.xy))},
      {"ids.npy", array_of("<u8", 1, std::span<const std::uint64_t>(node.ids))},
      {"triangles.npy", array_of("<i4", 3, std::span<const std::int32_t>(node.triangles))},
      {"neighbors.npy", array_of("<i4", 3, std::span<const std::int32_t>(node.neighbors))},
      {"duplicates.npy", array_of("<u8", 2, std::span<const std::uint64_t>(duplicates))}};
  constexpr std::size_t worth_a_thread = std::size_t{1} << 20;
  const bool large = node.triangles.size() * sizeof node.triangles[0] >= worth_a_thread;
  record.files = arrays.add(all, large ? threads : 1);
  NewFolder unfinished(path_ + "/unfinished", name);
  for (const auto& [file, words] : {std::pair("links.npy", node.links), std::pair("open.npy", pack(node.open)),
                                    std::pair("messages.npy", pack(node.messages))}) {
    record.files.push_back(unfinished.add(file, array_of(words)));
    record.files.back().name.insert(0, "unfinished/");
  }
  unfinished.add("node.json", to_json(record));
  arrays.sync();
  unfinished.sync();
  arrays.finish();
  unfinished.finish();
}

void Store::write_links(std::vector<NodeRecord>& records) const {
  std::vector<Link> messages;
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    const std::vector<Link> of_node = unpack_messages(read_words(unfinished_folder(i) + "/messages.npy"));
    messages.insert(messages.end(), of_node.begin(), of_node.end());
  }
  complete_links(std::move(messages), plan_.tree.size(), [&](std::uint32_t i, std::span<const Link> of_node) {
    std::vector<std::uint64_t> links = read_words(unfinished_folder(i) + "/links.npy");
    apply_messages(i, of_node, links);
    const std::string temporary = node_folder(i) + "/links.npy.tmp";
    io::detail::system_file::remove(temporary);  // of a process that was killed
    FileRecord record = write_array(temporary, array_of(links));
    record.name = node_name(i) + "/links.npy";
    std::erase_if(records[i].files, is_for_resuming);
    records[i].files.push_back(std::move(record));
  });
  for (std::uint32_t i = 0; i < records.size(); ++i) sync_file(node_folder(i) + "/links.npy.tmp");
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    rename_file(node_folder(i) + "/links.npy.tmp", node_folder(i) + "/links.npy");
    sync_folder(node_folder(i));
  }
}

void complete_links(std::vector<Link> messages, std::uint32_t nodes,
                    const std::function<void(std::uint32_t, std::span<const Link>)>& complete) {
  std::sort(messages.begin(), messages.end(), [](const Link& a, const Link& b) {
    return std::tuple(node_of(a.triangle), a.row) < std::tuple(node_of(b.triangle), b.row);
  });
  auto next = messages.begin();
  for (std::uint32_t i = 0; i < nodes; ++i) {
    const auto end = std::find_if(next, messages.end(), [&](const Link& m) { return node_of(m.triangle) != i; });
    complete(i, {next, end});
    next = end;
  }
  if (next != messages.end()) throw InternalError("a message is for a node that is not there");
}

Manifest Store::finish() {
  if (complete_) return read_manifest(path_);
  Manifest manifest;
  manifest.plan = plan_;
  manifest.complete = true;
  std::uint64_t base = 0;
  for (std::uint32_t i = 0; i < plan_.tree.size(); ++i) {
    manifest.nodes.push_back(read_record(i));
    manifest.base.push_back(base);
    base += manifest.nodes.back().triangles;
    manifest.whole += manifest.nodes.back().sums;
  }
  require_complete(manifest.whole, plan_.tree);
  manifest.hash = hash_of(manifest.whole);
  write_links(manifest.nodes);
  replace_text(path_ + "/manifest.json", to_json(manifest));
  remove_folder(path_ + "/unfinished");
  complete_ = true;
  return manifest;
}

std::uint64_t directory_bytes(std::uint64_t points) noexcept {
  // Points and ids, two triangles with neighbours; joins, links and what is for resuming are a hundredth of it, but for
  // small sets, where headers count.
  constexpr std::uint64_t per_point = 24 + 2 * 24, at_least = std::uint64_t{1} << 20;
  return points * per_point + points * per_point / 50 + at_least;
}

void apply_messages(std::uint32_t node, std::span<const Link> messages, std::span<TriangleId> links) {
  for (const Link& m : messages) {
    if (m.row >= links.size() || links[m.row] != pending_triangle)
      throw InternalError("row " + std::to_string(m.row) + " of the links of node " + std::to_string(node) +
                          (m.row >= links.size() ? " does not exist" : " is told twice"));
    links[m.row] = m.across;
  }
  const auto open = std::find(links.begin(), links.end(), pending_triangle);
  if (open != links.end()) {
    throw InternalError("row " + std::to_string(open - links.begin()) + " of the links of node " +
                        std::to_string(node) + " was never told");
  }
}

}  // namespace cadt::tiles
