// SPDX-License-Identifier: Apache-2.0
// Times of whole calls, within limits.
#pragma once

#include <cadt/statistics.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cadt::bench {

/// Milliseconds since it was made.
class Stopwatch {
 public:
  Stopwatch();
  [[nodiscard]] double milliseconds() const;

 private:
  double start_;
};

struct Repeats {
  std::size_t warmups = 0;
  std::vector<double> milliseconds;  ///< of the timed runs
};

/// Milliseconds from points on the device to the mesh on the device; nothing if the phases were not timed.
[[nodiscard]] std::optional<double> on_device(const Statistics& statistics);

/// Calls `call`, which returns its own time, first `warm_up` times and then `runs` times, as long as `budget` (in
/// milliseconds) lasts. There is always one timed run; if the first warm-up has used the budget up, it is that one.
[[nodiscard]] Repeats repeat(std::size_t warm_up, std::size_t runs, double budget, std::optional<double> predicted,
                             const std::function<double()>& call);

/// Times of larger sets from those of smaller ones.
class Predictor {
 public:
  /// \param usual whether it tells something about other work of `who`
  void learn(const std::string& who, const std::string& what, std::size_t points, double milliseconds, bool usual);
  /// Linear from the largest set that `who` did with `what`, or else with anything, and a tenth more; nothing if there
  /// is none that is large enough to tell: what a call costs that does nothing is not to be multiplied by a thousand.
  [[nodiscard]] std::optional<double> predict(const std::string& who, const std::string& what,
                                              std::size_t points) const;

  /// That many points are too many for `who` with `what`: predicted to take too long, or tried in vain.
  void give_up(const std::string& who, const std::string& what, std::size_t points);
  /// The least number of points that was given up, if it is not above `points`.
  [[nodiscard]] std::optional<std::size_t> given_up(const std::string& who, const std::string& what,
                                                    std::size_t points) const;

 private:
  struct Known {
    std::size_t points = 0;
    double milliseconds = 0;
  };
  std::map<std::string, Known> of_who_;
  std::map<std::pair<std::string, std::string>, Known> known_;
  std::map<std::pair<std::string, std::string>, std::size_t> given_up_;
};

}  // namespace cadt::bench
