// SPDX-License-Identifier: Apache-2.0
#include "common/platform/machine.hpp"

#include <array>
#include <cstddef>
#include <fstream>

#if defined(_WIN32)
#include <windows.h>
#elif defined(__APPLE__)
#include <sys/sysctl.h>
#else
#include <unistd.h>
#endif

namespace cadt::platform {

#if defined(_WIN32)

std::string processor_name() {
  std::array<char, 256> text{};
  auto bytes = static_cast<DWORD>(text.size());
  const LSTATUS status = ::RegGetValueA(HKEY_LOCAL_MACHINE, R"(HARDWARE\DESCRIPTION\System\CentralProcessor\0)",
                                        "ProcessorNameString", RRF_RT_REG_SZ, nullptr, text.data(), &bytes);
  return status == ERROR_SUCCESS ? text.data() : "";
}

std::uint64_t memory_bytes() noexcept {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  return ::GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : 0;
}

#elif defined(__APPLE__)

std::string processor_name() {
  std::array<char, 256> text{};
  std::size_t bytes = text.size() - 1;
  return ::sysctlbyname("machdep.cpu.brand_string", text.data(), &bytes, nullptr, 0) == 0 ? text.data() : "";
}

std::uint64_t memory_bytes() noexcept {
  std::uint64_t value = 0;
  std::size_t bytes = sizeof value;
  return ::sysctlbyname("hw.memsize", &value, &bytes, nullptr, 0) == 0 ? value : 0;
}

#else

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) {
      const auto colon = line.find(':');
      if (colon != std::string::npos && colon + 2 <= line.size()) return line.substr(colon + 2);
    }
  }
  return {};
}

std::uint64_t memory_bytes() noexcept {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 0;
}

#endif

}  // namespace cadt::platform
