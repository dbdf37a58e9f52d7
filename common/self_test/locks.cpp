// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cadt/errors.hpp>
#include <vector>

#include "common/driver/device_text.hpp"
#include "common/self_test/self_test.hpp"

namespace cadt {
namespace {

constexpr std::uint32_t triangles = 31;  // a prime number
constexpr std::uint32_t items = 1001, rounds = 32;
// More than 2^16: there is a driver on which all loops of a work-item together end there, and which computes on.
constexpr std::uint32_t turns = 100'000;
constexpr std::uint32_t factor = 2654435761U;  // CADT_COUNT_FACTOR

struct Found {
  std::uint32_t counted = 0, torn = 0, random = 0;
};
using Words = std::array<std::uint32_t, 8>;  // of a locked triangle

[[noreturn]] void refuse(const Device& device, const std::string& test, const std::string& what) {
  throw BackendUnavailable(std::string(to_string(device.info().backend)),
                           "'" + device.info().name + "' fails the self-test '" + test + "': " + what +
                               "; a newer driver may help, or another device (see: cadt devices)");
}

class LockTest {
 public:
  explicit LockTest(Device& device)
      : device_(device), locked_(device.allocate(sizeof(Words) * triangles)), found_(device.allocate(sizeof(Found))) {
    std::vector<Words> words(triangles);
    for (Words& w : words) w = {0, 0, ~0U, 2, 0, 0, 0, 0};
    device.write(*locked_, 0, words.data(), sizeof(Words) * triangles);
  }

  Found run(std::uint32_t work_items, std::uint32_t tries, std::uint32_t loop) {
    const std::unique_ptr<Buffer> none;
    device_.fill(*found_, 0, sizeof(Found), 0);
    const std::array<Arg, 17> arguments = {Arg(locked_),   Arg(none),  Arg(none),       Arg(none), Arg(0.0),   Arg(0.0),
                                           Arg(0U),        Arg(0U),    Arg(0U),         Arg(0U),   Arg(0U),    Arg(0.0),
                                           Arg(triangles), Arg(tries), Arg(work_items), Arg(loop), Arg(found_)};
    device_.launch(KernelId::cadt_selftest_locks, work_items, arguments, KernelVariant::narrow);
    Found found;
    device_.read(*found_, 0, &found, sizeof found);
    counted_ += found.counted;
    return found;
  }

  /// Compares the triangles with what all launches together have counted.
  void compare() {
    std::vector<Words> words(triangles);
    device_.read(*locked_, 0, words.data(), sizeof(Words) * triangles);
    std::uint32_t sum = 0;
    for (const Words& w : words) {
      const std::uint32_t count = w[0], lock = w[3];
      if (lock % 2 != 0) refuse(device_, "locks are given up", "a triangle stays locked");
      if (w[1] != count * factor || w[2] != ~count || lock != 2 + 2 * count)
        refuse(device_, "updates under a lock",
               "a triangle was counted in " + std::to_string(count) + " times, and unlocked " +
                   std::to_string((lock - 2) / 2) + " times after a change");
      sum += count;
    }
    if (sum != 3 * counted_)
      refuse(device_, "updates under a lock",
             std::to_string(3 * counted_) + " were made, " + std::to_string(sum) + " are there");
  }

 private:
  Device& device_;
  std::unique_ptr<Buffer> locked_, found_;
  std::uint32_t counted_ = 0;
};

std::uint32_t after_loop(std::uint32_t random) {
  for (std::uint32_t turn = 0; turn < turns; ++turn) random = random * 1664525U + 1013904223U;
  return random;
}

}  // namespace

void run_lock_test(Device& device) {
  LockTest test(device);
  if (const Found found = test.run(1, 0, turns); found.random != after_loop(0))
    refuse(device, "a loop of " + std::to_string(turns) + " turns", "it ends before");
  if (const Found found = test.run(items, rounds, 0); found.torn != 0)
    refuse(device, "words of one state", std::to_string(found.torn) + " triangles were read half changed");
  test.compare();
  // What the launch before has left can be locked by one work-item alone, always.
  if (const Found found = test.run(1, rounds, 0); found.counted != rounds)
    refuse(device, "locks of one work-item alone",
           std::to_string(rounds - found.counted) + " of " + std::to_string(rounds) + " tries failed");
  test.compare();
}

}  // namespace cadt
