// SPDX-License-Identifier: Apache-2.0
// rename and mkdir for LD_PRELOAD that send the process a signal once a certain call has succeeded: the only way to end
// it at that place in every run. CADT_TEST_SIGNAL_AT="CALL END TIME SIGNAL", as in "rename unfinished/node-000004 1 9":
// the first call whose (new) path ends so. "before-rename": when it is about to be made.
#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

/// The thread that waits for the program's first signal (apps/cadt/interrupt.cpp), which blocks all, and ends when it
/// has asked for the end.
bool a_thread_awaits_signals() {
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream status(thread.path() / "status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("SigBlk:") && (std::stoull(line.substr(8), nullptr, 16) >> (SIGTERM - 1) & 1) != 0)
        return true;
    }
  }
  return false;
}

void signal_if_at(const char* call, const std::string& path) noexcept {
  static int times = 0;
  char wanted[16], end[256];
  int time = 0, number = 0;
  const char* text = std::getenv("CADT_TEST_SIGNAL_AT");
  if (text == nullptr || std::sscanf(text, "%15s %255s %d %d", wanted, end, &time, &number) != 4) return;
  if (std::string(wanted) != call || !path.ends_with(end) || ++times != time) return;
  const bool awaited = number != SIGSTOP && a_thread_awaits_signals();
  std::raise(number);
  for (int times = 0; awaited && times < 6000 && a_thread_awaits_signals(); ++times) usleep(10'000);
}

}  // namespace

extern "C" int rename(const char* from, const char* to) noexcept {
  static const auto real = reinterpret_cast<int (*)(const char*, const char*)>(dlsym(RTLD_NEXT, "rename"));
  signal_if_at("before-rename", to);
  const int result = real(from, to);
  if (result == 0) signal_if_at("rename", to);
  return result;
}

extern "C" int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = reinterpret_cast<int (*)(const char*, mode_t)>(dlsym(RTLD_NEXT, "mkdir"));
  const int result = real(path, mode);
  if (result == 0) signal_if_at("mkdir", path);
  return result;
}
