// SPDX-License-Identifier: Apache-2.0
// Segments from polylines and rings.
#include <cadt/constrained.hpp>

#include <limits>

namespace cadt {
namespace {

/// \throws InputError for the first offset that is not as it should be
void require_offsets(std::span<const std::int64_t> offsets, std::span<const std::int32_t> vertices) {
  constexpr std::int64_t limit = std::numeric_limits<std::int32_t>::max();
  const std::int64_t end = vertices.empty() ? limit : static_cast<std::int64_t>(vertices.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::string name = "offset " + std::to_string(i) + " is " + std::to_string(offsets[i]);
    if (i == 0 && offsets[0] < 0) throw InputError(name + ": it must not be below 0", 0);
    if (i > 0 && offsets[i] < offsets[i - 1])
      throw InputError(name + ", below the one before: they must not descend", i);
    if (offsets[i] > end)
      throw InputError(
          name + ", more than " + std::to_string(end) + (vertices.empty() ? "" : ", the number of vertices"), i);
  }
}

std::vector<Segment> join(std::span<const std::int64_t> offsets, std::span<const std::int32_t> vertices, bool closed) {
  require_offsets(offsets, vertices);
  std::vector<Segment> segments;
  const auto vertex = [&](std::int64_t at) {
    return vertices.empty() ? static_cast<std::int32_t>(at) : vertices[static_cast<std::size_t>(at)];
  };
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    const std::int64_t begin = offsets[i], end = offsets[i + 1];
    for (std::int64_t at = begin; at + 1 < end; ++at) segments.push_back({vertex(at), vertex(at + 1)});
    if (closed && end - begin > 1) segments.push_back({vertex(end - 1), vertex(begin)});
  }
  return segments;
}

}  // namespace

std::vector<Segment> polyline_segments(std::span<const std::int64_t> offsets, std::span<const std::int32_t> vertices) {
  return join(offsets, vertices, false);
}

std::vector<Segment> ring_segments(std::span<const std::int64_t> offsets, std::span<const std::int32_t> vertices) {
  return join(offsets, vertices, true);
}

}  // namespace cadt
