// SPDX-License-Identifier: Apache-2.0
// A view of the caller's coordinates, in whatever arrays they are; no copy.
#pragma once

#include <cadt/errors.hpp>
#include <cadt/export.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace cadt {

namespace detail {

template <class T>
concept Real = std::same_as<T, double> || std::same_as<T, float>;

template <class Range>
concept ContiguousRange = std::ranges::contiguous_range<const Range&> && std::ranges::sized_range<const Range&>;

template <class T>
using Coordinate = std::remove_cv_t<std::remove_reference_t<T>>;

/// Whether two expressions are lvalues of the same type, double or float: members in memory, and no values of a getter.
template <class X, class Y>
concept SameReals = std::is_lvalue_reference_v<X> && std::same_as<X, Y> && Real<Coordinate<X>>;

template <class P>
concept HasXY = requires(const P& p) {
  requires SameReals<decltype((p.x)), decltype((p.y))>;
};
template <class P>
concept HasFirstSecond = requires(const P& p) {
  requires SameReals<decltype((p.first)), decltype((p.second))>;
};
/// std::array<double, 2> and longer ones, double[2] and longer ones: x is the first element, y the second.
template <class P>
concept HasElements = requires(const P& p) {
  requires SameReals<decltype((p[0])), decltype((p[1]))>;
  requires std::is_trivially_copyable_v<P> && sizeof(P) >= 2 * sizeof(p[0]);
};
template <class P>
concept PointInMemory = HasXY<P> || HasFirstSecond<P> || HasElements<P>;

}  // namespace detail

/// Points of the plane in the caller's memory: doubles or floats, in any arrays whose elements have the same distance.
/// Made implicitly from
///
///     std::vector<double>, std::span<const float>, double xy[2 * n]    x0 y0 x1 y1 ...
///     std::vector<P>, double xy[n][2], ...                             P: x and y, std::pair, an array of two or more
///     {xs, ys}                                                         separate arrays
///     {0.0, 0.0, 1.0, 0.0}, {{0.0, 0.0}, {1.0, 0.0}}                   lists, for the call that they are passed to
///
/// For points whose coordinates have other names see the constructor with members; for points that have only getters,
/// copy_points. The view is two pointers and a stride; the coordinates must outlive it. Floats convert to double
/// exactly. Concurrent reads are safe. A view that is neither interleaved() nor separate() (points with further
/// members, or with y before x) is packed once by each call that gives it to a device: one pass over the points, and a
/// copy of their coordinates on the host while the call runs (16 bytes a point, 8 with floats).
class CADT_API PointsView {
 public:
  PointsView() = default;

  /// n x 2 interleaved coordinates. \throws InputError for an odd number of values
  PointsView(std::span<const double> xy) : PointsView(xy.data(), xy.size()) {}  // NOLINT: implicit on purpose
  PointsView(std::span<const float> xy) : PointsView(xy.data(), xy.size()) {}   // NOLINT
  PointsView(std::initializer_list<double> xy) : PointsView(std::data(xy), xy.size()) {}

  /// The same from any contiguous range of doubles or floats, such as a std::vector.
  template <class Range>
  requires(detail::ContiguousRange<Range>&& detail::Real<std::ranges::range_value_t<Range>>)
      PointsView(const Range& xy)  // NOLINT
      : PointsView(std::ranges::data(xy), std::ranges::size(xy)) {}

  /// A contiguous range of points: with members x and y, with first and second, or with elements [0] and [1], which are
  /// two doubles or two floats. Further members are skipped.
  template <class Range>
  requires(detail::ContiguousRange<Range>&& detail::PointInMemory<std::ranges::range_value_t<Range>>)
      PointsView(const Range& points) {  // NOLINT
    set_points(std::ranges::data(points), std::ranges::size(points), []<class Element>(const Element& p) {
      if constexpr (detail::HasXY<Element>)
        return std::pair(&p.x, &p.y);
      else if constexpr (detail::HasFirstSecond<Element>)
        return std::pair(&p.first, &p.second);
      else
        return std::pair(&p[0], &p[1]);
    });
  }
  PointsView(std::initializer_list<std::array<double, 2>> points)
      : PointsView(std::span<const std::array<double, 2>>(std::data(points), points.size())) {}

  /// The same with members of other names: `PointsView(stations, &Station::lon, &Station::lat)`.
  template <class Range, class P, detail::Real R>
  requires(detail::ContiguousRange<Range>&& std::derived_from<std::ranges::range_value_t<Range>, P>)
      PointsView(const Range& points, R P::*x, R P::*y) {
    set_points(std::ranges::data(points), std::ranges::size(points),
               [=](const P& p) { return std::pair(&(p.*x), &(p.*y)); });
  }

  /// Separate arrays of n values each. \throws InputError if their sizes differ, with the smaller size as index
  PointsView(std::span<const double> x, std::span<const double> y)
      : PointsView(x.data(), y.data(), x.size(), y.size()) {}
  PointsView(std::span<const float> x, std::span<const float> y) : PointsView(x.data(), y.data(), x.size(), y.size()) {}

