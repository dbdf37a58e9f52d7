// SPDX-License-Identifier: Apache-2.0
#include "common/host/wrap_mesh.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "common/host/device_constants.hpp"

namespace cadt {
namespace {

using namespace device_constants;

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr std::uint32_t lanes_of_vertex = 32;
constexpr std::size_t boxes_of_vertex =
    96;  // looked at on average at most; what stars leave of 1M uniform points needs 14

}  // namespace

std::size_t most_wrapped(const Device& device) noexcept { return device.shape().contiguous ? 2048 : 32768; }

std::optional<DeviceMesh> wrap_mesh(Run& run, const Allocation& points, std::size_t n) {
  if (n < 3) return std::nullopt;
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const std::size_t records = 2 * n - 2, link_words = 3 * records;  // ghosts have no star
  const auto box_count = (count - 1) / CADT_WRAP_BOX + 1, crate_count = (box_count - 1) / CADT_WRAP_CRATE + 1;
  const Allocation boxes = run.memory.allocate(box_count * sizeof(cadt_box));
  const Allocation crates = run.memory.allocate(crate_count * sizeof(cadt_box));
  const Allocation links = run.memory.allocate(link_words * word), begins = run.memory.allocate(n * word);
  const Allocation sizes = run.memory.allocate_zeros(n * word), found = launch.zeros(6);
  const Cut of_crates = launch.cut_teams(crate_count, lanes_of_vertex), teams = launch.cut_teams(n, lanes_of_vertex),
            all = launch.cut(n);
  launch.run_in_groups(KernelId::cadt_wrap_boxes, of_crates.items, lanes_of_vertex, points, count, box_count,
                       crate_count, of_crates.grain, boxes, crates);
  const auto effort = static_cast<std::uint32_t>(boxes_of_vertex * n + 4096);
  launch.run_in_groups(KernelId::cadt_wrap_stars, teams.items, lanes_of_vertex, points, boxes, crates, count, box_count,
                       crate_count, effort, teams.grain, links, static_cast<std::uint32_t>(link_words), begins, sizes,
                       found);
  // Vertices without a star have size 0, so this may run before it is known whether there are any.
  const Allocation bases = run.memory.allocate((n + 1) * word);
  launch.run(KernelId::cadt_wrap_counts, all.items, links, begins, sizes, count, all.grain, bases);
  launch.scan(bases, n + 1);
  std::array<std::uint32_t, 6> words{};
  run.device.read(*found, 0, words.data(), sizeof words);
  run.statistics.exact_orientations += words[3];
  run.statistics.exact_incircles += words[4];
  run.statistics.ties += words[5];
  if (words[1] != 0) return std::nullopt;
  if (const std::uint32_t triangles = launch.read_word(bases, n); triangles != records || words[0] > link_words)
    throw InternalError("the wrapped stars have " + std::to_string(triangles) + " triangles instead of " +
                        std::to_string(records) + "; please report this with the input");
  run.statistics.wrapped_stars = n;
  DeviceMesh mesh;
  mesh.slots = 2 * n;
  mesh.records = run.memory.allocate(mesh.slots * sizeof(cadt_record));
  run.device.fill(*mesh.records, records * sizeof(cadt_record), (mesh.slots - records) * sizeof(cadt_record), 0);
  const Cut shares = launch.cut(n * CADT_WRAP_SHARES);
  launch.run(KernelId::cadt_wrap_records, shares.items, links, begins, sizes, bases, count, shares.grain, mesh.records);
  run.end_phase("wrap");
  return mesh;
}

}  // namespace cadt
