// SPDX-License-Identifier: Apache-2.0
// A view of the caller's coordinates; no copy.
#pragma once

#include <cadt/errors.hpp>
#include <cadt/export.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <ranges>
#include <span>

namespace cadt {

/// Points of the plane in the caller's memory: double or float, interleaved (x0 y0 x1 y1 ...) or x and y in separate
/// arrays. The coordinates must outlive the view. Floats convert to double exactly. Concurrent reads are safe.
class CADT_API PointsView {
 public:
  PointsView() = default;

  /// n x 2 interleaved coordinates. \throws InputError for an odd number of values
  PointsView(std::span<const double> xy) : PointsView(xy.data(), xy.size()) {}  // NOLINT: implicit on purpose
  PointsView(std::span<const float> xy) : PointsView(xy.data(), xy.size()) {}   // NOLINT

  /// The same from any contiguous range of doubles or floats, such as a std::vector.
  template <class Range>
  requires(std::ranges::contiguous_range<const Range&>&& std::ranges::sized_range<const Range&> &&
           (std::same_as<std::ranges::range_value_t<Range>, double> ||
            std::same_as<std::ranges::range_value_t<Range>, float>)) PointsView(const Range& xy)
      : PointsView(std::ranges::data(xy), std::ranges::size(xy)) {}  // NOLINT

  /// Separate arrays of n values each. \throws InputError if their sizes differ, with the smaller size as index
  PointsView(std::span<const double> x, std::span<const double> y)
      : PointsView(x.data(), y.data(), x.size(), y.size()) {}
  PointsView(std::span<const float> x, std::span<const float> y) : PointsView(x.data(), y.data(), x.size(), y.size()) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] double x(std::size_t i) const noexcept {
    return x64_ ? x64_[i * stride_] : static_cast<double>(x32_[i * stride_]);
  }
  [[nodiscard]] double y(std::size_t i) const noexcept {
    return y64_ ? y64_[i * stride_] : static_cast<double>(y32_[i * stride_]);
  }

  /// The coordinates if they are interleaved doubles, else nullptr.
  [[nodiscard]] const double* interleaved_doubles() const noexcept { return stride_ == 2 ? x64_ : nullptr; }

  /// Whether x and y alternate in one array.
  [[nodiscard]] bool interleaved() const noexcept { return stride_ == 2; }
  /// Bytes a coordinate: 8 or 4.
  [[nodiscard]] std::size_t scalar_size() const noexcept { return x64_ != nullptr ? sizeof(double) : sizeof(float); }
  /// The first x and the first y in the caller's memory.
  [[nodiscard]] const void* x_data() const noexcept { return x64_ != nullptr ? static_cast<const void*>(x64_) : x32_; }
  [[nodiscard]] const void* y_data() const noexcept { return y64_ != nullptr ? static_cast<const void*>(y64_) : y32_; }

 private:
  template <class Real>
  PointsView(const Real* xy, std::size_t values) : size_(values / 2), stride_(2) {
    if (values % 2 != 0) throw InputError("interleaved coordinates need an even number of values", values / 2);
    set(xy, xy == nullptr ? nullptr : xy + 1);
  }
  template <class Real>
  PointsView(const Real* x, const Real* y, std::size_t nx, std::size_t ny) : size_(nx), stride_(1) {
    if (nx != ny) throw InputError("the x and y arrays differ in size", std::min(nx, ny));
    set(x, y);
  }
  void set(const double* x, const double* y) noexcept { x64_ = x, y64_ = y; }
  void set(const float* x, const float* y) noexcept { x32_ = x, y32_ = y; }

  const double* x64_ = nullptr;
  const double* y64_ = nullptr;
  const float* x32_ = nullptr;
  const float* y32_ = nullptr;
  std::size_t size_ = 0;
  std::size_t stride_ = 2;
};

}  // namespace cadt