  /// n points whose x are at x, x + stride, ..., and whose y are at y, y + stride, ...; the stride is in bytes. The
  /// coordinates need no alignment.
  [[nodiscard]] static PointsView strided(const double* x, const double* y, std::size_t n,
                                          std::size_t stride) noexcept {
    PointsView view;
    view.set(x, y, n, stride);
    return view;
  }
  [[nodiscard]] static PointsView strided(const float* x, const float* y, std::size_t n, std::size_t stride) noexcept {
    PointsView view;
    view.set(x, y, n, stride);
    return view;
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] double x(std::size_t i) const noexcept { return value(x_, i); }
  [[nodiscard]] double y(std::size_t i) const noexcept { return value(y_, i); }

  /// `count` points from `first` on. \pre first + count <= size()
  [[nodiscard]] PointsView subview(std::size_t first, std::size_t count) const noexcept {
    PointsView part = *this;
    part.size_ = count;
    if (first != 0) part.x_ += first * stride_, part.y_ += first * stride_;
    return part;
  }

  /// Whether x and y alternate in one array, with nothing between them.
  [[nodiscard]] bool interleaved() const noexcept {
    return stride_ == 2 * scalar_size() && (x_ == nullptr || y_ == x_ + scalar_size());
  }
  /// Whether x and y are in arrays of their own, with nothing between them.
  [[nodiscard]] bool separate() const noexcept { return stride_ == scalar_size(); }
  /// The coordinates if they are interleaved doubles, else nullptr.
  [[nodiscard]] const double* interleaved_doubles() const noexcept {
    return interleaved() && scalar_size() == sizeof(double) ? reinterpret_cast<const double*>(x_) : nullptr;
  }

  /// Bytes a coordinate: 8 or 4.
  [[nodiscard]] std::size_t scalar_size() const noexcept { return doubles_ ? sizeof(double) : sizeof(float); }
  /// Bytes from one point to the next.
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  /// The first x and the first y in the caller's memory.
  [[nodiscard]] const void* x_data() const noexcept { return x_; }
  [[nodiscard]] const void* y_data() const noexcept { return y_; }

 private:
  template <detail::Real R>
  PointsView(const R* xy, std::size_t values) {
    if (values % 2 != 0) throw InputError("interleaved coordinates need an even number of values", values / 2);
    set(xy, xy == nullptr ? nullptr : xy + 1, values / 2, 2 * sizeof(R));
  }
  template <detail::Real R>
  PointsView(const R* x, const R* y, std::size_t nx, std::size_t ny) {
    if (nx != ny) throw InputError("the x and y arrays differ in size", std::min(nx, ny));
    set(x, y, nx, sizeof(R));
  }
  template <class P, class Members>
  void set_points(const P* points, std::size_t n, const Members& members) {
    using Pointer = typename decltype(members(*points))::first_type;
    if (n == 0) return set(Pointer(nullptr), Pointer(nullptr), 0, 2 * sizeof(*Pointer()));
    const auto [x, y] = members(points[0]);
    set(x, y, n, sizeof(P));
  }
  template <detail::Real R>
  void set(const R* x, const R* y, std::size_t n, std::size_t stride) noexcept {
    x_ = reinterpret_cast<const std::byte*>(x);
    y_ = reinterpret_cast<const std::byte*>(y);
    size_ = n;
    stride_ = stride;
    doubles_ = std::same_as<R, double> && x != nullptr;  // without memory both are empty; floats suit any device
    if (x == nullptr) stride_ = 2 * sizeof(float);
  }
  [[nodiscard]] double value(const std::byte* from, std::size_t i) const noexcept {
    return doubles_ ? load<double>(from + i * stride_) : static_cast<double>(load<float>(from + i * stride_));
  }
  template <detail::Real R>
  [[nodiscard]] static R load(const std::byte* from) noexcept {
    R number;
    std::memcpy(&number, from, sizeof number);
    return number;
  }

  const std::byte* x_ = nullptr;
  const std::byte* y_ = nullptr;
  std::size_t size_ = 0;
  std::size_t stride_ = 2 * sizeof(float);
  bool doubles_ = false;
};

/// A copy of points that have only getters, or are in no contiguous range: x0 y0 x1 y1 ..., of which a PointsView is
/// made. `x` and `y` are called with each element: functions, lambdas, or pointers to members. O(n).
///
///     const std::vector<double> xy = cadt::copy_points(list.begin(), list.end(), &Site::easting, &Site::northing);
template <std::input_iterator Iterator, std::sentinel_for<Iterator> Sentinel, class X, class Y>
requires(std::convertible_to<std::invoke_result_t<X&, std::iter_reference_t<Iterator>>, double>&&
             std::convertible_to<std::invoke_result_t<Y&, std::iter_reference_t<Iterator>>, double>)
    [[nodiscard]] std::vector<double> copy_points(Iterator first, Sentinel last, X x, Y y) {
  std::vector<double> xy;
  if constexpr (std::sized_sentinel_for<Sentinel, Iterator>) xy.reserve(2 * static_cast<std::size_t>(last - first));
  for (; first != last; ++first) {
    auto&& point = *first;
    xy.push_back(static_cast<double>(std::invoke(x, point)));
    xy.push_back(static_cast<double>(std::invoke(y, point)));
  }
  return xy;
}

}  // namespace cadt
