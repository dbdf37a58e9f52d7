// SPDX-License-Identifier: Apache-2.0
// What all bindings share: points from arrays, arrays from results, calls that release the GIL and end on Ctrl-C.
#pragma once

#include "gil.hpp"

#include <cadt/cadt.hpp>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace cadt_python {

/// Points of the host, n x 2 doubles or floats with strides that are not negative (cadt/_points.py sees to that).
using Points = nb::ndarray<nb::ro, nb::ndim<2>, nb::device::cpu>;
using Coordinates = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Values = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

[[nodiscard]] cadt::PointsView view_of(const Points& points);

template <class T>
using NumpyArray = nb::ndarray<nb::numpy, T>;

/// A read-only array of memory that `owner` keeps; it keeps a copy of the owner, which costs O(1).
template <class T, class Owner>
[[nodiscard]] NumpyArray<const T> array_of(std::span<const T> values, std::size_t columns, const Owner& owner) {
  nb::capsule keep(new Owner(owner), [](void* p) noexcept { delete static_cast<Owner*>(p); });
  const std::array<std::size_t, 2> shape{columns == 0 ? values.size() : values.size() / columns, columns};
  return NumpyArray<const T>(values.data(), columns == 0 ? 1 : 2, shape.data(), keep);
}

/// An array of the numbers in a vector, which it takes over.
template <class T, class Item>
[[nodiscard]] NumpyArray<T> array_of_shape(std::initializer_list<std::size_t> shape, std::vector<Item>&& values) {
  auto* kept = new std::vector<Item>(std::move(values));
  nb::capsule keep(kept, [](void* p) noexcept { delete static_cast<std::vector<Item>*>(p); });
  return NumpyArray<T>(reinterpret_cast<T*>(kept->data()), shape, keep);
}

/// The same with so many columns; 0: of one dimension.
template <class T>
[[nodiscard]] NumpyArray<T> array_of(std::vector<T>&& values, std::size_t columns = 0) {
  const std::size_t size = values.size();
  if (columns == 0) return array_of_shape<T>({size}, std::move(values));
  return array_of_shape<T>({size / columns, columns}, std::move(values));
}

/// A call of the library. While it runs, Ctrl-C and what `progress(phase, fraction)` raises end it: the exception is
/// raised again here. It is made and destroyed with the GIL.
class Call {
 public:
  explicit Call(const nb::object& progress) : progress_(progress) {}
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// Runs `work()`, which looks at `options`, without the GIL.
  template <class Work>
  auto operator()(cadt::Options& options, Work&& work) {
    return without_gil([&] { return run(options, work); });
  }

  /// The same where the GIL is free already.
  template <class Work>
  auto run(cadt::Options& options, Work&& work) {
    const Reports reports(*this, options);
    try {
      auto result = work();
      if (raised_) throw std::move(*raised_);
      return result;
    } catch (const cadt::Cancelled&) {
      if (raised_) throw std::move(*raised_);
      throw;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// While this lives, calls with these options report.
  class Reports {
   public:
    Reports(Call& call, cadt::Options& options) : options_(options) {
      options_.stop = call.source_.get_token();
      options_.progress = [&call](const cadt::Progress& p) { call.report(p); };
    }
    ~Reports() {
      options_.stop = {};
      options_.progress = nullptr;
    }
    Reports(const Reports&) = delete;
    Reports& operator=(const Reports&) = delete;

   private:
    cadt::Options& options_;
  };

  void report(const cadt::Progress& p);

  const nb::object& progress_;
  cadt::stop_source source_;
  std::optional<nb::python_error> raised_;
  Clock::time_point next_ = Clock::now() + std::chrono::milliseconds(20);
};

/// How often this process has been forked, counted in the child (cadt/_devices.py tells). A child has none of the
/// parent's threads: what they had locked stays locked, and what they are needed for cannot even be destroyed.
[[nodiscard]] unsigned forks() noexcept;
void forked() noexcept;

/// The same options for the host.
[[nodiscard]] cadt::Options on_host(const cadt::Options& options);

[[nodiscard]] nb::dict to_dict(const cadt::Statistics& statistics);

/// What cadt/_results.py makes a VerifyReport of.
[[nodiscard]] nb::dict report_of(const cadt::VerifyReport& report);

void bind_errors();
void bind_options(nb::module_& m);
void bind_mesh(nb::module_& m);
void bind_constrained(nb::module_& m);
void bind_device(nb::module_& m);
void bind_queries(nb::module_& m);
void bind_scipy(nb::module_& m);
void bind_part_raster(nb::module_& m);
void bind_squares(nb::module_& m);

}  // namespace cadt_python
