// SPDX-License-Identifier: Apache-2.0
#include "viewer/growth/video.hpp"

#include <cadt/io/errors.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

extern char** environ;

namespace cadt::viewer {
namespace {

std::string suffix_of(std::string_view path) { return std::filesystem::path(path).extension().string(); }

/// What ffmpeg calls the format, and what it needs beside.
std::vector<std::string> output_options(const std::string& suffix) {
  if (suffix == ".gif")  // colours of the film, not of a fixed palette
    return {"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f", "gif"};
  if (suffix == ".webm") return {"-pix_fmt", "yuv420p", "-f", "webm"};
  return {"-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"};
}

}  // namespace

bool is_video(std::string_view path) noexcept {
  return path.ends_with(".mp4") || path.ends_with(".webm") || path.ends_with(".gif");
}

bool has_ffmpeg() {
  const char* path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::string folder(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (::access((folder + "/ffmpeg").c_str(), X_OK) == 0) return true;
  }
  return false;
}

Video::Video(std::string path, int width, int height, double fps) : path_(std::move(path)) {
  const std::filesystem::path target(path_);
  temporary_ = (target.parent_path() / fmt::format(".cadt-{}{}.tmp", ::getpid(), target.extension().string())).string();
  std::vector<std::string> words{"ffmpeg",
                                 "-hide_banner",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pix_fmt",
                                 "rgba",
                                 "-s",
                                 fmt::format("{}x{}", width, height),
                                 "-r",
                                 fmt::format("{}", fps),
                                 "-i",
                                 "-"};
  for (std::string& word : output_options(suffix_of(path_))) words.push_back(std::move(word));
  words.push_back("file:" + temporary_);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw io::FileError(path_, 0, std::string("no pipe to ffmpeg: ") + std::strerror(errno));
  // Its messages go to a file without a name: a pipe could fill up while nobody reads it.
  messages_ = ::open(std::filesystem::temp_directory_path().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (messages_ >= 0) ::posix_spawn_file_actions_adddup2(&actions, messages_, STDERR_FILENO);
  // Ctrl-C is for the program that started it, which then stops ffmpeg.
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  const int error = ::posix_spawnp(&process_, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (error != 0) {
    process_ = -1;
    ::close(std::exchange(pipe_, -1));
    if (messages_ >= 0) ::close(std::exchange(messages_, -1));
    throw io::FileError(path_, 0, std::string("ffmpeg cannot be started: ") + std::strerror(error));
  }
}

Video::~Video() {
  if (pipe_ >= 0) ::close(pipe_);
  if (process_ >= 0) {
    ::kill(-process_, SIGKILL);  // its group, which has its children
    wait();
  }
  if (messages_ >= 0) ::close(messages_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

int Video::wait() noexcept {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

std::string Video::last_line() const {
  std::string text;
  char part[4096];
  off_t at = 0;
  for (ssize_t got; messages_ >= 0 && (got = ::pread(messages_, part, sizeof part, at)) > 0; at += got)
    text.append(part, static_cast<std::size_t>(got));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.pop_back();
  const std::size_t begin = text.find_last_of("\r\n");
  return begin == std::string::npos ? text : text.substr(begin + 1);
}

void Video::fail(int status) {
  const std::string said = last_line();
  const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                              : fmt::format("ended with exit code {}", WEXITSTATUS(status));
  throw io::FileError(path_, 0, fmt::format("ffmpeg {}{}{}", how, said.empty() ? "" : ": ", said));
}

void Video::write(const Image& picture) {
  // A write after ffmpeg has ended must be an error, not a signal that ends the process.
  sigset_t pipe_signal, before;
  ::sigemptyset(&pipe_signal);
  ::sigaddset(&pipe_signal, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  const std::uint8_t* bytes = picture.rgba.data();
  std::size_t left = picture.rgba.size();
  int error = 0;
  while (left != 0 && error == 0) {
    const ssize_t put = ::write(pipe_, bytes, left);
    if (put < 0) {
      if (errno != EINTR) error = errno;
      continue;
    }
    bytes += put;
    left -= static_cast<std::size_t>(put);
  }
  if (error == EPIPE) {
    const timespec at_once{0, 0};
    ::sigtimedwait(&pipe_signal, nullptr, &at_once);  // takes the signal that waits
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (error == EPIPE) {
    ::close(std::exchange(pipe_, -1));
    fail(wait());
  }
  if (error != 0) throw io::FileError(path_, 0, std::string("ffmpeg takes no pictures: ") + std::strerror(error));
}

void Video::finish() {
  ::close(std::exchange(pipe_, -1));
  const int status = wait();
  if (status != 0) fail(status);
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0)
    throw io::FileError(path_, 0, std::string("cannot be written: ") + std::strerror(errno));
  temporary_.clear();
}

}  // namespace cadt::viewer
