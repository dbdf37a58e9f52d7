// SPDX-License-Identifier: Apache-2.0
#include "bench/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>
#include <utility>

extern char** environ;

namespace cadt::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_output = std::size_t{1} << 20, most_errors = std::size_t{1} << 12;

/// A pipe whose ends are closed with it. Not inherited but by who is given an end.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) ends_ = {-1, -1};
  }
  ~Pipe() {
    close_read();
    close_write();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  [[nodiscard]] bool open() const { return ends_[0] >= 0; }
  [[nodiscard]] int read_end() const { return ends_[0]; }
  [[nodiscard]] int write_end() const { return ends_[1]; }
  void close_read() { close(ends_[0]); }
  void close_write() { close(ends_[1]); }

 private:
  static void close(int& end) {
    if (end >= 0) ::close(std::exchange(end, -1));
  }
  std::array<int, 2> ends_ = {-1, -1};
};

/// 0, or the error number.
int start(const std::vector<std::string>& command, const Pipe& output, const Pipe& errors, pid_t& child) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  if (const int error = posix_spawn_file_actions_init(&actions)) return error;
  int error = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (!error) error = posix_spawn_file_actions_adddup2(&actions, output.write_end(), STDOUT_FILENO);
  if (!error) error = posix_spawn_file_actions_adddup2(&actions, errors.write_end(), STDERR_FILENO);
  if (!error) error = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// Appends what is there to read; closes the pipe at its end.
void drain(Pipe& pipe, std::string& text) {
  std::array<char, 4096> buffer;
  const ssize_t count = read(pipe.read_end(), buffer.data(), buffer.size());
  if (count > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
  } else if (count == 0 || errno != EINTR) {
    pipe.close_read();
  }
}

int milliseconds_until(Clock::time_point end) {
  const double left = std::chrono::duration<double, std::milli>(end - Clock::now()).count();
  return static_cast<int>(std::clamp(std::ceil(left), 0.0, 1e6));
}

/// Reads both pipes until their ends. Returns why it stopped before that.
std::string listen(Pipe& output, Pipe& errors, Clock::time_point end, ChildResult& result) {
  while (output.open() || errors.open()) {
    std::array<pollfd, 2> waiting = {pollfd{output.read_end(), POLLIN, 0}, pollfd{errors.read_end(), POLLIN, 0}};
    if (poll(waiting.data(), waiting.size(), milliseconds_until(end)) < 0 && errno != EINTR)
      return std::strerror(errno);
    if (waiting[0].revents) drain(output, result.output);
    if (waiting[1].revents) drain(errors, result.errors);
    if (result.errors.size() > most_errors) result.errors.erase(0, result.errors.size() - most_errors);
    if (result.output.size() > most_output) return "wrote too much";
    if (Clock::now() >= end) return "timeout";
  }
  return {};
}

}  // namespace

ChildResult run_child(const std::vector<std::string>& command, double timeout_seconds) {
  ChildResult result;
  Pipe output, errors;
  if (command.empty() || !output.open() || !errors.open()) {
    result.failure = command.empty() ? "no command" : std::string("no pipe: ") + std::strerror(errno);
    return result;
  }
  // A century at most: the clock counts nanoseconds in 64 bits.
  const std::chrono::duration<double> timeout(std::clamp(timeout_seconds, 0.0, 3e9));
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
  pid_t child = 0;
  if (const int error = start(command, output, errors, child)) {
    result.failure = "cannot start " + command[0] + ": " + std::strerror(error);
    return result;
  }
  output.close_write();
  errors.close_write();
  result.failure = listen(output, errors, end, result);
  int status = 0;
  pid_t ended = 0;
  // Both pipes are closed a little before the end, and a child may close them and go on.
  while (result.failure.empty() && (ended = waitpid(child, &status, WNOHANG)) == 0) {
    if (Clock::now() >= end) result.failure = "timeout";
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (result.failure == "timeout") {
    result.too_slow = true;
    std::array<char, 32> seconds;
    std::snprintf(seconds.data(), seconds.size(), "%.3g", timeout.count());
    result.failure = std::string("killed after ") + seconds.data() + " s";
  }
  if (ended == 0) {
    kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace cadt::bench
