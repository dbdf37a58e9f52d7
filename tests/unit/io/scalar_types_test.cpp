// SPDX-License-Identifier: Apache-2.0
// Every scalar type of the binary formats, with the largest and least value that it holds: what lies beyond the signed
// range of an unsigned type must not come back negative, and what needs all its bytes must not come back cut short.
#include "io/support/npy_format.hpp"
#include "io/support/zip_archive.hpp"
#include "tests/unit/io/io_test_support.hpp"

#include <limits>

namespace cadt::io::test {
namespace {

/// A type of PLY under one of its names, and two of its values in both byte orders.
struct Scalar {
  const char* name;
  std::array<double, 2> value;
  std::array<std::string, 2> little, big;
};
std::ostream& operator<<(std::ostream& out, const Scalar& scalar) { return out << scalar.name; }

template <class T>
Scalar scalar(const char* name, T low, T high) {
  return {name,
          {static_cast<double>(low), static_cast<double>(high)},
          {bytes(low), bytes(high)},
          {bytes(low, true), bytes(high, true)}};
}

/// The extreme values; of 64-bit integers those that a double can hold.
template <class T>
Scalar integer(const char* name) {
  using Limits = std::numeric_limits<T>;
  T high = Limits::max();
  if constexpr (sizeof(T) == 8) high -= high >> std::numeric_limits<double>::digits;
  return scalar<T>(name, Limits::lowest(), high);
}

std::vector<Scalar> integers() {
  return {integer<std::int8_t>("char"),     integer<std::int8_t>("int8"),     integer<std::uint8_t>("uchar"),
          integer<std::uint8_t>("uint8"),   integer<std::int16_t>("short"),   integer<std::int16_t>("int16"),
          integer<std::uint16_t>("ushort"), integer<std::uint16_t>("uint16"), integer<std::int32_t>("int"),
          integer<std::int32_t>("int32"),   integer<std::uint32_t>("uint"),   integer<std::uint32_t>("uint32"),
          integer<std::int64_t>("int64"),   integer<std::uint64_t>("uint64")};
}

std::vector<Scalar> all_scalars() {
  std::vector<Scalar> all = integers();
  for (const char* name : {"float", "float32"}) all.push_back(scalar(name, -0.1F, 3.4e38F));
  for (const char* name : {"double", "float64"}) all.push_back(scalar(name, -0.1, 1.7e308));
  return all;
}

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}
std::string binary(bool big) { return big ? "binary_big_endian" : "binary_little_endian"; }

class PlyScalar : public ::testing::TestWithParam<Scalar> {};

TEST_P(PlyScalar, AsCoordinates) {
  const Scalar& type = GetParam();
  const std::string vertex =
      std::string("element vertex 1\nproperty ") + type.name + " x\nproperty " + type.name + " y\n";
  const Values expected = {type.value[0], type.value[1]};
  const Folder folder;
  for (const bool big : {false, true}) {
    const auto& at = big ? type.big : type.little;
    EXPECT_EQ(read_points(folder.file("p.ply", header(binary(big), vertex) + at[0] + at[1])).xy, expected) << big;
  }
}

/// Two elements stand before the vertices: an item of the type in a list of another element, and a property that is
/// passed over. Both have to move the reader on by the type's size.
TEST_P(PlyScalar, PassedOver) {
  const Scalar& type = GetParam();
  const std::string name = type.name;
  const std::string elements = "element list_of 1\nproperty list uchar " + name + " l\nelement other 2\nproperty " +
                               name + " a\nelement vertex 1\nproperty " + name +
                               " a\nproperty double x\nproperty double y\n";
  const Folder folder;
  for (const bool big : {false, true}) {
    const auto& at = big ? type.big : type.little;
    const std::string data =
        bytes<std::uint8_t>(2) + at[0] + at[1] + at[0] + at[1] + at[1] + bytes(1.5, big) + bytes(2.5, big);
    EXPECT_EQ(read_points(folder.file("p.ply", header(binary(big), elements) + data)).xy, (Values{1.5, 2.5})) << big;
  }
}

/// Indices of corners: the largest value has to be refused as it is, neither as another index nor as a corner.
TEST_P(PlyScalar, AsIndices) {
  const Scalar& type = GetParam();
  const std::string faces = std::string("element face 1\nproperty list uchar ") + type.name + " vertex_indices\n";
  const Folder folder;
  const bool integral = std::string(type.name).find("int") != std::string::npos ||
                        std::string(type.name).find("char") != std::string::npos ||
                        std::string(type.name).find("short") != std::string::npos;
  if (!integral || type.value[1] > 9e15) return;  // what is no index, or beyond what the reader takes for one
  for (const bool big : {false, true}) {
    const std::string largest = big ? type.big[1] : type.little[1];
    const std::string name = "index " + std::to_string(static_cast<std::int64_t>(type.value[1])) + " is out of range";
    expect_mesh_error(
        folder.file("m.ply", header(binary(big), faces) + bytes<std::uint8_t>(3) + largest + largest + largest), 100, 0,
        name);
  }
}

INSTANTIATE_TEST_SUITE_P(Types, PlyScalar, ::testing::ValuesIn(all_scalars()),
                         [](const auto& test) { return std::string(test.param.name); });

/// The length of a list: beyond the signed range of an unsigned type there are that many items; below zero it is wrong.
class PlyLength : public ::testing::TestWithParam<Scalar> {};

TEST_P(PlyLength, OfEveryIntegerType) {
  const Scalar& type = GetParam();
  const std::string elements = std::string("element skipped 1\nproperty list ") + type.name +
                               " uchar l\nelement vertex 1\nproperty double x\nproperty double y\n";
  const Folder folder;
  for (const bool big : {false, true}) {
    const std::string start = header(binary(big), elements);
    const std::string point = bytes(1.5, big) + bytes(2.5, big);
    const auto& length = big ? type.big : type.little;
    if (type.value[1] < 1e6) {
      const std::string items(static_cast<std::size_t>(type.value[1]), 'x');
      EXPECT_EQ(read_points(folder.file("p.ply", start + length[1] + items + point)).xy, (Values{1.5, 2.5})) << big;
    } else {
      expect_read_error(folder.file("p.ply", start + length[1] + point), 0, "a list claims more items");
    }
    const std::string least = folder.file("n.ply", start + length[0] + point);
    if (type.value[0] < 0) {
      expect_read_error(least, 0, "the length of a list is negative");
    } else {
      EXPECT_EQ(read_points(least).xy, (Values{1.5, 2.5})) << big;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Types, PlyLength, ::testing::ValuesIn(integers()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(PlyLength, OfARealTypeIsRefused) {
  const Folder folder;
  for (const char* name : {"float", "double", "float32", "float64"}) {
    const std::string elements = std::string("element vertex 1\nproperty list ") + name + " uchar l\n";
    expect_read_error(folder.file("p.ply", header(binary(false), elements)), 4, "must be of an integer type");
  }
}

std::string npy(const std::string& descr, const std::vector<std::size_t>& shape, const std::string& data) {
  return detail::npy_header(descr, shape) + data;
}

/// Both real types, both byte orders: values that need every byte. Whatever else there is must be refused, not read.
TEST(NpyScalar, OfCoordinates) {
  const Folder folder;
  const auto read = [&](const std::string& content) { return read_points(folder.file("p.npy", content)).xy; };
  for (const bool big : {false, true}) {
    const std::string order = big ? ">" : "<";
    EXPECT_EQ(read(npy(order + "f4", {1, 2}, bytes(-0.1F, big) + bytes(3.4e38F, big))),
              (Values{static_cast<double>(-0.1F), static_cast<double>(3.4e38F)}));
    EXPECT_EQ(read(npy(order + "f8", {1, 2}, bytes(-0.1, big) + bytes(1.7e308, big))), (Values{-0.1, 1.7e308}));
    for (const char* other : {"i4", "i8", "u4", "u8", "b1", "f2", "c8"}) {
      const auto size = static_cast<std::size_t>(other[1] - '0');
      expect_read_error(folder.file("p.npy", npy(order + other, {1, 2}, std::string(2 * size, '\1'))), 0,
                        "must hold float32 or float64");
    }
    expect_read_error(folder.file("p.npy", npy(order + "f16", {1, 2}, std::string(32, '\1'))), 0,
                      "must hold float32 or float64");
  }
  EXPECT_EQ(read(npy("=f8", {1, 2}, bytes(-0.1) + bytes(1.7e308))), (Values{-0.1, 1.7e308}));
}

/// Triangles of .npz: the integer types that are read, with every byte of an index in use.
TEST(NpyScalar, OfTriangles) {
  const Folder folder;
  const auto archive = [&](const std::string& descr, const std::string& data) {
    const std::string path = folder / "m.npz";
    detail::AtomicFile out(path);
    detail::ZipWriter zip(out);
    const std::string content = npy(descr, {1, 3}, data);
    const std::string_view parts[] = {content};
    zip.add("simplices.npy", parts);
    zip.finish();
    out.commit();
    return path;
  };
  constexpr std::int32_t a = 0x01020304, b = 0x7F010203, c = 5;
  constexpr std::size_t points = 0x7FFFFFFF;
  const std::vector<std::int32_t> expected{a, b, c};
  for (const bool big : {false, true}) {
    const std::string order = big ? ">" : "<";
    EXPECT_EQ(read_mesh(archive(order + "i4", bytes(a, big) + bytes(b, big) + bytes(c, big)), points).triangles,
              expected);
    const auto wide = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return archive(order + "i8", bytes(x, big) + bytes(y, big) + bytes(z, big));
    };
    EXPECT_EQ(read_mesh(wide(a, b, c), points).triangles, expected);
    // Cut to 32 bits this would be the corner 5.
    expect_mesh_error(wide(a, b, 0x100000005), points, 0, "row 0: index 4294967301 is out of range");
    expect_mesh_error(wide(a, b, -1), points, 0, "row 0: index -1 is out of range");
    for (const char* other : {"u4", "u8", "i2", "i1", "f4", "f8"}) {
      const auto size = static_cast<std::size_t>(other[1] - '0');
      expect_mesh_error(archive(order + other, std::string(3 * size, '\0')), points, 0, "must hold int32 or int64");
    }
  }
}

/// Bare numbers are little-endian, of either size.
TEST(RawScalar, OfBothSizes) {
  const Folder folder;
  EXPECT_EQ(read_points(folder.file("p.f64", bytes(-0.1) + bytes(1.7e308))).xy, (Values{-0.1, 1.7e308}));
  EXPECT_EQ(read_points(folder.file("p.f32", bytes(-0.1F) + bytes(3.4e38F))).xy,
            (Values{static_cast<double>(-0.1F), static_cast<double>(3.4e38F)}));
}

}  // namespace
}  // namespace cadt::io::test
