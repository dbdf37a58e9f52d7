// SPDX-License-Identifier: Apache-2.0
// The point sets of the experiments: one in memory at a time, made once and shared by all that are measured on it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace cadt::bench {

/// A generated set (name of cadt::io::distributions()), or one of the data folder.
struct SetId {
  std::string name;
  std::size_t points = 0;  ///< asked for; `circles` rounds it
  bool real = false;
  friend bool operator==(const SetId&, const SetId&) = default;
};

/// Why a measurement is skipped; the row contains the reason.
class Skip : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class PointStore {
 public:
  /// `data`: the folder that has `real/`, or a name that is none.
  explicit PointStore(std::filesystem::path data);
  ~PointStore();
  PointStore(const PointStore&) = delete;
  PointStore& operator=(const PointStore&) = delete;

  /// The set; any earlier one is gone. \throws Skip
  [[nodiscard]] std::span<const double> get(const SetId& id);
  /// The same as a file of raw doubles in $TMPDIR, for other processes. Gone with the next set. \throws Skip
  [[nodiscard]] std::filesystem::path file(const SetId& id);

  /// The sets of the data folder's index with so many points, smallest first; none if there is no data.
  [[nodiscard]] std::vector<SetId> real_sets(std::size_t least, std::size_t most) const;
  /// Why there are no real sets, else empty.
  [[nodiscard]] std::string no_data() const;

 private:
  void remove_file() noexcept;

  std::filesystem::path data_, file_;
  std::optional<SetId> id_;
  std::vector<double> xy_;
};

}  // namespace cadt::bench
