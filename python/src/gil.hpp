// SPDX-License-Identifier: Apache-2.0
// The GIL, which calls of the library let go of, and turns of threads that wait for each other without it.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

namespace cadt_python {

namespace nb = nanobind;

/// Whether Python has ended during a thread's call: what that thread has locked stays locked.
inline std::atomic<bool> thread_lost = false;
/// Whether Python has ended so far that there is no GIL.
inline std::atomic<bool> python_gone = false;

/// When the module is imported.
inline void watch_for_the_end() {
  // This is cleared after all modules, and before what the functions of the GIL look at.
  const nb::handle kept = PyInterpreterState_GetDict(PyInterpreterState_Get());
  nb::borrow<nb::dict>(kept)["cadt"] = nb::capsule(&python_gone, [](void*) noexcept { python_gone = true; });
}

[[noreturn]] inline void sleep_until_the_process_is_gone() {
  thread_lost = true;
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// `take()` takes the GIL. Python before 3.14, while it ends, ends the threads that do so, and with glibc their stack
/// is unwound through destructors, which may not be left like that. Such a thread sleeps.
template <class Take>
void or_sleep(Take&& take) noexcept {
  if (python_gone) sleep_until_the_process_is_gone();
  try {
    take();
  } catch (...) {
    sleep_until_the_process_is_gone();
  }
}

/// While this lives, other threads have the GIL.
class ReleasedGil {
 public:
  ReleasedGil() : thread_(PyEval_SaveThread()) {}
  ~ReleasedGil() {
    or_sleep([this] { PyEval_RestoreThread(thread_); });
  }
  ReleasedGil(const ReleasedGil&) = delete;
  ReleasedGil& operator=(const ReleasedGil&) = delete;

 private:
  PyThreadState* thread_;
};

template <class Work>
auto without_gil(Work&& work) {
  const ReleasedGil released;
  return work();
}

/// Runs `work()` with the GIL. It calls Python's own functions alone, and throws nothing.
template <class Work>
void with_gil(Work&& work) noexcept {
  or_sleep([&] {
    const PyGILState_STATE state = PyGILState_Ensure();
    work();
    PyGILState_Release(state);
  });
}

/// A lock for calls without the GIL. Those who wait hear Ctrl-C.
class Turns {
 public:
  /// \throws nb::python_error what a handler of a signal has raised
  void lock() {
    while (!mutex_.try_lock_for(std::chrono::milliseconds(50))) {
      std::optional<nb::python_error> raised;
      with_gil([&] {
        if (PyErr_CheckSignals() != 0) raised.emplace();
      });
      if (raised) throw std::move(*raised);
      if (thread_lost) throw std::runtime_error("Python ends, and a call of another thread has not");
    }
    user_ = std::this_thread::get_id();
  }
  [[nodiscard]] bool try_lock() {
    if (is_mine() || !mutex_.try_lock()) return false;
    user_ = std::this_thread::get_id();
    return true;
  }
  void unlock() {
    user_ = std::thread::id();
    mutex_.unlock();
  }
  /// Whether it is the calling thread's turn: it is in a call that reports to this one.
  [[nodiscard]] bool is_mine() const noexcept { return user_ == std::this_thread::get_id(); }

 private:
  std::timed_mutex mutex_;
  std::atomic<std::thread::id> user_{};
};

}  // namespace cadt_python
