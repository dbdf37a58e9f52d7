// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target without libFuzzer: on the files of a corpus, and on as many random changes of them as asked for,
// the same ones each time. The input of a crash is left in the file crash-PID. usage: replay [--changes N]
// FILE-OR-FOLDER...
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/robustness/fuzz/fuzz.hpp"

namespace {

using Input = std::vector<std::uint8_t>;

Input read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// One of: a bit, a byte, a few bytes left out, doubled or from another input, the end cut off.
void change(Input& input, const Input& other, std::mt19937_64& random) {
  if (input.empty()) input.push_back(0);
  const auto pick = [&](std::size_t n) { return static_cast<std::ptrdiff_t>(random() % n); };
  const std::ptrdiff_t at = pick(input.size()), length = std::min<std::ptrdiff_t>(1 + pick(16), std::ssize(input) - at);
  switch (random() % 6) {
    case 0:
      input[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1u << random() % 8);
      break;
    case 1:
      input[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random());
      break;
    case 2:
      input.erase(input.begin() + at, input.begin() + at + length);
      break;
    case 3: {
      const Input part(input.begin() + at, input.begin() + at + length);
      input.insert(input.begin() + at, part.begin(), part.end());
      break;
    }
    case 4:
      if (!other.empty()) {
        const std::ptrdiff_t from = pick(other.size());
        const std::ptrdiff_t end = std::min<std::ptrdiff_t>(from + 1 + pick(64), std::ssize(other));
        input.insert(input.begin() + at, other.begin() + from, other.begin() + end);
      }
      break;
    default:
      input.resize(static_cast<std::size_t>(at));
  }
}

const Input* running = nullptr;

/// A crash leaves its input in a file.
extern "C" void keep_input(int signal) {
  const std::string name = "crash-" + std::to_string(::getpid());
  const int file = ::open(name.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
  if (running != nullptr && file >= 0 && ::write(file, running->data(), running->size()) >= 0) {
    [[maybe_unused]] const auto told = ::write(STDERR_FILENO, (name + "\n").c_str(), name.size() + 1);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(const Input& input) {
  running = &input;
  static_cast<void>(LLVMFuzzerTestOneInput(input.data(), input.size()));
  running = nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  unsigned long changes = 0, seed = 1;
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--changes" && i + 1 < argc) {
      changes = std::strtoul(argv[++i], nullptr, 10);
    } else if (std::string_view(argv[i]) == "--seed" && i + 1 < argc) {
      seed = std::strtoul(argv[++i], nullptr, 10);
    } else if (std::filesystem::is_directory(argv[i])) {
      for (const auto& entry : std::filesystem::directory_iterator(argv[i])) files.push_back(entry.path());
    } else {
      files.emplace_back(argv[i]);
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<Input> inputs;
  for (const auto& file : files) inputs.push_back(read(file));
  if (inputs.empty()) {
    std::cerr << "replay: no input\n";
    return 1;
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS}) std::signal(signal, keep_input);
  for (const Input& input : inputs) run(input);
  std::mt19937_64 random(seed);
  for (unsigned long i = 0; i < changes; ++i) {
    Input input = inputs[random() % inputs.size()];
    for (std::uint64_t n = 1 + random() % 4; n > 0; --n) change(input, inputs[random() % inputs.size()], random);
    if (input.size() > 4096) input.resize(4096);
    run(input);
  }
  std::cout << inputs.size() << " inputs, " << changes << " changes of them\n";
  return 0;
}
