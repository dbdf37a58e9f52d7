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

/// Empty fields do not apply to the line.
struct Row {
  std::string experiment, distribution;
  std::optional<std::uint64_t> points;
  std::string who, backend, device;
  std::optional<std::uint64_t> threads, block;
  std::string stabilize;
  std::optional<std::uint64_t> threshold;
  std::optional<double> epsilon;
  std::string detail;
  std::optional<std::uint64_t> warmups, runs;
  std::optional<double> median_ms, min_ms, max_ms;  ///< whole calls: points on the host to triangles on the host
  std::optional<double> device_ms;                  ///< median without "upload" and "copy"
  std::optional<std::uint64_t> triangles;
  std::string hash;
  std::optional<double> occupancy;
  std::optional<std::uint64_t> differing_triangles;
  std::optional<Statistics> statistics;                ///< of the last run
  std::vector<std::pair<std::string, double>> phases;  ///< median of each, in order of execution
  std::string skipped;                                 ///< why there are no numbers
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
