// SPDX-License-Identifier: Apache-2.0
// Where the points of a large set come from: read by range, in the order of their indices.
#pragma once

#include "tiles/hash.hpp"

#include <cadt/io/generate.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/uniform_cells.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cadt::tiles {

/// Points 0, 1, ..., size() - 1 of a set.
class PointSource {
 public:
  PointSource() = default;
  PointSource(const PointSource&) = delete;
  PointSource& operator=(const PointSource&) = delete;
  virtual ~PointSource() = default;

  [[nodiscard]] virtual std::uint64_t size() const noexcept = 0;
  /// Points first, ..., first + count - 1 (counted from 0 in the source) as x0 y0 x1 y1 ...; -0 is read as 0.
  /// Thread-safe. \pre first + count <= size() \throws io::FileError; InputError for NaN or infinity, with the
  /// smallest such index of the range and the name of its file
  void read(std::uint64_t first, std::size_t count, double* xy) const;
  /// The file, or the generated set, that has the point, for messages.
  [[nodiscard]] virtual std::string name_of(std::uint64_t index) const = 0;
  /// Its index in that file.
  [[nodiscard]] virtual std::uint64_t index_in_part(std::uint64_t index) const { return index; }
  /// Names of all of it, for people.
  [[nodiscard]] virtual std::vector<std::string> names() const = 0;
  /// The set, if it is one that is made tile by tile; else null.
  [[nodiscard]] virtual const UniformCells* cells() const noexcept { return nullptr; }
  /// Bytes of memory that the source holds.
  [[nodiscard]] virtual std::uint64_t memory() const noexcept { return 0; }

 protected:
  virtual void read_raw(std::uint64_t first, std::size_t count, double* xy) const = 0;
  /// read_raw of another one.
  static void read_part(const PointSource& part, std::uint64_t first, std::size_t count, double* xy);
};

/// One file: .npy, .f64 and .f32 by range, which must not change meanwhile; the other formats in memory as a whole.
/// \throws io::FileError
[[nodiscard]] std::unique_ptr<PointSource> open_file(const std::string& path, const io::ReadOptions& options = {});
/// Several one after the other.
[[nodiscard]] std::unique_ptr<PointSource> concatenate(std::vector<std::unique_ptr<PointSource>> parts);
[[nodiscard]] std::unique_ptr<PointSource> open_files(std::span<const std::string> paths,
                                                      const io::ReadOptions& options = {});
/// A generated set: by range where its points are independent (io::Distribution::by_range), else in memory.
/// \throws std::invalid_argument for an unknown name
[[nodiscard]] std::unique_ptr<PointSource> generated(const std::string& name, const io::GenerateOptions& options);
/// Points in memory, x0 y0 x1 y1 ...
[[nodiscard]] std::unique_ptr<PointSource> in_memory(std::vector<double> xy, std::string name = "points");

}  // namespace cadt::tiles
