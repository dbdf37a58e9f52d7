// SPDX-License-Identifier: Apache-2.0
// A report under construction: the checks by name, and which of them are skipped.
#pragma once

#include <cadt/verify.hpp>

#include <array>
#include <initializer_list>
#include <string>
#include <utility>

namespace cadt::verifier {

enum Name : std::size_t {
  counts,
  range,
  neighbors,
  orientations,
  vertices,
  boundary,
  euler,
  hull,
  delaunay,
  ties,
  number_of_checks
};
inline constexpr std::array<const char*, number_of_checks> names{
    "counts", "range", "neighbors", "orientation", "vertices", "boundary", "euler", "hull", "delaunay", "ties"};

/// Dependences between checks: a check whose precondition has failed is skipped and says so.
struct Outcome {
  VerifyReport report;

  explicit Outcome(std::size_t points) {
    report.points = points;
    report.checks.resize(number_of_checks);
    for (std::size_t i = 0; i < number_of_checks; ++i) {
      report.checks[i].name = names[i];
      report.checks[i].what = "not examined";
    }
  }
  Check& begin(Name name) {
    Check& check = report.checks[name];
    check.what.clear();
    return check;
  }
  [[nodiscard]] bool passed(Name name) const { return report.checks[name].passed; }
  void skip(std::initializer_list<Name> skipped, Name because) {
    for (const Name name : skipped)
      report.checks[name].what = std::string("not examined: the check '") + names[because] + "' failed";
  }
  [[nodiscard]] VerifyReport finish() {
    report.ok = true;
    for (const Check& check : report.checks) report.ok = report.ok && check.passed;
    return std::move(report);
  }
};

}  // namespace cadt::verifier
