// SPDX-License-Identifier: Apache-2.0
// Binary glTF 2.0: .glb, for engines and browsers. Positions are floats about the middle of the box, which is the
// translation of the node; y is up and heights are along it, as the specification has it (section 3.4): (x, h, -y).
#include "io/mesh/mesh_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace cadt::io::detail {
namespace {

using Place = std::array<double, 3>;

Place place_of(const MeshParts& mesh, std::size_t v) {
  return {mesh.xy[2 * v], mesh.height.empty() ? 0.0 : mesh.height[v], -mesh.xy[2 * v + 1]};
}

std::string list(const Place& p) { return fmt::format("[{},{},{}]", p[0], p[1], p[2]); }

void write_word(AtomicFile& out, std::uint32_t word) { out.write(&word, sizeof word); }

}  // namespace

void write_glb(AtomicFile& out, const std::string& path, const MeshParts& mesh) {
  const std::size_t n = mesh.xy.size() / 2;
  constexpr double far = std::numeric_limits<double>::infinity();
  Place low{far, far, far}, high{-far, -far, -far}, middle{};
  for (std::size_t v = 0; v < n; ++v) {
    const Place p = place_of(mesh, v);
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  const std::uint64_t bytes_points = n * 12, bytes_faces = mesh.triangles.size_bytes();
  if (mesh.triangles.empty()) throw FileError(path, 0, "a .glb needs triangles, and the mesh has none: write a .ply");
  if (bytes_points + bytes_faces > std::numeric_limits<std::uint32_t>::max() - 4096)
    throw FileError(path, 0,
                    fmt::format("{} triangles are too many for a .glb, whose sizes have 32 bits: write a .ply",
                                mesh.triangles.size() / 3));
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[k] = 0.5 * low[k] + 0.5 * high[k];
    if (!(high[k] - middle[k] <= static_cast<double>(std::numeric_limits<float>::max())))
      throw FileError(path, 0, "the coordinates are too large for the floats of a .glb: write a .ply");
    // The accessor's bounds are those of the floats.
    low[k] = static_cast<double>(static_cast<float>(low[k] - middle[k]));
    high[k] = static_cast<double>(static_cast<float>(high[k] - middle[k]));
    longest = std::max(longest, high[k] - low[k]);
  }
  if (longest < static_cast<double>(std::numeric_limits<float>::min()))
    throw FileError(path, 0, "the coordinates are too close together for the floats of a .glb: write a .ply");
  std::string text = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"cadt"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"translation":{0}}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":4,"material":0}}]}}],)"
      R"("materials":[{{"doubleSided":true,"pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":1}}}}],)"
      R"("buffers":[{{"byteLength":{1}}}],)"
      R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{2},"target":34962}},)"
      R"({{"buffer":0,"byteOffset":{2},"byteLength":{3},"target":34963}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{4},"type":"VEC3","min":{5},"max":{6}}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{7},"type":"SCALAR"}}]}})",
      list(middle), bytes_points + bytes_faces, bytes_points, bytes_faces, n, list(low), list(high),
      mesh.triangles.size());
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t length = 12 + 8 + text.size() + 8 + bytes_points + bytes_faces;
  out.write("glTF", 4);
  write_word(out, 2);
  write_word(out, static_cast<std::uint32_t>(length));
  write_word(out, static_cast<std::uint32_t>(text.size()));
  out.write("JSON", 4);
  out.write(text);
  write_word(out, static_cast<std::uint32_t>(bytes_points + bytes_faces));
  out.write("BIN\0", 4);
  for (std::size_t v = 0; v < n; ++v) {
    const Place p = place_of(mesh, v);
    const std::array<float, 3> at = {static_cast<float>(p[0] - middle[0]), static_cast<float>(p[1] - middle[1]),
                                     static_cast<float>(p[2] - middle[2])};
    out.write(at.data(), sizeof at);
  }
  out.write(mesh.triangles.data(), mesh.triangles.size_bytes());
}

}  // namespace cadt::io::detail
