// SPDX-License-Identifier: Apache-2.0
#include "bench/measure.hpp"

#include <algorithm>
#include <chrono>

namespace cadt::bench {
namespace {

double now() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Stopwatch::Stopwatch() : start_(now()) {}
double Stopwatch::milliseconds() const { return now() - start_; }

std::optional<double> on_device(const Statistics& statistics) {
  if (statistics.milliseconds.empty()) return std::nullopt;
  double sum = 0;
  for (const auto& [phase, time] : statistics.milliseconds)
    if (phase != "upload" && phase != "copy") sum += time;
  return sum;
}

Repeats repeat(std::size_t warm_up, std::size_t runs, double budget, std::optional<double> predicted,
               const std::function<double()>& call) {
  Repeats result;
  const Stopwatch all;
  double one = predicted.value_or(0.0), last = 0.0;
  // A warm-up is of use only if a timed run can follow.
  while (result.warmups < warm_up && all.milliseconds() + 2.0 * one <= budget) {
    last = one = call();
    ++result.warmups;
  }
  while (result.milliseconds.size() < runs) {
    if (all.milliseconds() + one > budget) {
      if (!result.milliseconds.empty()) break;
      if (result.warmups > 0) {
        --result.warmups;
        result.milliseconds.push_back(last);
        break;
      }
    }
    one = call();
    result.milliseconds.push_back(one);
  }
  return result;
}

void Predictor::learn(const std::string& who, const std::string& what, std::size_t points, double milliseconds,
                      bool usual) {
  if (points == 0) return;
  const auto keep = [&](Known& known) {
    if (points >= known.points) known = {points, milliseconds};
  };
  keep(known_[{who, what}]);
  if (usual) keep(of_who_[who]);
}

std::optional<double> Predictor::predict(const std::string& who, const std::string& what, std::size_t points) const {
  constexpr std::size_t most_times_larger = 100;
  constexpr double margin = 1.1;
  const auto from = [&](const Known& known) -> std::optional<double> {
    if (points / most_times_larger > known.points) return std::nullopt;
    return margin * known.milliseconds * static_cast<double>(points) / static_cast<double>(known.points);
  };
  if (const auto found = known_.find({who, what}); found != known_.end()) {
    if (const auto predicted = from(found->second)) return predicted;
  }
  if (const auto found = of_who_.find(who); found != of_who_.end()) return from(found->second);
  return std::nullopt;
}

void Predictor::give_up(const std::string& who, const std::string& what, std::size_t points) {
  std::size_t& least = given_up_.try_emplace({who, what}, points).first->second;
  least = std::min(least, points);
}

std::optional<std::size_t> Predictor::given_up(const std::string& who, const std::string& what,
                                               std::size_t points) const {
  const auto found = given_up_.find({who, what});
  if (found == given_up_.end() || found->second > points) return std::nullopt;
  return found->second;
}

}  // namespace cadt::bench
