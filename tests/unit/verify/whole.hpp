// SPDX-License-Identifier: Apache-2.0
// Whole numbers of any length for machines without GMP: as much as truth.hpp needs, as plain as possible.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace truth {

/// Sign and digits to the base 2^32. Zero digits at the low end are counted in `low_` and not stored: coordinates have
/// a thousand bits of them.
class Whole {
 public:
  /// `value` is a whole number below 2^64.
  Whole(double value = 0) : negative_(value < 0) {
    const auto magnitude = static_cast<std::uint64_t>(std::fabs(value));
    digits_ = {static_cast<std::uint32_t>(magnitude), static_cast<std::uint32_t>(magnitude >> 32)};
    trim();
  }

  friend int sgn(const Whole& a) { return a.digits_.empty() ? 0 : a.negative_ ? -1 : 1; }

  Whole operator<<(unsigned long bits) const {
    Whole result = *this * Whole(std::ldexp(1.0, static_cast<int>(bits % 32)));
    if (!result.digits_.empty()) result.low_ += static_cast<long>(bits / 32);
    return result;
  }
  /// Only zeros may be shifted out.
  Whole operator>>(unsigned long bits) const {
    const unsigned long up = (32 - bits % 32) % 32;
    Whole result = *this << up;
    if (!result.digits_.empty()) result.low_ -= static_cast<long>((bits + up) / 32);
    return result;
  }

  Whole operator-() const {
    Whole result = *this;
    result.negative_ = !result.negative_;
    return result;
  }
  friend Whole operator+(const Whole& a, const Whole& b) {
    if (a.digits_.empty() || b.digits_.empty()) return a.digits_.empty() ? b : a;
    Whole result;
    result.low_ = std::min(a.low_, b.low_);
    const std::size_t size = static_cast<std::size_t>(std::max(a.top(), b.top()) - result.low_) + 1;
    std::vector<std::uint32_t> p = a.from(result.low_, size), q = b.from(result.low_, size);
    if (a.negative_ == b.negative_) {
      std::uint64_t carry = 0;
      for (std::size_t i = 0; i < size; ++i) {
        carry += std::uint64_t{p[i]} + q[i];
        p[i] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
      result.negative_ = a.negative_;
    } else {
      const bool smaller = std::lexicographical_compare(p.rbegin(), p.rend(), q.rbegin(), q.rend());
      if (smaller) std::swap(p, q);
      std::uint64_t transient = 0;
      for (std::size_t i = 0; i < size; ++i) {
        const std::uint64_t difference = std::uint64_t{p[i]} - q[i] - transient;
        p[i] = static_cast<std::uint32_t>(difference);
        transient = difference >> 63;
      }
      result.negative_ = smaller ? b.negative_ : a.negative_;
    }
    result.digits_ = std::move(p);
    result.trim();
    return result;
  }
  friend Whole operator-(const Whole& a, const Whole& b) { return a + -b; }
  friend Whole operator*(const Whole& a, const Whole& b) {
    Whole result;
    result.low_ = a.low_ + b.low_;
    result.negative_ = a.negative_ != b.negative_;
    result.digits_.assign(a.digits_.size() + b.digits_.size(), 0);
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.digits_.size() || carry != 0; ++j) {
        const std::uint64_t digit = j < b.digits_.size() ? b.digits_[j] : 0;
        carry += std::uint64_t{a.digits_[i]} * digit + result.digits_[i + j];
        result.digits_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    result.trim();
    return result;
  }
  Whole& operator+=(const Whole& other) { return *this = *this + other; }
  Whole& operator-=(const Whole& other) { return *this = *this - other; }

 private:
  [[nodiscard]] long top() const { return low_ + static_cast<long>(digits_.size()); }
  /// `size` digits from place `low` on.
  [[nodiscard]] std::vector<std::uint32_t> from(long low, std::size_t size) const {
    std::vector<std::uint32_t> result(size, 0);
    std::copy(digits_.begin(), digits_.end(), result.begin() + (low_ - low));
    return result;
  }
  void trim() {
    while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
    const auto used = std::find_if(digits_.begin(), digits_.end(), [](std::uint32_t digit) { return digit != 0; });
    low_ = digits_.empty() ? 0 : low_ + static_cast<long>(used - digits_.begin());
    digits_.erase(digits_.begin(), used);
  }

  bool negative_ = false;
  long low_ = 0;
  std::vector<std::uint32_t> digits_;
};

}  // namespace truth
