// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/binary_cache.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

namespace cadt::opencl {
namespace {

namespace fs = std::filesystem;

// The digit is the version of the layout below.
constexpr std::array<char, 8> magic = {'c', 'a', 'd', 't', 'c', 'l', 'b', '1'};
// A length field beyond this is damage, not a program.
constexpr std::uint64_t largest_binary = std::uint64_t{1} << 30;

struct Header {
  std::array<char, 8> magic;
  Digest key;       // the file name says the same, but a file may be renamed
  Digest checksum;  // of the bytes that follow
  std::uint64_t length;
};
static_assert(sizeof(Header) == 48, "written as it lies in memory, so it must not be padded");

// Bijective: odd factors carry each bit up, the shifts bring the upper half down again. All constants are digits of pi.
std::uint64_t scramble(std::uint64_t x) noexcept {
  x *= 0xA4093822299F31D1u;
  x ^= x >> 32;
  x *= 0xBE5466CF34E90C6Du;
  x ^= x >> 29;
  x *= 0xC0AC29B7C97C50DDu;
  return x ^ (x >> 32);
}

class Hasher {
 public:
  void add(std::span<const unsigned char> bytes) noexcept {
    word(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
      std::uint64_t value = 0;
      std::memcpy(&value, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
      word(value);
    }
  }
  [[nodiscard]] Digest value() const noexcept {
    return {scramble(high_ + low_), scramble(low_ ^ std::rotl(high_, 32))};
  }

 private:
  void word(std::uint64_t value) noexcept {
    low_ = scramble(low_ ^ value);
    high_ = scramble(high_ + value * 0x082EFA98EC4E6C89u + std::rotl(low_, 19));
  }
  std::uint64_t high_ = 0x243F6A8885A308D3u, low_ = 0x13198A2E03707344u;
};

std::span<const unsigned char> bytes_of(const std::string& text) noexcept {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

}  // namespace

std::string Digest::hex() const {
  std::array<char, 33> text{};
  std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(high),
                static_cast<unsigned long long>(low));
  return text.data();
}

Digest digest_of(std::span<const std::string> texts) {
  Hasher hasher;
  for (const std::string& text : texts) hasher.add(bytes_of(text));
  return hasher.value();
}

Digest digest_of(std::span<const unsigned char> bytes) {
  Hasher hasher;
  hasher.add(bytes);
  return hasher.value();
}

fs::path cache_directory() {
  if (const char* own = std::getenv("CADT_CACHE_DIR")) return own;
#if defined(_WIN32)
  const char* local = std::getenv("LOCALAPPDATA");
  return local != nullptr && *local != '\0' ? fs::path(local) / "cadt" / "cache" : fs::path();
#else
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg != nullptr && *xdg == '/')
    return fs::path(xdg) / "cadt";  // relative paths are ignored (XDG base directory specification)
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return fs::path(home) / ".cache" / "cadt";
  return {};
#endif
}

fs::path cache_file(const fs::path& directory, Digest key) { return directory / (key.hex() + ".clbin"); }

std::optional<std::vector<unsigned char>> load_binary(const fs::path& directory, Digest key) try {
  if (directory.empty()) return std::nullopt;
  std::ifstream file(cache_file(directory, key), std::ios::binary);
  Header header{};
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
  if (header.magic != magic || header.key != key || header.length > largest_binary) return std::nullopt;
  std::vector<unsigned char> binary(header.length);
  if (!file.read(reinterpret_cast<char*>(binary.data()), static_cast<std::streamsize>(binary.size())))
    return std::nullopt;
  if (file.peek() != std::ifstream::traits_type::eof()) return std::nullopt;
  if (digest_of(std::span<const unsigned char>(binary)) != header.checksum) return std::nullopt;
  return binary;
} catch (...) {
  return std::nullopt;
}

bool store_binary(const fs::path& directory, Digest key, std::span<const unsigned char> binary) noexcept try {
  if (directory.empty() || binary.empty() || binary.size() > largest_binary) return false;
  std::error_code error;
  fs::create_directories(directory, error);
  // In the same directory, since a rename is atomic only within a file system; under a unique name, since several
  // processes may store the same program at once.
  std::random_device random;
  const fs::path target = cache_file(directory, key);
  fs::path temporary = target;
  for (int i = 0; i < 4; ++i) temporary += '.' + std::to_string(random());
  temporary += ".tmp";
  const Header header{magic, key, digest_of(binary), binary.size()};
  {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file.write(reinterpret_cast<const char*>(binary.data()), static_cast<std::streamsize>(binary.size()));
    file.close();
    error = file ? std::error_code() : std::make_error_code(std::errc::io_error);
  }
  if (!error) fs::rename(temporary, target, error);
  if (!error) return true;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  return false;
} catch (...) {
  return false;
}

}  // namespace cadt::opencl
