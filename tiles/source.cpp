// SPDX-License-Identifier: Apache-2.0
#include "tiles/source.hpp"
#include "tiles/cells.hpp"

#include "io/support/byte_reader.hpp"
#include "io/support/input_file.hpp"
#include "io/support/random_access_file.hpp"
#include "tiles/hash.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace cadt::tiles {
namespace {

namespace detail = io::detail;

class MemorySource : public PointSource {
 public:
  MemorySource(std::vector<double> xy, std::string name) : xy_(std::move(xy)), name_(std::move(name)) {}
  [[nodiscard]] std::uint64_t size() const noexcept override { return xy_.size() / 2; }
  [[nodiscard]] std::string name_of(std::uint64_t /*index*/) const override { return name_; }
  [[nodiscard]] std::vector<std::string> names() const override { return {name_}; }
  [[nodiscard]] std::uint64_t memory() const noexcept override { return xy_.capacity() * sizeof(double); }

 protected:
  void read_raw(std::uint64_t first, std::size_t count, double* xy) const override {
    std::copy_n(xy_.data() + 2 * first, 2 * count, xy);
  }

 private:
  std::vector<double> xy_;
  std::string name_;
};

/// Rows of `columns` numbers at equal distances in a file, of which two are read.
class RangeFile : public PointSource {
 public:
  RangeFile(std::unique_ptr<detail::RandomAccessFile> file, const detail::NumberRows& rows, std::size_t x,
            std::size_t y)
      : file_(std::move(file)), rows_(rows), x_(x), y_(y) {}
  [[nodiscard]] std::uint64_t size() const noexcept override { return rows_.rows; }
  [[nodiscard]] std::string name_of(std::uint64_t /*index*/) const override { return file_->name(); }
  [[nodiscard]] std::vector<std::string> names() const override { return {file_->name()}; }

 protected:
  void read_raw(std::uint64_t first, std::size_t count, double* xy) const override {
    const std::size_t row = rows_.item_size * rows_.columns;
    const std::uint64_t at = rows_.offset + first * row;
    if (rows_.item_size == sizeof(double) && rows_.columns == 2 && x_ == 0 && y_ == 1) {
      file_->read(at, reinterpret_cast<char*>(xy), count * row);
      return;
    }
    std::vector<char> bytes(count * row);
    file_->read(at, bytes.data(), bytes.size());
    for (std::size_t i = 0; i < count; ++i) {
      xy[2 * i] = number(&bytes[i * row + x_ * rows_.item_size]);
      xy[2 * i + 1] = number(&bytes[i * row + y_ * rows_.item_size]);
    }
  }

 private:
  [[nodiscard]] double number(const char* at) const {
    return rows_.item_size == sizeof(float) ? static_cast<double>(detail::load<float>(at, false))
                                            : detail::load<double>(at, false);
  }
  std::unique_ptr<detail::RandomAccessFile> file_;
  detail::NumberRows rows_;
  std::size_t x_, y_;
};

class Generated : public PointSource {
 public:
  Generated(std::string name, const io::GenerateOptions& options) : name_(std::move(name)), options_(options) {}
  [[nodiscard]] std::uint64_t size() const noexcept override { return options_.n; }
  [[nodiscard]] std::string name_of(std::uint64_t /*index*/) const override { return "generated set " + name_; }
  [[nodiscard]] std::vector<std::string> names() const override { return {name_of(0)}; }

 protected:
  void read_raw(std::uint64_t first, std::size_t count, double* xy) const override {
    io::GenerateOptions part = options_;
    part.first = first;
    part.n = first + count;
    const io::PointSet points = io::generate(name_, part);
    std::copy_n(points.xy.data(), 2 * count, xy);
  }

