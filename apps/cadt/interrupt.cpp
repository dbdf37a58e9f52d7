// SPDX-License-Identifier: Apache-2.0
// request_stop() must not be called from a signal handler (it takes a lock that the interrupted thread may hold), so
// the handler only writes a byte to a pipe; a thread that waits at the other end does the rest.
#include "interrupt.hpp"

#include "failure.hpp"
#include "system.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <thread>

#if defined(_WIN32)
#include <windows.h>
#else
#include <fcntl.h>
#include <unistd.h>
#endif

namespace cadt::cli {
namespace {

struct State {
  std::mutex mutex;
  Phase phase = Phase::free;
  cadt::stop_source stop;
};

// Never destroyed: the waiting thread may outlive main().
State& state() {
  static State* const instance = new State;
  return *instance;
}

void stop_or_end() {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  s.stop.request_stop();
  const bool terminal = errors_go_to_terminal();
  if (s.phase == Phase::free) {
    say(terminal ? "\ncadt: interrupted\n" : "cadt: interrupted\n");
    std::_Exit(exit_interrupted);
  }
  if (terminal) say("\ncadt: stopping; interrupt again to end at once\n");
}

#if defined(_WIN32)

// Runs in a thread of its own. The second time the default handler ends the process.
BOOL WINAPI on_console_event(DWORD /*event*/) {
  if (state().stop.stop_requested()) return FALSE;
  stop_or_end();
  return TRUE;
}

#else

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};
int pipe_ends[2] = {-1, -1};
constexpr long long at_once = 200;  // milliseconds: Slurm sends the same signal twice, two milliseconds apart
std::atomic<long long> first_at{0};
static_assert(std::atomic<long long>::is_always_lock_free);

extern "C" void on_signal(int number) {
  const int saved = errno;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const long long at = now.tv_sec * 1000LL + now.tv_nsec / 1000000 + 1;
  long long before = 0;
  if (first_at.compare_exchange_strong(before, at)) {
    const char byte = 1;
    [[maybe_unused]] const auto written = write(pipe_ends[1], &byte, 1);
  } else if (at - before >= at_once) {  // the default effect, whatever the process is blocked in
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  errno = saved;
}

void wait_for_signal() {
  char byte = 0;
  while (read(pipe_ends[0], &byte, 1) < 0 && errno == EINTR) {
  }
  stop_or_end();
}

#endif

}  // namespace

#if defined(_WIN32)

void install_interrupt_handlers() {
  state();
  ::SetConsoleCtrlHandler(on_console_event, TRUE);
}

#else

/// Standard streams that are closed fail when they are used. If their numbers were free, the next files would get them:
/// a pipe or an output would be read or written in their place.
void keep_standard_streams() {
  for (int stream = 0; stream < 3; ++stream) {
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
      [[maybe_unused]] const int same = open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
    }
  }
}

void install_interrupt_handlers() {
  state();
  keep_standard_streams();
  if (pipe(pipe_ends) != 0) return;  // then the signals keep their default effect
  for (const int end : pipe_ends) fcntl(end, F_SETFD, FD_CLOEXEC);
  // The thread that waits must not be the one that a signal interrupts in a read of standard input.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread(wait_for_signal).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);

  for (const int number : signals) {
    struct sigaction old {};
    if (sigaction(number, nullptr, &old) != 0 || old.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int other : signals) sigaddset(&action.sa_mask, other);
    sigaction(number, &action, nullptr);
  }
}

#endif

cadt::stop_token interrupt_token() { return state().stop.get_token(); }

void check_interrupt() {
  if (state().stop.stop_requested()) throw Cancelled();
}

InPhase::InPhase(Phase phase) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  before_ = s.phase;
  s.phase = phase;
}

InPhase::~InPhase() {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  s.phase = before_;
}

}  // namespace cadt::cli
