// SPDX-License-Identifier: Apache-2.0
// What the checks of a mesh in nodes are made of.
#pragma once

#include "tiles/parallel.hpp"

#include <cadt/verify.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace cadt::tiles::verification {

using Place = std::array<double, 2>;

/// Failures of a check; the lowest is kept, so that it is the same for every number of threads.
struct Findings {
  std::uint64_t failures = 0;
  std::int64_t first = -1;
  void fail(std::uint64_t where) {
    ++failures;
    const auto w = static_cast<std::int64_t>(where);
    if (first < 0 || w < first) first = w;
  }
  void merge(const Findings& other) {
    if (other.first >= 0 && (first < 0 || other.first < first)) first = other.first;
    failures += other.failures;
  }
};

struct PointFindings {
  Findings findings;
  std::string what;
  void fail(std::uint64_t point, const std::string& why) {
    findings.fail(point);
    if (findings.first == static_cast<std::int64_t>(point) || what.empty())
      what = "point " + std::to_string(point) + " " + why;
  }
  [[nodiscard]] Check conclude(const char* name) const {
    return {name, findings.failures == 0, findings.failures, findings.first, what};
  }
};

/// A bit for each point; set() by several threads at once.
class Bits {
 public:
  explicit Bits(std::uint64_t size) : size_(size), words_((size + 63) / 64) {}
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  void set(std::uint64_t i) noexcept {
    __atomic_fetch_or(&words_[i / 64], std::uint64_t{1} << i % 64, __ATOMIC_RELAXED);
  }
  [[nodiscard]] bool get(std::uint64_t i) const noexcept { return (words_[i / 64] >> i % 64 & 1U) != 0; }

 private:
  std::uint64_t size_;
  std::vector<std::uint64_t> words_;
};

/// Calls body(i, result) for each i below `count`, on threads where there is enough to do, and adds the results up.
/// \throws what a body throws
template <class Result, class Body>
Result reduce(std::size_t count, unsigned threads, const Body& body) {
  constexpr std::size_t block = std::size_t{1} << 14;
  const std::size_t blocks = (count + block - 1) / block;
  std::vector<Result> results(threads_for(blocks, threads));
  std::atomic<std::size_t> next{0};
  std::vector<std::function<void()>> tasks;
  for (Result& mine : results)
    tasks.emplace_back([&body, &mine, &next, blocks, count] {
      for (std::size_t b; (b = next.fetch_add(1)) < blocks;)
        for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) body(i, mine);
    });
  run_tasks(tasks, static_cast<unsigned>(tasks.size()));
  for (std::size_t i = 1; i < results.size(); ++i) results[0].merge(std::move(results[i]));
  return std::move(results[0]);
}

/// An edge with nothing on its right.
struct BoundaryEdge {
  std::uint64_t from = 0, to = 0;  ///< input indices
  Place at{};                      ///< of `from`
  std::uint64_t triangle = 0;
};
/// What is wrong with the boundary, and with the hull that it should be; empty if nothing is.
struct HullOutcome {
  std::string boundary, hull;
};
/// One loop that turns left around once, exactly.
[[nodiscard]] HullOutcome check_hull(std::vector<BoundaryEdge> edges);

}  // namespace cadt::tiles::verification
