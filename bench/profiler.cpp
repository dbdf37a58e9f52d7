// SPDX-License-Identifier: Apache-2.0
#include "bench/profiler.hpp"

#include "bench/child.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace cadt::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* duration = "gpu__time_duration.sum";
constexpr const char* issue_active = "smsp__issue_active.avg.pct_of_peak_sustained_active";
constexpr const char* dram_throughput = "dram__throughput.avg.pct_of_peak_sustained_elapsed";
constexpr const char* dram_bytes = "dram__bytes.sum";
constexpr std::array<std::pair<const char*, double>, 6> operations = {{
    {"smsp__sass_thread_inst_executed_op_dadd_pred_on.sum", 1},
    {"smsp__sass_thread_inst_executed_op_dmul_pred_on.sum", 1},
    {"smsp__sass_thread_inst_executed_op_dfma_pred_on.sum", 2},
    {"smsp__sass_thread_inst_executed_op_fadd_pred_on.sum", 1},
    {"smsp__sass_thread_inst_executed_op_fmul_pred_on.sum", 1},
    {"smsp__sass_thread_inst_executed_op_ffma_pred_on.sum", 2},
}};

std::string metrics() {
  std::string all;
  for (const char* name : {duration, issue_active, dram_throughput, dram_bytes}) all += std::string(name) + ',';
  for (const auto& [name, weight] : operations) all += std::string(name) + ',';
  all.pop_back();
  return all;
}

/// The fields of a line of CSV.
std::vector<std::string> fields(std::string_view line) {
  std::vector<std::string> result(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      result.back() += line[++i];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      result.emplace_back();
    } else if (line[i] != '\r') {
      result.back() += line[i];
    }
  }
  return result;
}

/// "1,234.5" is a number too.
std::optional<double> number(std::string text) {
  std::erase(text, ',');
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

/// The name that the library has for a kernel.
std::string known_as(const std::string& kernel) {
  if (kernel.find("RadixSort") != std::string::npos) return "sort";
  if (kernel.find("DeviceScan") != std::string::npos) return "scan";
  const std::size_t begin = kernel.find("cadt_");  // a namespace may come before it, parameters after it
  if (begin == std::string::npos) return kernel;
  const auto is_of_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  const auto first = kernel.begin() + static_cast<std::ptrdiff_t>(begin);
  return {first, std::find_if_not(first, kernel.end(), is_of_name)};
}

/// The profiler's own word for what went wrong.
std::string complaint(std::string_view text) {
  std::string found;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t at = line.find("==ERROR== "); found.empty() && at != std::string::npos)
      found = line.substr(at + 10);
  return found;
}

}  // namespace

Profile read_profile(std::string_view text) {
  Profile result;
  std::istringstream lines{std::string(text)};
  std::vector<std::string> header;
  for (std::string line; std::getline(lines, line);) {
    if (header.empty()) {  // what comes before it is the profiler's and the program's talk
      if (line.starts_with("\"ID\"")) header = fields(line);
      continue;
    }
    const std::vector<std::string> row = fields(line);
    if (row.size() != header.size() || !number(row[0])) continue;  // the line of units
    const auto cell = [&](std::string_view column) -> std::optional<double> {
      const auto at = std::ranges::find(header, column) - header.begin();
      return at == std::ssize(header) ? std::nullopt : number(row[static_cast<std::size_t>(at)]);
    };
    const auto name = std::ranges::find(header, "Kernel Name") - header.begin();
    const auto time = cell(duration);
    if (name == std::ssize(header) || !time) continue;
    Profiled& sum = result.kernels[known_as(row[static_cast<std::size_t>(name)])];
    sum.nanoseconds += *time;
    sum.issue_active += *time * cell(issue_active).value_or(0);
    sum.dram_throughput += *time * cell(dram_throughput).value_or(0);
    sum.dram_bytes += cell(dram_bytes).value_or(0);
    for (const auto& [metric, weight] : operations) sum.operations += weight * cell(metric).value_or(0);
  }
  for (auto& [kernel, sum] : result.kernels) {
    if (sum.nanoseconds <= 0) continue;
    sum.issue_active /= sum.nanoseconds;
    sum.dram_throughput /= sum.nanoseconds;
  }
  if (result.kernels.empty()) {
    result.failure = complaint(text);
    result.failure = result.failure.empty() ? "ncu wrote no kernels" : "ncu: " + result.failure;
  }
  return result;
}

Profile profile(const std::vector<std::string>& command, double timeout_seconds) {
  std::error_code error;
  fs::path folder = fs::temp_directory_path(error);
  if (error) folder = "/tmp";
  const fs::path log = folder / ("cadt-ncu-" + std::to_string(::getpid()) + ".csv");
  std::vector<std::string> whole = {"ncu",  "--csv",      "--page",     "raw",       "--print-units",
                                    "base", "--log-file", log.string(), "--metrics", metrics()};
  whole.insert(whole.end(), command.begin(), command.end());
  const ChildResult child = run_child(whole, timeout_seconds);
  std::string text;
  {
    std::ifstream file(log);
    text.assign(std::istreambuf_iterator<char>(file), {});
  }
  fs::remove(log, error);
  if (!child.failure.empty()) return {{}, "ncu: " + child.failure};
  Profile result = read_profile(text);
  if (child.status != 0) {
    const std::string why = complaint(text + '\n' + child.output + '\n' + child.errors);
    result = {{}, "ncu: " + (why.empty() ? "exit code " + std::to_string(child.status) : why)};
  }
  return result;
}

}  // namespace cadt::bench
