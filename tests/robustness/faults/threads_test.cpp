// SPDX-License-Identifier: Apache-2.0
// Many small calls from several threads at once, each thread with a triangulator of its own, on one back end and on all
// of them together: what a service does. CADT_FAULT_CALLS: calls of each thread (100).
#include "tests/system/resident/resident.hpp"

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>

namespace cadt::test {
namespace {

constexpr int threads = 8;

int calls_of_a_thread() {
  const char* wanted = std::getenv("CADT_FAULT_CALLS");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : 100;
}

/// Small sets of all kinds, and their meshes by the serial host.
const std::vector<Known>& small_sets() {
  static const auto* const sets = [] {
    auto* all = new std::vector<Known>;
    for (std::size_t n = 0; n <= 64; ++n) all->emplace_back(uniform_points(n, n + 1));
    for (const Points& xy : {grid_points(6, 7), hub_points(30), axis_cross(6), Points(40, 2.5), cluster_points(200),
                             uniform_points(500, 9), regular_polygon(24, 1, 2, 3)})
      all->emplace_back(xy);
    return all;
  }();
  return *sets;
}

/// What goes wrong in `calls` calls that begin with set `first`; empty if nothing does.
std::string calls_in_a_row(const Options& options, std::size_t first, int calls) {
  try {
    Triangulator triangulator(options);
    for (int call = 0; call < calls; ++call) {
      const Known& known = small_sets()[(first + 13 * static_cast<std::size_t>(call)) % small_sets().size()];
      if (call % 25 == 24) {  // a device of its own besides
        if (triangulate(std::span<const double>(known.xy), options).hash() != known.mesh.hash())
          return "another mesh of " + std::to_string(known.size()) + " points";
      }
      if (triangulator.triangulate(std::span<const double>(known.xy)).hash() != known.mesh.hash())
        return "another mesh of " + std::to_string(known.size()) + " points in call " + std::to_string(call);
    }
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void expect_all_the_same(const std::vector<Options>& of_threads) {
  (void)small_sets();
  std::vector<std::string> wrong(of_threads.size());
  std::vector<std::thread> pool;
  std::atomic<std::size_t> ready{0};
  for (std::size_t t = 0; t < of_threads.size(); ++t)
    pool.emplace_back([&, t] {
      for (++ready; ready < of_threads.size();) std::this_thread::yield();
      wrong[t] = calls_in_a_row(of_threads[t], 7 * t, calls_of_a_thread());
    });
  for (std::thread& thread : pool) thread.join();
  for (std::size_t t = 0; t < wrong.size(); ++t) EXPECT_EQ(wrong[t], "") << "thread " << t;
}

class ThreadsAtOnce : public BackendTest {};

TEST_P(ThreadsAtOnce, SmallCalls) { expect_all_the_same(std::vector<Options>(threads, GetParam().options())); }
CADT_ON_MAIN_BACKENDS(ThreadsAtOnce);

TEST(ThreadsOfAllBackends, SmallCalls) {
  std::vector<Options> usable, of_threads;
  for (const auto& cases : {main_host_case(), main_opencl_case(), main_cuda_case()})
    for (const BackendCase& one : cases)
      if (unavailable(one.backend).empty()) usable.push_back(one.options());
  for (std::size_t t = 0; t < threads; ++t) of_threads.push_back(usable[t % usable.size()]);
  if (usable.size() < 2) GTEST_SKIP() << "there is only one back end";
  expect_all_the_same(of_threads);
}

}  // namespace
}  // namespace cadt::test
