// SPDX-License-Identifier: Apache-2.0
#include "bench/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <climits>
#include <csignal>
#include <cstring>
#include <string_view>

namespace cadt::bench {
namespace {

// Lock-free atomics and plain system calls only: a handler may do no more.
constexpr int writing = 1, stopped = 2;
std::atomic<int> state{0};
static_assert(std::atomic<int>::is_always_lock_free);
char temporary[PATH_MAX] = {};
std::atomic<bool> has_temporary{false};

[[noreturn]] void end() noexcept {
  if (has_temporary.load()) ::unlink(temporary);
  constexpr std::string_view text = "\ncadt-bench: interrupted; the experiment in progress is not written\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  ::_exit(130);
}

extern "C" void on_signal(int) {
  if ((state.fetch_or(stopped) & writing) == 0) end();
}

}  // namespace

void install_interrupt_handlers() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction old {};
    // What the parent ignores (nohup, background jobs) stays ignored.
    if (sigaction(number, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
}

Writing::Writing() noexcept {
  if ((state.fetch_or(writing) & stopped) != 0) {
    for (;;) ::pause();  // another thread's handler is ending the process
  }
}

Writing::~Writing() {
  if ((state.fetch_and(~writing) & stopped) != 0) end();
}

void remove_on_interrupt(const std::string& path) noexcept {
  has_temporary = false;
  if (path.empty() || path.size() >= sizeof temporary) return;
  std::memcpy(temporary, path.c_str(), path.size() + 1);
  has_temporary = true;
}

}  // namespace cadt::bench
