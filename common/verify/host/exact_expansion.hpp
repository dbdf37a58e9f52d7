// SPDX-License-Identifier: Apache-2.0
// Exact sums of doubles as expansions: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates", Discrete & Computational Geometry 18 (1997).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace cadt::verifier {

/// a * b - p for p, the rounded product: exact, if it is no smaller than doubles are.
inline double product_error(double a, double b, double p) noexcept {
#if defined(__MINGW32__)  // whose std::fma() rounds twice: one product in fifty comes out wrong
  return static_cast<double>(static_cast<__float128>(a) * b - p);
#else
  return std::fma(a, b, -p);
#endif
}

/// A sum kept as non-overlapping doubles of increasing magnitude. Exact as long as nothing overflows and every product
/// is a multiple of the smallest subnormal; the caller shows that. `Capacity` bounds the number of terms ever added:
/// adding one term makes the expansion at most one component longer.
template <std::size_t Capacity>
class Expansion {
 public:
  void add(double term) {
    // Shewchuk's Grow-Expansion; zero components are dropped at once.
    double carry = term;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double e = component_[i];
      const double s = carry + e;
      const double e_part = s - carry;  // Knuth's two-sum
      const double error = (carry - (s - e_part)) + (e - e_part);
      carry = s;
      if (error != 0) component_[kept++] = error;
    }
    if (carry != 0) component_[kept++] = carry;
    size_ = kept;
  }

  void add_product(double a, double b) {
    const double p = a * b;
    add(product_error(a, b, p));
    add(p);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] double operator[](std::size_t i) const { return component_[i]; }
  /// The components do not overlap, so the last one outweighs all others.
  [[nodiscard]] int sign() const {
    if (size_ == 0) return 0;
    return component_[size_ - 1] > 0 ? 1 : -1;
  }

 private:
  std::array<double, Capacity> component_{};
  std::size_t size_ = 0;
};

}  // namespace cadt::verifier
