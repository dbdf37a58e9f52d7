// SPDX-License-Identifier: Apache-2.0
// The device and memory that each thread keeps for small calls of the free function.
#include "common/driver/thread_state.hpp"

#include <gtest/gtest.h>

#include <cadt/errors.hpp>

#include <memory>
#include <thread>

#include "common/driver/gpu_bound.hpp"
#include "common/driver/registry.hpp"

namespace cadt {
namespace {

constexpr std::size_t few = 100, too_many = 16384;

Options on_host() {
  Options options;
  options.backend = Backend::host;
  return options;
}

const void* state_of_call(const Options& options, std::size_t points) { return (*CallState(options, points)).get(); }

TEST(ThreadState, StaysOpen) {
  const void* first = state_of_call(on_host(), few);
  EXPECT_EQ(state_of_call(on_host(), few + 1), first);
  EXPECT_EQ(state_of_call(Options{}, few), first) << "few points are for the host";
  Options options = on_host();
  options.order = Order::fast;
  options.threads = 7;
  EXPECT_EQ(state_of_call(options, few), first);
}

TEST(ThreadState, OneForEachThread) {
  const CallState mine(on_host(), few);
  const void* other = nullptr;
  std::thread([&] { other = state_of_call(on_host(), few); }).join();
  EXPECT_NE(other, nullptr);
  EXPECT_NE(other, (*mine).get());
}

TEST(ThreadState, ACallWithinACallHasItsOwn) {
  const void* usual = state_of_call(on_host(), few);
  {
    const CallState outer(on_host(), few);
    EXPECT_EQ((*outer).get(), usual);
    const CallState inner(on_host(), few);
    EXPECT_NE((*inner).get(), usual);
  }
  EXPECT_EQ(state_of_call(on_host(), few), usual) << "that of the outer call came back last";
}

TEST(ThreadState, KeepsNothingOfTheCallers) {
  const auto owned = std::make_shared<int>(0);
  Options options = on_host();
  options.progress = [owned](const Progress&) {};
  {
    const CallState call(options, few);
    EXPECT_TRUE((*call)->options.progress);
    EXPECT_EQ(owned.use_count(), 3);
  }
  EXPECT_EQ(owned.use_count(), 2);
  EXPECT_FALSE((*CallState(on_host(), few))->options.progress);
}

TEST(ThreadState, KeepsLittleMemory) {
  const auto take = [](std::size_t bytes) {
    const CallState call(on_host(), few);
    Memory& memory = (*call)->memory;
    memory.begin(0, 0);
    const std::size_t kept = memory.peak();
    memory.allocate(bytes).release();
    return kept;
  };
  (void)take(most_kept_by_thread / 2);
  EXPECT_GE(take(1), most_kept_by_thread / 2) << "for the next call";
  (void)take(most_kept_by_thread + 1);
  EXPECT_EQ(take(1), 0U) << "too much";
}

TEST(ThreadState, IsForPlainCallsOfFewPoints) {
  EXPECT_TRUE(suits_calling_thread(on_host(), 0));
  EXPECT_TRUE(suits_calling_thread(on_host(), too_many - 1));
  EXPECT_FALSE(suits_calling_thread(on_host(), too_many));
  EXPECT_TRUE(suits_calling_thread({}, few));
  const auto expect_not = [](const char* why, const auto& change) {
    Options options = on_host();
    change(options);
    EXPECT_FALSE(suits_calling_thread(options, few)) << why;
  };
  expect_not("another back end", [](Options& o) { o.backend = Backend::opencl; });
  expect_not("a device by name", [](Options& o) { o.device = "0"; });
  expect_not("a queue", [](Options& o) { o.queue = nullptr; });
  expect_not("a limit that counts what is kept", [](Options& o) { o.max_memory = 1 << 30; });
  expect_not("locks are for several threads", [](Options& o) { o.tuning.strategy = Strategy::locks; });
  expect_not("so is a grain", [](Options& o) { o.tuning.grain = 1; });
  expect_not("the clock is opened with the device", [](Options& o) { o.tuning.kernel_times = true; });
}

TEST(ThreadState, AutomaticTakesTheHostForFewPoints) {
  Options options;
  EXPECT_TRUE(takes_host(options, GpuBound::before_opening - 1));
  EXPECT_FALSE(takes_host(options, GpuBound::before_opening));
  options.device = "0";
  EXPECT_FALSE(takes_host(options, 1)) << "a device was named";
  options.device.clear();
  options.queue = nullptr;
  EXPECT_FALSE(takes_host(options, 1)) << "a queue without its back end is an error";
  EXPECT_THROW((void)open_device(options, 1), BackendUnavailable);
  EXPECT_FALSE(takes_host(on_host(), 1)) << "it was named";
  EXPECT_EQ(open_device(Options{}, 1)->info().backend, Backend::host);
}

TEST(GpuBound, IsWhereTheLinesCross) {
  EXPECT_EQ(GpuBound::crossing(8e-3, 2e-3), GpuBound::sample / 4);
  EXPECT_EQ(GpuBound::crossing(2e-3, 8e-3), 4 * GpuBound::sample) << "a slow GPU";
  EXPECT_EQ(GpuBound::crossing(1, 1e-9), 1000U);
  EXPECT_EQ(GpuBound::crossing(1e-9, 1), 100'000'000U);
  EXPECT_EQ(GpuBound::crossing(0, 1), 100'000'000U);
}

TEST(GpuBound, IsMeasuredOnceByTheSecondOfTwoCallsEach) {
  GpuBound bound;
  EXPECT_EQ(bound.points(), GpuBound::before_opening);
  int host_calls = 0, gpu_calls = 0;
  const auto on_host = [&] { return ++host_calls == 2 ? 8e-3 : 1.0; };
  const auto on_gpu = [&] { return ++gpu_calls == 2 ? 1e-3 : 1.0; };
  bound.measure(on_host, on_gpu);
  EXPECT_EQ(bound.points(), GpuBound::sample / 8);
  bound.measure(on_host, on_gpu);
  EXPECT_EQ(host_calls, 2);
  EXPECT_EQ(gpu_calls, 2);
  EXPECT_EQ(bound.points(), GpuBound::sample / 8);
}

TEST(GpuBound, StaysIfACallFails) {
  GpuBound bound;
  bound.measure([] { return 1.0; }, []() -> double { throw OutOfMemory("full", 1, 0); });
  EXPECT_EQ(bound.points(), GpuBound::before_opening);
}

}  // namespace
}  // namespace cadt
