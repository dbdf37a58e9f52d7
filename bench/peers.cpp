// SPDX-License-Identifier: Apache-2.0
#include "bench/peers.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <utility>

#include "bench/child.hpp"

namespace cadt::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int not_usable = 3;

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) last = line;
  return last;
}

/// Why a child gave no proper answer.
std::string what_happened(const ChildResult& child) {
  if (!child.failure.empty()) return child.failure;
  const std::string said = last_line(child.errors);
  if (child.status != 0)
    return (child.status > 128 ? "ended by signal " + std::to_string(child.status - 128)
                               : "ended with " + std::to_string(child.status)) +
           (said.empty() ? "" : ": " + said);
  constexpr std::size_t shown = 80;
  return child.output.empty() ? "it said nothing" : "it said: " + last_line(child.output).substr(0, shown);
}

/// Of any other type than a string: empty.
std::string text_of(const json& answer, const char* key) {
  const auto found = answer.find(key);
  return found != answer.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Parses the peer's answer. \param timed whether there must be times
PeerResult answer_of(const Peer& peer, const std::vector<std::string>& arguments, double timeout, bool timed) {
  PeerResult result;
  result.name = peer.name;
  result.version = peer.version;
  std::vector<std::string> command = peer.command;
  command.insert(command.end(), arguments.begin(), arguments.end());
  const ChildResult child = run_child(command, timeout);
  const json answer = json::parse(child.output, nullptr, false);
  if (!child.failure.empty() || (child.status != 0 && child.status != not_usable) || !answer.is_object()) {
    result.error = what_happened(child);
    result.too_slow = child.too_slow;
    return result;
  }
  result.error = text_of(answer, "error");
  if (const std::string version = text_of(answer, "version"); !version.empty()) result.version = version;
  result.timing = text_of(answer, "timing");
  if (!result.error.empty()) return result;
  if (child.status == not_usable) {
    result.error = "not usable";
    return result;
  }
  if (!timed) return result;
  try {
    result.triangles = answer.at("triangles").get<std::size_t>();
    result.warmups = answer.at("warmups").get<std::size_t>();
    result.milliseconds = answer.at("milliseconds").get<std::vector<double>>();
    if (result.milliseconds.empty()) result.error = "it has no times";
    for (const double time : result.milliseconds)
      if (!(time >= 0.0) || std::isinf(time)) result.error = "a time is not a time";
  } catch (const json::exception& error) {
    result.error = std::string("its answer cannot be read: ") + error.what();
  }
  if (!result.error.empty()) result.milliseconds.clear(), result.triangles = result.warmups = 0;
  return result;
}

/// Asks for the version and sets it, or the reason.
Peer asked(std::string name, std::vector<std::string> command) {
  Peer peer{std::move(name), std::move(command), {}, {}};
  // Importing CuPy from a cold disk takes long.
  constexpr double timeout = 120.0;
  PeerResult answer = answer_of(peer, {"--version"}, timeout, false);
  peer.reason = std::move(answer.error);
  if (peer.usable()) peer.version = std::move(answer.version);
  if (peer.usable() && peer.version.empty()) peer.reason = "it does not tell its version";
  return peer;
}

Peer absent(std::string name, std::string reason) { return {std::move(name), {}, {}, std::move(reason)}; }

/// Every python3 on the path, in its order.
std::vector<fs::path> pythons() {
  std::vector<fs::path> folders, found;
  const char* path = std::getenv("PATH");
  std::istringstream parts(path ? path : "");
  for (std::string part; std::getline(parts, part, ':');) {
    std::error_code ignored;
    // Folders, not programs: an environment's python3 is a link to one that has other modules.
    const fs::path folder = fs::canonical(part, ignored);
    if (ignored || std::find(folders.begin(), folders.end(), folder) != folders.end()) continue;
    folders.push_back(folder);
    if (fs::is_regular_file(folder / "python3", ignored)) found.push_back(folder / "python3");
  }
  return found;
}

Peer find_python_peer(const std::string& name, const fs::path& script) {
  std::error_code ignored;
  if (!fs::is_regular_file(script, ignored)) return absent(name, script.string() + " is not there");
  Peer result = absent(name, "no python3 on the path");
  bool first = true;
  for (const fs::path& python : pythons()) {
    Peer peer = asked(name, {python.string(), script.string(), name});
    if (std::exchange(first, false) || peer.usable()) result = std::move(peer);
    if (result.usable()) break;
  }
  return result;
}

}  // namespace

std::vector<Peer> find_peers(const fs::path& program_folder) {
  std::error_code ignored;
  const fs::path cgal = program_folder / "cadt-peer-cgal", python = program_folder / "cadt-peer-python.py";
  std::vector<Peer> peers;
  peers.push_back(fs::is_regular_file(cgal, ignored) ? asked("cgal", {fs::absolute(cgal).string()})
                                                     : absent("cgal", cgal.string() + " is not there"));
  for (const char* name : {"scipy", "cupy"}) peers.push_back(find_python_peer(name, python));
  return peers;
}

PeerResult run_peer(const Peer& peer, const std::string& points_file, int warm_up, int runs, double limit_seconds) {
  if (!peer.usable()) {
    PeerResult result;
    result.name = peer.name;
    result.version = peer.version;
    result.error = peer.reason;
    return result;
  }
  const std::vector<std::string> arguments = {points_file,          "--warm-up", std::to_string(warm_up),      "--runs",
                                              std::to_string(runs), "--limit",   std::to_string(limit_seconds)};
  return answer_of(peer, arguments, 3.0 * limit_seconds + 30.0, true);
}

}  // namespace cadt::bench
