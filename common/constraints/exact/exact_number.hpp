// SPDX-License-Identifier: Apache-2.0
// Exact numbers of any size: whole numbers times powers of 2^64. Sums and products of finite doubles are such numbers,
// so signs of polynomials of coordinates need neither a common scale nor a bound on their bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace cadt::exact {

/// Memory of the numbers of one predicate: it is given back all at once. 16 KiB lie in the object itself. One thread.
class Arena {
 public:
  Arena() {}  // NOLINT: leaves the memory alone on purpose
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  [[nodiscard]] std::uint64_t* take(std::size_t limbs) {
    if (limbs > left_) refill(limbs);
    std::uint64_t* const taken = at_;
    at_ += limbs;
    left_ -= limbs;
    return taken;
  }

 private:
  void refill(std::size_t limbs);

  std::array<std::uint64_t, 2048> first_;
  std::uint64_t* at_ = first_.data();
  std::size_t left_ = 2048;
  std::vector<std::unique_ptr<std::uint64_t[]>> more_;
};

/// (-1)^negative times the sum of limb[i] 2^(64 (low + i)). The first and the last limb are not 0; zero has none. The
/// limbs are those of an arena, and never change.
struct Number {
  const std::uint64_t* limb = nullptr;
  std::int32_t size = 0;
  std::int32_t low = 0;
  bool negative = false;

  [[nodiscard]] int sign() const { return size == 0 ? 0 : (negative ? -1 : 1); }
  [[nodiscard]] Number operator-() const { return {limb, size, low, size != 0 && !negative}; }
};

/// The arithmetic, with the arena that results lie in. A function of the arguments' sizes: no rounding, no limit.
class Arithmetic {
 public:
  explicit Arithmetic(Arena& arena) : arena_(arena) {}

  /// \pre value is finite
  [[nodiscard]] Number number(double value) const;
  [[nodiscard]] Number add(const Number& a, const Number& b) const;
  [[nodiscard]] Number subtract(const Number& a, const Number& b) const { return add(a, negated(b)); }
  [[nodiscard]] Number multiply(const Number& a, const Number& b) const;
  /// a b - c d
  [[nodiscard]] Number minor(const Number& a, const Number& b, const Number& c, const Number& d) const {
    return subtract(multiply(a, b), multiply(c, d));
  }

  [[nodiscard]] static Number negated(const Number& a) { return {a.limb, a.size, a.low, a.size != 0 && !a.negative}; }

 private:
  Arena& arena_;
};

/// The sign of a - b, without forming it.
[[nodiscard]] int compare(const Number& a, const Number& b);

/// A quotient to the nearest double, ties to even.
struct Rounded {
  double value = 0;
  int rest = 0;  ///< sign of the quotient minus `value`: 0 if that is exact
};
/// \pre divisor is not 0 and the quotient is below 2^1023 in modulus
[[nodiscard]] Rounded round_quotient(const Number& dividend, const Number& divisor, Arena& arena);

/// The greatest whole number that is not above the quotient. \pre divisor is not 0, the quotient is below 2^62 in
/// modulus
[[nodiscard]] std::int64_t floor_quotient(const Number& dividend, const Number& divisor, Arena& arena);

}  // namespace cadt::exact
