// SPDX-License-Identifier: Apache-2.0
#include "bench/row.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <variant>

namespace cadt::bench {
namespace {

using Cell = std::variant<std::monostate, std::string, std::uint64_t, double, bool>;

Cell cell(const std::string& text) { return text.empty() ? Cell() : Cell(text); }
template <class T>
Cell cell(const std::optional<T>& value) {
  return value ? Cell(*value) : Cell();
}

std::string list(const std::vector<std::pair<std::string, double>>& values, int digits) {
  std::string text;
  for (const auto& [name, value] : values)
    text += fmt::format("{}{}={:.{}f}", text.empty() ? "" : ";", name, value, digits);
  return text;
}

struct Column {
  std::string name;
  std::function<Cell(const Row&)> get;
};

// Without counters only sizes, launches and legality sweeps are known; zeros would look like counts.
enum class Counted { always, in_detail };

template <class Get>
Column of_kernel(const char* name, const Get& get) {
  return {name, [get](const Row& row) -> Cell { return row.kernel ? cell(get(*row.kernel)) : Cell(); }};
}

Column counter(const char* name, std::uint64_t Statistics::*member, Counted counted = Counted::in_detail) {
  return {name, [member, counted](const Row& row) -> Cell {
            if (!row.statistics || (counted == Counted::in_detail && row.detail == "none")) return {};
            return (*row.statistics).*member;
          }};
}

std::vector<Column> make_columns() {
  using S = Statistics;
  constexpr Counted always = Counted::always;
  std::vector<Column> columns = {
      {"experiment", [](const Row& r) { return cell(r.experiment); }},
      {"distribution", [](const Row& r) { return cell(r.distribution); }},
      {"points", [](const Row& r) { return cell(r.points); }},
      {"who", [](const Row& r) { return cell(r.who); }},
      {"backend", [](const Row& r) { return cell(r.backend); }},
      {"device", [](const Row& r) { return cell(r.device); }},
      {"threads", [](const Row& r) { return cell(r.threads); }},
      {"block", [](const Row& r) { return cell(r.block); }},
      {"stabilize", [](const Row& r) { return cell(r.stabilize); }},
      {"threshold", [](const Row& r) { return cell(r.threshold); }},
      {"epsilon", [](const Row& r) { return cell(r.epsilon); }},
      {"detail", [](const Row& r) { return cell(r.detail); }},
      {"strategy", [](const Row& r) { return cell(r.strategy); }},
      {"warmups", [](const Row& r) { return cell(r.warmups); }},
      {"runs", [](const Row& r) { return cell(r.runs); }},
      {"median_ms", [](const Row& r) { return cell(r.median_ms); }},
      {"min_ms", [](const Row& r) { return cell(r.min_ms); }},
      {"max_ms", [](const Row& r) { return cell(r.max_ms); }},
      {"device_ms", [](const Row& r) { return cell(r.device_ms); }},
      {"triangles", [](const Row& r) { return cell(r.triangles); }},
      {"hash", [](const Row& r) { return cell(r.hash); }},
      {"occupancy", [](const Row& r) { return cell(r.occupancy); }},
      {"differing_triangles", [](const Row& r) { return cell(r.differing_triangles); }},
      counter("launches", &S::launches, always),
      counter("walk_steps", &S::walk_steps),
      counter("lock_attempts", &S::lock_attempts),
      counter("lock_failures", &S::lock_failures),
      counter("invalid_restarts", &S::invalid_restarts),
      counter("insert_retries", &S::insert_retries),
      counter("stale_edges", &S::stale_edges),
      counter("deferred_points", &S::deferred_points),
      counter("deferred_edges", &S::deferred_edges),
      counter("splits", &S::splits),
      counter("edge_splits", &S::edge_splits),
      counter("flips", &S::flips),
      counter("incircle_tests", &S::incircle_tests),
      counter("orientation_tests", &S::orientation_tests),
      counter("exact_orientations", &S::exact_orientations),
      counter("exact_incircles", &S::exact_incircles),
      counter("ties", &S::ties),
      counter("legality_sweeps", &S::legality_sweeps, always),
      counter("sweep_repairs", &S::sweep_repairs, always),
      counter("certified_edges", &S::certified_edges, always),
      counter("stabilized_edges", &S::stabilized_edges),
      counter("illegal_edges", &S::illegal_edges, always),
      counter("refined_points", &S::refined_points),
      counter("bytes_device_peak", &S::bytes_device_peak, always),
      {"certified", [](const Row& r) { return r.statistics ? Cell(r.statistics->certified) : Cell(); }},
  };
  for (std::size_t k = 0; k < S().flips_per_edge.size(); ++k) {
    columns.push_back({fmt::format("flips_{}", k), [k](const Row& r) -> Cell {
                         if (!r.statistics || r.detail == "none") return {};
                         return r.statistics->flips_per_edge[k];
                       }});
  }
  columns.push_back({"phases", [](const Row& r) { return cell(list(r.phases, 4)); }});
  columns.push_back(
      {"thread_time", [](const Row& r) { return r.statistics ? cell(list(r.statistics->thread_time, 5)) : Cell(); }});
  using K = KernelCells;
  columns.insert(columns.end(), {of_kernel("kernel", [](const K& k) { return k.name; }),
                                 of_kernel("kernel_launches", [](const K& k) { return std::optional(k.launches); }),
                                 of_kernel("kernel_ms", [](const K& k) { return std::optional(k.milliseconds); }),
                                 of_kernel("kernel_share", [](const K& k) { return std::optional(k.share); }),
                                 of_kernel("kernel_bytes", [](const K& k) { return k.bytes; }),
                                 of_kernel("bandwidth_gbs", [](const K& k) { return k.bandwidth(); }),
                                 of_kernel("copy_gbs", [](const K& k) { return std::optional(k.peak); }),
                                 of_kernel("issue_active", [](const K& k) { return k.issue_active; }),
                                 of_kernel("dram_throughput", [](const K& k) { return k.dram_throughput; }),
                                 of_kernel("dram_bytes", [](const K& k) { return k.dram_bytes; }),
                                 of_kernel("operations", [](const K& k) { return k.operations; }),
                                 of_kernel("profiler", [](const K& k) { return k.profiler; })});
  columns.push_back({"skipped", [](const Row& r) { return cell(r.skipped); }});
  return columns;
}

const std::vector<Column>& columns() {
  static const std::vector<Column> all = make_columns();
  return all;
}

/// Eight digits: nanoseconds are finer than a clock measures.
std::string number(double value) { return fmt::format("{:.8g}", value); }

struct CsvField {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(std::uint64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return number(value); }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& text) const {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
  }
};

using Json = nlohmann::ordered_json;

struct JsonValue {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(double value) const { return std::stod(number(value)); }
  template <class T>
  Json operator()(const T& value) const {
    return value;
  }
};

}  // namespace

std::string csv_header() {
  std::string line;
  for (const Column& column : columns()) line += (line.empty() ? "" : ",") + column.name;
  return line;
}

std::string csv(const std::vector<Row>& rows) {
  std::string text = csv_header() + '\n';
  for (const Row& row : rows) {
    bool first = true;
    for (const Column& column : columns()) {
      if (!first) text += ',';
      first = false;
      text += std::visit(CsvField{}, column.get(row));
    }
    text += '\n';
  }
  return text;
}

std::string json(const std::vector<Row>& rows) {
  Json all = Json::array();
  for (const Row& row : rows) {
    Json entry = Json::object();
    for (const Column& column : columns()) entry[column.name] = std::visit(JsonValue{}, column.get(row));
    all.push_back(std::move(entry));
  }
  // A driver may name its device in any encoding.
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 != 0 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace cadt::bench
