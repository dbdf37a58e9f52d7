// SPDX-License-Identifier: Apache-2.0
// Binary glTF: the header's sizes, the accessors' bounds, and the mesh itself.
#include "tests/unit/io/io_test_support.hpp"
#include "tests/unit/io/mesh_fixture.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace cadt::io::test {
namespace {

struct Glb {
  std::string bytes, json;
  std::size_t body = 0;  ///< where the binary chunk's data begins

  explicit Glb(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2U);
    EXPECT_EQ(word(8), bytes.size());
    EXPECT_EQ(word(12) % 4, 0U);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    json = bytes.substr(20, word(12));
    body = 20 + word(12) + 8;
    EXPECT_EQ(word(body - 8), bytes.size() - body);
    EXPECT_EQ(bytes.substr(body - 4, 4), std::string("BIN\0", 4));
    EXPECT_EQ(numbers("\"buffers\":[{\"byteLength\":", 1)[0], static_cast<double>(bytes.size() - body));
  }
  /// So many numbers behind the `which`-th place with these words.
  [[nodiscard]] std::vector<double> numbers(const std::string& words, std::size_t count, int which = 0) const {
    std::size_t at = json.find(words);
    for (; which > 0 && at != std::string::npos; --which) at = json.find(words, at + 1);
    EXPECT_NE(at, std::string::npos) << words << " in " << json;
    std::vector<double> found;
    const char* text = json.c_str() + (at == std::string::npos ? json.size() : at + words.size());
    while (found.size() < count) {
      char* end = nullptr;
      found.push_back(std::strtod(text, &end));
      EXPECT_NE(text, end) << words;
      text = end + (*end == ',' ? 1 : 0);
    }
    return found;
  }
  [[nodiscard]] std::uint32_t word(std::size_t at) const { return value<std::uint32_t>(at); }
  template <class T>
  [[nodiscard]] T value(std::size_t at) const {
    T v{};
    std::memcpy(&v, bytes.data() + at, sizeof v);
    return v;
  }
  /// Point v in the world: the translation and the float.
  [[nodiscard]] double world(std::size_t v, std::size_t k) const {
    return numbers("\"translation\":[", 3)[k] + static_cast<double>(value<float>(body + 12 * v + 4 * k));
  }
};

TEST(Glb, HasThePointsWithYUpAndTheTriangles) {
  const Folder folder;
  SquareMesh mesh;
  for (std::size_t i = 0; i < mesh.xy.size(); i += 2) {
    mesh.xy[i] += 500'000;
    mesh.xy[i + 1] += 4'100'000;
    mesh.height.push_back(static_cast<double>(i));
  }
  const std::string path = folder / "m.glb";
  detail::write_mesh_parts(path, mesh.parts(), {});
  const Glb glb(path);
  EXPECT_EQ(glb.numbers("\"count\":", 1)[0], 6);
  EXPECT_EQ(glb.numbers("\"count\":", 1, 1)[0], static_cast<double>(mesh.triangles.size()));
  const auto low = glb.numbers("\"min\":[", 3), high = glb.numbers("\"max\":[", 3);
  for (std::size_t v = 0; v < mesh.points(); ++v) {
    EXPECT_EQ(glb.world(v, 0), mesh.xy[2 * v]) << v;
    EXPECT_EQ(glb.world(v, 1), mesh.height[v]) << v;
    EXPECT_EQ(glb.world(v, 2), -mesh.xy[2 * v + 1]) << v << ": counterclockwise seen from above";
    for (std::size_t k = 0; k < 3; ++k) {
      const auto f = static_cast<double>(glb.value<float>(glb.body + 12 * v + 4 * k));
      EXPECT_GE(f, low[k]);
      EXPECT_LE(f, high[k]);
    }
  }
  const std::size_t faces = glb.body + static_cast<std::size_t>(glb.numbers("\"byteOffset\":", 1, 1)[0]);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    EXPECT_EQ(glb.value<std::int32_t>(faces + 4 * i), mesh.triangles[i]) << i;
}

TEST(Glb, RefusesWhatItCannotHold) {
  const Folder folder;
  const std::string path = folder / "m.glb";
  SquareMesh mesh;
  mesh.xy[0] = -1e300;
  expect_file_error([&] { detail::write_mesh_parts(path, mesh.parts(), {}); }, path, 0, "too large for the floats");
  mesh = {};
  for (double& v : mesh.xy) v *= 1e-60;
  expect_file_error([&] { detail::write_mesh_parts(path, mesh.parts(), {}); }, path, 0, "too close together");
  mesh = {};
  mesh.triangles.clear();
  expect_file_error([&] { detail::write_mesh_parts(path, mesh.parts(), {}); }, path, 0, "needs triangles");
  EXPECT_EQ(folder.entries(), 0U);
}

}  // namespace
}  // namespace cadt::io::test
