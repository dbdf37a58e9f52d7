// SPDX-License-Identifier: Apache-2.0
// Times of calls on small sets on the host: the free function and a kept Triangulator beside CGAL's insertion, all in
// turn in one process on the same points. A table of microseconds a call, medians, with the ratio to CGAL's; --check
// compares them with what is promised.
#include <cadt/cadt.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/oracle.hpp"

namespace {

using namespace cadt;
using Clock = std::chrono::steady_clock;

struct Arguments {
  std::vector<std::size_t> points = {3, 5, 10, 100, 1000, 10'000, 50'000};
  std::vector<unsigned> threads = {1, 0};
  double seconds = 2;
  bool least = false, check = false;
};

/// What a call may take at most, times CGAL's.
struct Promise {
  std::size_t points;
  double ratio;
};
constexpr std::array<Promise, 4> promises = {{{10, 3.0}, {100, 1.5}, {1000, 1.0}, {10'000, 0.8}}};
constexpr std::size_t fewest = 5;        // points of which the free function, named free-...,
constexpr double most_microseconds = 5;  // takes so long at most

struct Contestant {
  std::string name;
  std::function<double(const std::vector<double>&)> call;  ///< returns its microseconds
  std::vector<double> times = {};
};

std::vector<double> uniform(std::size_t n, std::size_t seed) {
  std::mt19937_64 random(n + 1'000'000 * seed);
  std::uniform_real_distribution<double> real(0, 1);
  std::vector<double> xy(2 * n);
  for (double& value : xy) value = real(random);
  return xy;
}

/// Sets of n points, so many that a processor does not learn the branches of one by heart.
std::vector<std::vector<double>> some_sets(std::size_t n) {
  std::vector<std::vector<double>> sets;
  for (std::size_t seed = 0; seed < std::max<std::size_t>(1, 20'000 / n); ++seed) sets.push_back(uniform(n, seed));
  return sets;
}

template <class Call>
double microseconds(const Call& call) {
  const auto begin = Clock::now();
  const Triangulation mesh = call();
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

Options options_with(unsigned threads) {
  Options options;
  options.backend = Backend::host;
  options.threads = threads;
  return options;
}

std::vector<Contestant> contestants(const Arguments& a, std::vector<Triangulator>& kept) {
  std::vector<Contestant> all;
#if CADT_TEST_CGAL
  all.push_back({"cgal", [](const std::vector<double>& xy) { return 1e6 * test::cgal_insertion(xy).seconds; }});
#endif
  kept.reserve(a.threads.size());
  for (const unsigned threads : a.threads) {
    const Options options = options_with(threads);
    const std::string suffix = threads == 0 ? "all" : std::to_string(threads);
    all.push_back({"free-" + suffix, [options](const std::vector<double>& xy) {
                     return microseconds([&] { return triangulate(xy, options); });
                   }});
    Triangulator& triangulator = kept.emplace_back(options);
    all.push_back({"kept-" + suffix, [&triangulator](const std::vector<double>& xy) {
                     return microseconds([&] { return triangulator.triangulate(xy); });
                   }});
  }
  return all;
}

double figure_of(std::vector<double> times, bool least) {
  const auto at = times.begin() + static_cast<std::ptrdiff_t>(least ? 0 : times.size() / 2);
  std::ranges::nth_element(times, at);
  return *at;
}

/// Whether the time of a call, with this ratio to CGAL's, is what is promised; always if nothing is.
bool is_as_promised(const std::string& name, std::size_t n, double time, double ratio) {
  if (name == "cgal") return true;
  if (n == fewest && name.starts_with("free")) return time <= most_microseconds;
  const auto promise = std::ranges::find(promises, n, &Promise::points);
  return promise == promises.end() || !CADT_TEST_CGAL || ratio <= promise->ratio;
}

/// Returns how many do not keep what is promised.
int measure(const Arguments& a, std::vector<Contestant>& all, std::size_t n) {
  const std::vector<std::vector<double>> sets = some_sets(n);
  for (Contestant& one : all) {
    one.times.clear();
    for (int warm_up = 0; warm_up < 3; ++warm_up) (void)one.call(sets[0]);
  }
  const auto end = Clock::now() + std::chrono::duration<double>(a.seconds);
  for (std::size_t round = 0; Clock::now() < end || round < 5; ++round)
    for (Contestant& one : all) one.times.push_back(one.call(sets[round % sets.size()]));
  std::printf("%8zu", n);
  const double first = figure_of(all.front().times, a.least);
  int slow = 0;
  for (const Contestant& one : all) {
    const double time = figure_of(one.times, a.least);
    const bool kept = is_as_promised(one.name, n, time, time / first);
    slow += kept ? 0 : 1;
    std::printf("  %10.2f (%5.2f)%s", time, time / first, kept ? " " : "<");
  }
  std::printf("  %zu calls\n", all.front().times.size());
  std::fflush(stdout);
  return slow;
}

}  // namespace

int main(int count, char** values) {
  Arguments a;
  CLI::App app("Times calls on small sets on the host, beside CGAL.", "cadt-small-sets");
  app.add_option("-n,--points", a.points, "points of each set, with commas between")->delimiter(',');
  app.add_option("-t,--threads", a.threads, "threads, with commas between; 0: all cores (default: 1,0)")
      ->delimiter(',');
  app.add_option("-s,--seconds", a.seconds, "for each set (default: 2)")->check(CLI::PositiveNumber);
  app.add_flag("--least", a.least, "the least times instead of the medians");
  app.add_flag("--check", a.check, "exit with 1 if a call takes longer than promised (<)");
  CLI11_PARSE(app, count, values);
  try {
    std::vector<Triangulator> kept;
    std::vector<Contestant> all = contestants(a, kept);
    std::printf("%8s", "points");
    for (const Contestant& one : all) std::printf("  %19s", one.name.c_str());
    std::printf("  (microseconds a call, ratio to the first)\n");
    int slow = 0;
    for (const std::size_t n : a.points) slow += measure(a, all, n);
    if (a.check && slow != 0) return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cadt-small-sets: %s\n", error.what());
    return 2;
  }
  return 0;
}
