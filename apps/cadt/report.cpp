// SPDX-License-Identifier: Apache-2.0
#include "report.hpp"

#include "text.hpp"

#include <cadt/version.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace cadt::cli {
namespace {

using Json = nlohmann::ordered_json;

double total_seconds(const RunReport& r) {
  return r.read_seconds + r.triangulate_seconds + r.verify_seconds + r.write_seconds;
}

std::string back_end(const Statistics& s) {
  std::string text = s.backend;
  if (!s.device.empty()) text += fmt::format(", {}", s.device);
  if (s.threads > 0) text += fmt::format(", {} {}", s.threads, s.backend == "host" ? "threads" : "compute units");
  return text;
}

double total_milliseconds(const std::vector<KernelTime>& kernels) {
  double sum = 0;
  for (const KernelTime& kernel : kernels) sum += kernel.milliseconds;
  return sum;
}

std::string kernels_text(const std::vector<KernelTime>& kernels) {
  std::vector<std::vector<std::string>> rows = {{"kernel", "launches", "milliseconds", "share"}};
  const double sum = total_milliseconds(kernels);
  for (const KernelTime& kernel : kernels)
    rows.push_back({kernel.name, std::to_string(kernel.launches), fmt::format("{:.3f}", kernel.milliseconds),
                    fmt::format("{:.1f} %", sum > 0 ? 100 * kernel.milliseconds / sum : 0)});
  return table(rows);
}

Json kernels_json(const std::vector<KernelTime>& kernels) {
  Json json = Json::array();
  const double sum = total_milliseconds(kernels);
  for (const KernelTime& kernel : kernels)
    json.push_back({{"name", kernel.name},
                    {"launches", kernel.launches},
                    {"milliseconds", kernel.milliseconds},
                    {"share", sum > 0 ? kernel.milliseconds / sum : 0}});
  return json;
}

Json verification_json(const VerifyReport& report) {
  Json checks = Json::array();
  for (const Check& check : report.checks) {
    checks.push_back(Json{{"name", check.name},
                          {"passed", check.passed},
                          {"failures", check.failures},
                          {"first", check.first},
                          {"what", check.what}});
  }
  return Json{{"ok", report.ok},
              {"edges_examined", report.edges_examined},
              {"ties", report.ties},
              {"unusual_ties", report.unusual_ties},
              {"checks", std::move(checks)}};
}

std::string constraints_text(const RunReport& r) {
  const ConstrainedTriangulation& mesh = *r.constrained;
  std::string segments = fmt::format("{}, which are {} edges", r.segments, mesh.constrained_edges().size());
  if (const std::size_t added = mesh.added_points().size() / 2; added != 0) {
    segments += fmt::format(", with {} points added where they cross", added);
  }
  std::string text = key_line("segments", segments);
  if (r.domain != "hull") text += key_line("inside", fmt::format("{} triangles ({})", mesh.number_inside(), r.domain));
  return text + key_line("regions", std::to_string(mesh.number_of_regions()));
}

Json constraints_json(const RunReport& r) {
  const ConstrainedTriangulation& mesh = *r.constrained;
  return Json{{"segments", r.segments},
              {"degenerate", mesh.degenerate_segments().size()},
              {"edges", mesh.constrained_edges().size()},
              {"added_points", mesh.added_points().size() / 2},
              {"rounded_valid", mesh.rounded_valid()},
              {"crossing", r.crossing},
              {"domain", r.domain},
              {"inside", mesh.number_inside()},
              {"regions", mesh.number_of_regions()}};
}

}  // namespace

std::string summary_text(const RunReport& r) {
  const Triangulation& mesh = *r.mesh;
  const double seconds = r.triangulate_seconds;
  std::string text;
  text += key_line("points", std::to_string(mesh.number_of_points()));
  text += key_line("duplicates", std::to_string(mesh.duplicates().size()));
  text += key_line("triangles", std::to_string(mesh.number_of_triangles()));
  text += key_line("hull", std::to_string(mesh.hull().size()));
  if (r.constrained != nullptr) text += constraints_text(r);
  std::string parts = fmt::format("read {:.3f}, triangulate {:.3f}", r.read_seconds, seconds);
  if (r.verification) parts += fmt::format(", verify {:.3f}", r.verify_seconds);
  if (!r.outputs.empty()) parts += fmt::format(", write {:.3f}", r.write_seconds);
  text += key_line("time", fmt::format("{:.3f} s ({})", total_seconds(r), parts));
  text += key_line("back end", back_end(mesh.statistics()));
  text += key_line("hash", r.hash);
  if (r.differing) {
    const double percent = 100.0 * static_cast<double>(*r.differing) /
                           static_cast<double>(std::max<std::size_t>(mesh.number_of_triangles(), 1));
    text +=
        key_line("not exact", fmt::format("{} edges left illegal, {} triangles ({:.4f} %) differ from the exact mesh",
                                          mesh.statistics().illegal_edges, *r.differing, percent));
  }
  if (r.verification) text += key_line("verified", r.verification->summary());
  return text;
}