 private:
  std::string name_;
  io::GenerateOptions options_;
};

class Concatenation : public PointSource {
 public:
  explicit Concatenation(std::vector<std::unique_ptr<PointSource>> parts) : parts_(std::move(parts)) {
    for (const auto& part : parts_) ends_.push_back((ends_.empty() ? 0 : ends_.back()) + part->size());
  }
  [[nodiscard]] std::uint64_t size() const noexcept override { return ends_.empty() ? 0 : ends_.back(); }
  [[nodiscard]] std::string name_of(std::uint64_t index) const override {
    const std::size_t part = part_of(index);
    return parts_[part]->name_of(index - begin(part));
  }
  [[nodiscard]] std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const auto& part : parts_)
      for (std::string& name : part->names()) all.push_back(std::move(name));
    return all;
  }
  [[nodiscard]] std::uint64_t memory() const noexcept override {
    std::uint64_t sum = 0;
    for (const auto& part : parts_) sum += part->memory();
    return sum;
  }
  [[nodiscard]] std::uint64_t index_in_part(std::uint64_t index) const override {
    const std::size_t part = part_of(index);
    return parts_[part]->index_in_part(index - begin(part));
  }

 protected:
  void read_raw(std::uint64_t first, std::size_t count, double* xy) const override {
    for (std::size_t part = part_of(first); count != 0; ++part) {
      const auto here = static_cast<std::size_t>(std::min<std::uint64_t>(count, ends_[part] - first));
      if (here != 0) read_part(*parts_[part], first - begin(part), here, xy);
      first += here, count -= here, xy += 2 * here;
    }
  }

 private:
  [[nodiscard]] std::size_t part_of(std::uint64_t index) const noexcept {
    return static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), index) - ends_.begin());
  }
  [[nodiscard]] std::uint64_t begin(std::size_t part) const noexcept { return part == 0 ? 0 : ends_[part - 1]; }
  std::vector<std::unique_ptr<PointSource>> parts_;
  std::vector<std::uint64_t> ends_;
};

}  // namespace

void PointSource::read(std::uint64_t first, std::size_t count, double* xy) const {
  if (count == 0) return;
  read_raw(first, count, xy);
  for (std::size_t i = 0; i < 2 * count; ++i) {
    if (!std::isfinite(xy[i])) {
      const std::uint64_t index = first + i / 2;
      throw InputError(name_of(index) + ": point " + std::to_string(index_in_part(index)) +
                           " (counted from 0), point " + std::to_string(index) + " of all: a coordinate is " +
                           (std::isnan(xy[i]) ? "NaN" : "infinite"),
                       index);
    }
    xy[i] += 0.0;  // -0 is 0
  }
}

void PointSource::read_part(const PointSource& part, std::uint64_t first, std::size_t count, double* xy) {
  part.read_raw(first, count, xy);
}

std::unique_ptr<PointSource> in_memory(std::vector<double> xy, std::string name) {
  if (xy.size() % 2 != 0) throw std::invalid_argument("interleaved coordinates need an even number of values");
  return std::make_unique<MemorySource>(std::move(xy), std::move(name));
}

std::unique_ptr<PointSource> open_file(const std::string& path, const io::ReadOptions& options) {
  const std::string format =
      detail::choose_format(path == "-" ? "<stdin>" : path, options.format, io::point_read_formats());
  // A pipe cannot be read by range; what is no file at all, the reader of whole files explains.
  std::error_code code;
  const bool by_range = std::filesystem::is_regular_file(path, code) && options.columns.empty() &&
                        (format == "npy" || format == "f64" || format == "f32");
  if (by_range) {
    auto file = std::make_unique<detail::RandomAccessFile>(path);
    const detail::NumberRows rows = format == "npy"
                                        ? detail::npy_rows(*file)
                                        : detail::raw_rows(*file, format == "f32" ? sizeof(float) : sizeof(double));
    const std::size_t x = options.projection == io::Projection::yz   ? 1
                          : options.projection == io::Projection::zx ? 2
                                                                     : 0;
    const std::size_t y = options.projection == io::Projection::yz   ? 2
                          : options.projection == io::Projection::zx ? 0
                                                                     : 1;
    // What is not rows of little-endian floats is left to the reader of whole files, with its errors.
    if (rows.in_rows && std::max(x, y) < rows.columns && rows.rows != 0)
      return std::make_unique<RangeFile>(std::move(file), rows, x, y);
  }
  io::PointSet points = io::read_points(path, options);
  return in_memory(std::move(points.xy), path == "-" ? "standard input" : path);
}

std::unique_ptr<PointSource> concatenate(std::vector<std::unique_ptr<PointSource>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<Concatenation>(std::move(parts));
}

std::unique_ptr<PointSource> open_files(std::span<const std::string> paths, const io::ReadOptions& options) {
  std::vector<std::unique_ptr<PointSource>> parts;
  for (const std::string& path : paths) parts.push_back(open_file(path, options));
  return concatenate(std::move(parts));
}

std::unique_ptr<PointSource> generated(const std::string& name, const io::GenerateOptions& options) {
  if (name == "cells") return uniform_cells(options.n, options.seed);
  for (const io::Distribution& about : io::distributions())
    if (about.name == name && about.by_range) return std::make_unique<Generated>(name, options);
  return in_memory(io::generate(name, options).xy, "generated set " + name);
}

}  // namespace cadt::tiles
