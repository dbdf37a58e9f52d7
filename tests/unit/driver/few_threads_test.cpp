// SPDX-License-Identifier: Apache-2.0
// Calls where the system starts fewer threads than Options::threads allows, or none.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "tests/support/sanitizers.hpp"

#if defined(__GLIBC__) && !CADT_SANITIZED
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace cadt {
namespace {

/// While this lives, about so many more threads can be started: there are no addresses for the stacks of others.
class FewThreads {
 public:
  explicit FewThreads(std::size_t threads) {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    pthread_getattr_default_np(&usual_);
    pthread_attr_t large = usual_;
    pthread_attr_setstacksize(&large, stack);
    pthread_setattr_default_np(&large);
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + threads * stack + stack / 2;
    limited_ = limit.rlim_cur < before_.rlim_max && setrlimit(RLIMIT_AS, &limit) == 0;
  }
  ~FewThreads() {
    setrlimit(RLIMIT_AS, &before_);
    pthread_setattr_default_np(&usual_);
  }
  FewThreads(const FewThreads&) = delete;
  FewThreads& operator=(const FewThreads&) = delete;

  [[nodiscard]] bool limited() const noexcept { return limited_; }

 private:
  static constexpr std::size_t stack = std::size_t{1} << 28;
  pthread_attr_t usual_{};
  rlimit before_{};
  bool limited_ = false;
};

std::vector<double> many_points() {
  std::mt19937_64 random(5);
  std::vector<double> xy(60000);
  for (double& v : xy) v = static_cast<double>(random() >> 11);
  return xy;
}

Options with(unsigned threads) {
  Options options;
  options.backend = Backend::host;
  options.threads = threads;
  return options;
}

/// The threads of a call of which the system starts about `started` more than the caller's; its mesh must be right.
std::uint64_t threads_of_call(unsigned wanted, std::size_t started) {
  const std::vector<double> xy = many_points();
  const Hash128 expected = triangulate(xy, with(1)).hash();
  std::optional<FewThreads> few(std::in_place, started);
  EXPECT_TRUE(few->limited());
  Triangulator triangulator(with(wanted));
  few.reset();
  for (int call = 0; call < 3; ++call) EXPECT_EQ(triangulator.triangulate(xy).hash(), expected);
  return triangulator.triangulate(xy).statistics().threads;
}

TEST(FewThreads, ThoseThatStartDoTheWork) {
  const std::uint64_t threads = threads_of_call(12, 4);
  EXPECT_GT(threads, 1U);
  EXPECT_LT(threads, 12U);
  EXPECT_EQ(threads_of_call(12, 0), 1U);
}

TEST(FewThreads, AnyNumberCanBeAskedFor) {
  for (const unsigned wanted : {100000U, ~0U}) EXPECT_LT(threads_of_call(wanted, 3), 12U);
}

TEST(FewThreads, AsynchronousCallsNeedOne) {
  const std::vector<double> xy = many_points();
  const std::vector<std::size_t> offsets = {0, 10, 20};
  Triangulator triangulator(with(1));
  {
    const FewThreads none(0);
    EXPECT_THROW((void)triangulator.triangulate_async(xy), OutOfMemory);
    EXPECT_THROW((void)triangulator.triangulate_batch_async(PointsView(xy).subview(0, 20), offsets), OutOfMemory);
  }
  EXPECT_EQ(triangulator.triangulate_async(xy).get().hash(), triangulator.triangulate(xy).hash());
}

}  // namespace
}  // namespace cadt
#endif
