// SPDX-License-Identifier: Apache-2.0
#include "tests/robustness/fuzz/mesh_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include <cadt/cadt.hpp>

#include "tests/robustness/fuzz/fuzz.hpp"

namespace cadt::fuzz {
namespace {

Triangulator& triangulator(unsigned threads, unsigned grain) {
  Options options;
  options.backend = Backend::host;
  options.threads = threads;
  options.tuning.grain = grain;
  static auto* const serial = new Triangulator([&] {
    Options one = options;
    one.threads = 1, one.tuning.grain = 0;
    return one;
  }());
  if (threads == 1) return *serial;
  static auto* const parallel = new Triangulator(options);
  return *parallel;
}

Counter& meshes() {
  static Counter counter("meshes");
  return counter;
}

Triangulation by(Strategy strategy, std::span<const double> xy, unsigned threads = 1) {
  Triangulator& t = triangulator(threads, 1);
  t.options().tuning.strategy = strategy;
  meshes() += 1;
  return t.triangulate(PointsView(xy));
}

TriangulationBatch wrapped(std::span<const double> xy) {
  Triangulator& t = triangulator(1, 0);
  t.options().tuning.strategy = Strategy::automatic;
  const std::array<std::size_t, 4> offsets = {0, 0, xy.size() / 4, xy.size() / 2};
  meshes() += 2;
  return t.triangulate_batch(PointsView(xy), offsets);
}

void must_name(std::size_t bad, const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    if (error.index() != bad) fail("point " + std::to_string(error.index()) + " is named, not " + std::to_string(bad));
    return;
  }
  fail("a coordinate that is no finite number is taken");
}

using Triple = std::array<std::int32_t, 3>;

/// Triangles with the smallest vertex first, ascending; `names` renames the vertices.
std::vector<Triple> sorted_triangles(const Triangulation& mesh, const std::vector<std::int32_t>& names) {
  std::vector<Triple> triples;
  for (std::size_t t = 0; t < mesh.number_of_triangles(); ++t) {
    Triple v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = names[static_cast<std::size_t>(mesh.triangles()[3 * t + k])];
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    triples.push_back(v);
  }
  std::sort(triples.begin(), triples.end());
  return triples;
}

}  // namespace

void check_mesh(std::span<const double> xy, bool with_threads) {
  const auto bad = std::find_if(xy.begin(), xy.end(), [](double v) { return !std::isfinite(v); });
  if (bad != xy.end()) {
    const auto index = static_cast<std::size_t>(bad - xy.begin()) / 2;
    must_name(index, [&] { static_cast<void>(by(Strategy::locks, xy)); });
    must_name(index, [&] { static_cast<void>(by(Strategy::stars, xy)); });
    must_name(index, [&] { static_cast<void>(wrapped(xy)); });
    return;
  }
  const Triangulation mesh = by(Strategy::locks, xy);
  VerifyOptions options;
  options.threads = 1;
  const VerifyReport report = verify(PointsView(xy), mesh, options);
  if (!report.ok) fail("insertion: " + report.summary());
  if (by(Strategy::stars, xy).hash() != mesh.hash()) fail("stars and insertion differ");
  const TriangulationBatch batch = wrapped(xy);
  const std::size_t cut = xy.size() / 4;
  for (const std::size_t set : {std::size_t{1}, std::size_t{2}}) {
    const auto part = set == 1 ? xy.first(2 * cut) : xy.subspan(2 * cut);
    if (batch.triangulation(set).hash() != by(Strategy::locks, part).hash()) fail("a set of several and alone differ");
  }
  if (with_threads && by(Strategy::locks, xy, 3).hash() != mesh.hash()) fail("three threads and one differ");
}

void check_order(std::span<const double> xy, std::span<const std::uint32_t> order) {
  const std::size_t n = order.size();
  std::vector<double> moved(2 * n);
  std::vector<std::int32_t> same(n), names(n);
  for (std::size_t i = 0; i < n; ++i) {
    moved[2 * order[i]] = xy[2 * i];
    moved[2 * order[i] + 1] = xy[2 * i + 1];
    names[order[i]] = same[i] = static_cast<std::int32_t>(i);
  }
  // Points are sorted before anything else, so in one strategy their order would hardly matter.
  const Triangulation mesh = by(Strategy::locks, xy), other = by(Strategy::stars, moved);
  // Equal points are one vertex, whoever stands for them.
  for (const Duplicate& d : mesh.duplicates()) same[static_cast<std::size_t>(d.point)] = d.representative;
  for (std::int32_t& name : names) name = same[static_cast<std::size_t>(name)];
  if (sorted_triangles(mesh, same) != sorted_triangles(other, names)) fail("the order of the points changes the mesh");
  if (mesh.duplicates().size() != other.duplicates().size()) fail("the order of the points changes the duplicates");
}

}  // namespace cadt::fuzz
