// SPDX-License-Identifier: Apache-2.0
// Calls each step of which fails once, or which are stopped: a typed error, nothing stays allocated, and the same
// triangulator goes on.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

namespace cadt::test {

using Moment = Faults::Moment;
using Reals = std::span<const double>;

struct Outcome {
  std::string hash;
  std::size_t peak = 0;
};

inline Outcome outcome_of(const Triangulation& mesh) {
  return {mesh.hash().to_string(), static_cast<std::size_t>(mesh.statistics().bytes_device_peak)};
}

/// The hashes of all sets.
inline Outcome outcome_of(const TriangulationBatch& batch) {
  Outcome all;
  for (std::size_t s = 0; s < batch.size(); ++s) all.hash += batch.triangulation(s).hash().to_string();
  all.peak = static_cast<std::size_t>(batch.statistics().bytes_device_peak);
  return all;
}

/// What is asked of a triangulator again and again.
using Call = std::function<Outcome(Triangulator&)>;

inline Points some_points() {
  Points xy = cluster_points(200);
  const Points lattice = grid_points(8, 8), spread = uniform_points(100, 3);
  for (const Points* more : {&lattice, &spread, &spread}) xy.insert(xy.end(), more->begin(), more->end());
  return xy;
}

class EveryStep : public ResidentTest {
 protected:
  /// A queue of the library's own: those of the test have no clocks.
  [[nodiscard]] Options without_queue() const {
    Options with = options();
    with.queue.reset();
    return with;
  }

  /// Each step of `call` fails in turn, or one of `each`. `warm`: with memory cached by earlier calls.
  void fail_each(const Options& with, const Call& call, bool warm = false) {
    const auto faults = std::make_shared<Faults>();
    {
      const Injection injection(faults);
      Triangulator triangulator(with);
      const Outcome expected = call(triangulator);
      triangulator.release_memory();
      const std::size_t held = faults->live_bytes(), buffers = faults->live_buffers();
      if (warm) (void)call(triangulator);
      faults->clear();
      EXPECT_EQ(call(triangulator).hash, expected.hash);
      std::array<std::size_t, steps> counts{};
      for (std::size_t s = 0; s < steps; ++s) counts[s] = faults->count(static_cast<Step>(s));
      for (std::size_t s = 0; s < steps; ++s) {
        std::size_t reached = 0;
        for (std::size_t k = s % each; k < counts[s] && !HasFailure(); k += each) {
          const auto step = static_cast<Step>(s);
          SCOPED_TRACE(std::string(to_string(step)) + " " + std::to_string(k) + " of " + std::to_string(counts[s]));
          if (!warm) triangulator.release_memory();
          faults->fail(step, k, k % 2 == 0 ? Moment::before : Moment::after);
          expect_typed(triangulator, call, *faults, step, expected);
          reached += faults->failed();
          faults->clear();
          triangulator.release_memory();
          EXPECT_EQ(faults->live_bytes(), held);
          EXPECT_EQ(faults->live_buffers(), buffers);
          const Outcome next = call(triangulator);
          EXPECT_EQ(next.hash, expected.hash);
          EXPECT_LE(next.peak, most_after(expected.peak)) << "memory is counted that nobody holds";
        }
        if (HasFailure()) return;
        // Conflicts between threads change the number of launches, and of what goes with them; where they change sizes,
        // what was cached may be too small once.
        EXPECT_GE(4 * reached * each + (peak_varies ? 30 : 12), 3 * counts[s]) << to_string(static_cast<Step>(s));
        RecordProperty(to_string(static_cast<Step>(s)), std::to_string(reached));
      }
    }
    EXPECT_EQ(faults->live_buffers(), 0U);
    EXPECT_EQ(faults->live_bytes(), 0U);
  }

  /// One step of so many of a kind fails: for calls of many steps that take long.
  std::size_t each = 1;
  /// Threads decide which pieces of segments wait, and so how large the rings of a launch are.
  bool peak_varies = false;
  [[nodiscard]] std::size_t most_after(std::size_t peak) const { return peak + (peak_varies ? peak / 16 : 0); }

  /// The caller stops `call` at each place where it tells its progress: nothing stays allocated, and the next call is
  /// as ever.
  void cancel_each(const Options& with, const Call& call) {
    const auto faults = std::make_shared<Faults>();
    {
      const Injection injection(faults);
      Triangulator triangulator(with);
      std::size_t calls = 0;
      triangulator.options().progress = [&](const Progress&) { ++calls; };
      const Outcome expected = call(triangulator);
      const std::size_t all = calls;
      EXPECT_GT(all, 3U);
      for (std::size_t k = 0; k < all; ++k) {
        SCOPED_TRACE(k);
        cadt::stop_source source;
        triangulator.options().stop = source.get_token();
        calls = 0;
        triangulator.options().progress = [&](const Progress&) {
          if (calls++ == k) source.request_stop();
        };
        bool stopped = false;
        try {
          (void)call(triangulator);
        } catch (const Cancelled&) {
          stopped = true;
        }
        EXPECT_EQ(stopped, calls > k);
        triangulator.options().stop = {};
        triangulator.options().progress = nullptr;
        triangulator.release_memory();
        EXPECT_EQ(faults->live_bytes(), 0U);
        const Outcome next = call(triangulator);
        EXPECT_EQ(next.hash, expected.hash);
        EXPECT_LE(next.peak, most_after(expected.peak));
      }
    }
    EXPECT_EQ(faults->live_buffers(), 0U);
  }

  static void expect_typed(Triangulator& triangulator, const Call& call, const Faults& faults, Step step,
                           const Outcome& expected) {
    try {
      EXPECT_EQ(call(triangulator).hash, expected.hash);
      // a failed allocation is retried once after the cached memory is freed
      EXPECT_TRUE(faults.failed() == 0 || step == Step::allocation) << "a fault was not noticed";
    } catch (const OutOfMemory& error) {
      EXPECT_EQ(step, Step::allocation) << error.what();
      EXPECT_GT(error.needed(), 0U);
    } catch (const DeviceError& error) {
      EXPECT_NE(step, Step::allocation) << error.what();
      EXPECT_EQ(error.code(), injected_code);
      EXPECT_NE(std::string(error.what()).find(triangulator.device().name), std::string::npos) << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << "another exception: " << error.what();
    }
  }
};

}  // namespace cadt::test