std::string statistics_text(const RunReport& r) {
  const Statistics& s = r.mesh->statistics();
  std::vector<std::vector<std::string>> rows = {{"counter", "value", "per point"}};
  const double points = static_cast<double>(s.distinct == 0 ? 1 : s.distinct);
  for (const NamedCounter& counter : counters_of_work) {
    const std::uint64_t value = s.*counter.value;
    rows.push_back({counter.name, std::to_string(value), fmt::format("{:.3f}", static_cast<double>(value) / points)});
  }
  rows.push_back({"bytes_device_peak", std::to_string(s.bytes_device_peak), human_bytes(s.bytes_device_peak)});
  rows.push_back({"bytes_to_device", std::to_string(s.bytes_to_device), human_bytes(s.bytes_to_device)});
  rows.push_back({"bytes_from_device", std::to_string(s.bytes_from_device), human_bytes(s.bytes_from_device)});
  rows.push_back({"wide_arithmetic", s.wide_arithmetic ? "yes" : "no", ""});
  std::vector<std::vector<std::string>> phases = {{"phase", "milliseconds"}};
  for (const auto& [name, ms] : s.milliseconds) phases.push_back({name, fmt::format("{:.3f}", ms)});
  std::string text = table(rows) + '\n' + table(phases);
  std::vector<std::vector<std::string>> flips = {{"flips", "edges", "share"}};
  const double edges =
      static_cast<double>(std::accumulate(s.flips_per_edge.begin(), s.flips_per_edge.end(), std::uint64_t{0}));
  for (std::size_t k = 0; k < s.flips_per_edge.size(); ++k) {
    const std::uint64_t count = s.flips_per_edge[k];
    if (count != 0) {
      flips.push_back({std::to_string(k) + (k + 1 == s.flips_per_edge.size() ? "+" : ""), std::to_string(count),
                       fmt::format("{:.3f} %", 100 * static_cast<double>(count) / edges)});
    }
  }
  if (edges > 0) text += '\n' + table(flips);
  if (!s.thread_time.empty()) {
    std::vector<std::vector<std::string>> shares = {{"threads' time", "share"}};
    for (const auto& [name, share] : s.thread_time) shares.push_back({name, fmt::format("{:.1f} %", 100 * share)});
    text += '\n' + table(shares);
  }
  if (!s.kernels.empty()) text += '\n' + kernels_text(s.kernels);
  return text;
}

std::string statistics_json(const RunReport& r) {
  const Triangulation& mesh = *r.mesh;
  const Statistics& s = mesh.statistics();
  Json json;
  json["schema"] = 2;
  json["cadt"] = CADT_VERSION;
  json["input"] = {{"file", r.input}, {"format", r.input_format}, {"heights", r.heights}};
  json["mesh"] = {{"points", mesh.number_of_points()},
                  {"distinct", mesh.number_of_points() - mesh.duplicates().size()},
                  {"duplicates", mesh.duplicates().size()},
                  {"triangles", mesh.number_of_triangles()},
                  {"hull", mesh.hull().size()},
                  {"dimension", mesh.dimension()},
                  {"hash", r.hash}};
  json["constraints"] = r.constrained != nullptr ? constraints_json(r) : Json(nullptr);
  json["backend"] = s.backend;
  json["device"] = s.device;
  json["threads"] = s.threads;
  json["seconds"] = {{"read", r.read_seconds},
                     {"triangulate", r.triangulate_seconds},
                     {"verify", r.verify_seconds},
                     {"write", r.write_seconds},
                     {"total", total_seconds(r)}};
  json["phases"] = Json::array();
  for (const auto& [name, ms] : s.milliseconds) json["phases"].push_back({{"name", name}, {"milliseconds", ms}});
  json["counters"] = Json::object();
  for (const NamedCounter& counter : counters_of_work) json["counters"][counter.name] = s.*counter.value;
  json["flips_per_edge"] = s.flips_per_edge;
  json["thread_time"] = Json::object();
  for (const auto& [name, share] : s.thread_time) json["thread_time"][name] = share;
  json["kernels"] = kernels_json(s.kernels);
  json["stabilize"] = {{"mode", r.stabilize}, {"flip_threshold", r.flip_threshold}, {"epsilon", r.epsilon}};
  json["certified"] = s.certified;
  json["differing_triangles"] = r.differing ? Json(*r.differing) : s.certified ? Json(0) : Json(nullptr);
  json["bytes_device_peak"] = s.bytes_device_peak;
  json["bytes_to_device"] = s.bytes_to_device;
  json["bytes_from_device"] = s.bytes_from_device;
  json["wide_arithmetic"] = s.wide_arithmetic;
  json["verification"] = r.verification ? verification_json(*r.verification) : Json(nullptr);
  json["outputs"] = Json::array();
  for (const Output& output : r.outputs) json["outputs"].push_back({{"file", output.path}, {"format", output.format}});
  // Names of files and devices need not be UTF-8; JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace cadt::cli
