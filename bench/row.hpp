// SPDX-License-Identifier: Apache-2.0
// A line of a result file. One table of columns makes the CSV and the JSON, so that they cannot differ.
#pragma once

#include <cadt/statistics.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cadt::bench {

/// What a line about one kernel has besides those of the run.
struct KernelCells {
  std::string name;
  std::uint64_t launches = 0;
  double milliseconds = 0, share = 0;  ///< median of the runs; of the sum of all kernels
  std::optional<std::uint64_t> bytes;  ///< that it must move at least (kernel_bytes.hpp)
  double peak = 0;                     ///< GB/s of a copy on the same device
  std::optional<double> issue_active, dram_throughput, dram_bytes, operations;  ///< profiler.hpp
  std::string profiler;  ///< whose they are, or why there are none
  /// GB/s of the bytes that it must move.
  [[nodiscard]] std::optional<double> bandwidth() const {
    if (!bytes || milliseconds <= 0) return std::nullopt;
    return 1e-6 * static_cast<double>(*bytes) / milliseconds;
  }
};

/// Empty fields do not apply to the line.
struct Row {
  std::string experiment, distribution;
  std::optional<std::uint64_t> points;
  std::string who, backend, device;
  std::optional<std::uint64_t> threads, block;
  std::string stabilize;
  std::optional<std::uint64_t> threshold;
  std::optional<double> epsilon;
  std::string detail, strategy;
  std::optional<std::uint64_t> warmups, runs;
  std::optional<double> median_ms, min_ms, max_ms;  ///< whole calls: points on the host to triangles on the host
  std::optional<double> device_ms;                  ///< median without "upload" and "copy"
  std::optional<std::uint64_t> triangles;
  std::string hash;
  std::optional<double> occupancy;
  std::optional<std::uint64_t> differing_triangles;
  std::optional<Statistics> statistics;                ///< of the last run
  std::vector<std::pair<std::string, double>> phases;  ///< median of each, in order of execution
  std::vector<KernelTime> kernels;                     ///< median of each; no column
  std::optional<KernelCells> kernel;
  std::string skipped;  ///< why there are no numbers
};

/// The names of the columns, comma-separated.
[[nodiscard]] std::string csv_header();
/// Header and rows as RFC 4180 has it, but with plain line feeds.
[[nodiscard]] std::string csv(const std::vector<Row>& rows);
/// An array of objects; what does not apply is null.
[[nodiscard]] std::string json(const std::vector<Row>& rows);

/// Median; the mean of the two middle ones if they are even in number. Not empty.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace cadt::bench
