// SPDX-License-Identifier: Apache-2.0
// Vertices of binary .ply, .npy and raw files, of both byte orders, and what is wrong with them.
#include "tests/unit/io/io_test_support.hpp"

#include <limits>

namespace cadt::io::test {
namespace {

std::string ply_header(bool big, const std::string& elements) {
  return std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + elements + "end_header\n";
}

const std::string vertex_2 = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";

class PlyBinary : public ::testing::TestWithParam<bool> {};

TEST_P(PlyBinary, AllTypesListsAndElements) {
  const bool big = GetParam();
  const std::string content =
      ply_header(
          big,
          "element camera 1\nproperty list uchar double a\nproperty char b\n"
          "element vertex 2\nproperty uchar red\nproperty double x\nproperty list ushort int l\nproperty int16 y\n"
          "property uint32 z\nproperty int64 q\n"
          "element face 1\nproperty list int uint vertex_indices\n") +
      bytes<std::uint8_t>(2) + bytes(1.0, big) + bytes(2.0, big) + bytes<std::int8_t>(-1) +  // camera
      bytes<std::uint8_t>(9) + bytes(0.5, big) + bytes<std::uint16_t>(1, big) +
      bytes<std::int32_t>(7, big) +  // vertex 0
      bytes<std::int16_t>(-300, big) + bytes<std::uint32_t>(4000000000U, big) + bytes<std::int64_t>(1, big) +  //
      bytes<std::uint8_t>(9) + bytes(1e300, big) + bytes<std::uint16_t>(0, big) +
      bytes<std::int16_t>(2, big) +                                                               // vertex 1
      bytes<std::uint32_t>(3, big) + bytes<std::int64_t>(1, big) +                                //
      bytes<std::int32_t>(2, big) + bytes<std::uint32_t>(0, big) + bytes<std::uint32_t>(1, big);  // face
  const Folder folder;
  const PointSet points = read_points(folder.file("p.ply", content));
  EXPECT_EQ(points.xy, (Values{0.5, -300, 1e300, 2}));
  EXPECT_EQ(points.height, (Values{4e9, 3}));
  for (std::size_t size = content.size() - 1; size + 40 > content.size(); --size) {
    const std::string path = folder.file("cut.ply", content.substr(0, size));
    EXPECT_THROW(static_cast<void>(read_points(path)), FileError) << size;
  }
  expect_read_error(folder.file("tail.ply", content + "\n"), 0, at_byte(content.size(), "1 bytes after"));
}

TEST_P(PlyBinary, NanNamesTheByteOfItsRow) {
  const bool big = GetParam();
  const std::string header = ply_header(big, vertex_2);
  const Folder folder;
  const std::string path =
      folder.file("p.ply", header + bytes(1.0F, big) + bytes(1.0F, big) + bytes(1.0F, big) + bytes(1.0F, big) +
                               bytes(std::numeric_limits<float>::quiet_NaN(), big) + bytes(1.0F, big));
  expect_read_error(path, 0, at_byte(header.size() + 12, "y of point 1 is not a finite number"));
}

TEST_P(PlyBinary, HostileCounts) {
  const bool big = GetParam();
  const Folder folder;
  const auto claim = [&](const std::string& count) {
    return ply_header(big, "element vertex " + count + "\nproperty float x\nproperty float y\n");
  };
  for (const std::string count : {"4000000000", "9223372036854775807", "2305843009213693952"}) {
    const std::string header = claim(count);
    expect_read_error(
        folder.file("p.ply", header + std::string(8, '\0')), 0,
        at_byte(header.size(), "the header claims ") + count + " rows of element 'vertex', the file has room for 1");
  }
  const std::string lists = ply_header(big, "element face 1\nproperty list uint double l\n" + vertex_2);
  expect_read_error(folder.file("l.ply", lists + bytes<std::uint32_t>(4000000000U, big) + std::string(24, '\0')), 0,
                    at_byte(lists.size() + 4, "a list claims more items"));
  const std::string negative = ply_header(big, "element face 1\nproperty list int double l\n" + vertex_2);
  expect_read_error(folder.file("n.ply", negative + bytes<std::int32_t>(-1, big) + std::string(24, '\0')), 0,
                    "is negative");
}

INSTANTIATE_TEST_SUITE_P(ByteOrders, PlyBinary, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "big" : "little"; });

TEST(PlyBinaryHeader, CrlfEndsAtTheLineFeed) {
  const Folder folder;
  const std::string header =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nproperty double x\r\nproperty double "
      "y\r\nend_header\r\n";
  EXPECT_EQ(read_points(folder.file("p.ply", header + bytes(1.5) + bytes(2.5))).xy, (Values{1.5, 2.5}));
}

/// A .npy file with any header text, padded as NumPy does it.
std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
  std::string header = dictionary + "\n";
  std::string start = "\x93NUMPY";
  start += {static_cast<char>(version), '\0'};
  start += version == 1 ? bytes(static_cast<std::uint16_t>(header.size()))
                        : bytes(static_cast<std::uint32_t>(header.size()));
  return start + header + data;
}
std::string npy(const std::string& descr, bool fortran, const std::string& shape, const std::string& data) {
  return npy(
      "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }",
      data);
}

template <class Real>
std::string numbers(std::initializer_list<double> values, bool big) {
  std::string text;
  for (const double value : values) text += bytes(static_cast<Real>(value), big);
  return text;
}

TEST(Npy, TypesOrdersAndShapes) {
  const Folder folder;
  for (const bool big : {false, true}) {
    const std::string order = big ? ">" : "<";
    const auto read = [&](const std::string& content) { return read_points(folder.file("p.npy", content)); };
    EXPECT_EQ(read(npy(order + "f8", false, "(2, 2)", numbers<double>({1, 2, 3, 4}, big))).xy, (Values{1, 2, 3, 4}));
    EXPECT_EQ(read(npy(order + "f4", false, "(2, 2)", numbers<float>({1, 2, 3, 4}, big))).xy, (Values{1, 2, 3, 4}));
    EXPECT_EQ(read(npy(order + "f8", true, "(2, 2)", numbers<double>({1, 2, 3, 4}, big))).xy, (Values{1, 3, 2, 4}));
    const PointSet c = read(npy(order + "f4", false, "(2, 3)", numbers<float>({1, 2, 3, 4, 5, 6}, big)));
    EXPECT_EQ(c.xy, (Values{1, 2, 4, 5}));
    EXPECT_EQ(c.height, (Values{3, 6}));
    const PointSet f = read(npy(order + "f8", true, "(2, 3)", numbers<double>({1, 2, 3, 4, 5, 6}, big)));
    EXPECT_EQ(f.xy, (Values{1, 3, 2, 4}));
    EXPECT_EQ(f.height, (Values{5, 6}));
  }
  const std::string dictionary = "{\"shape\":(1,2),\"fortran_order\":False,\"descr\":\"<f8\"}";
  EXPECT_EQ(read_points(folder.file("v2.npy", npy(dictionary, bytes(1.0) + bytes(2.0), 2))).xy, (Values{1, 2}));
}

TEST(Npy, Errors) {
  const Folder folder;
  const auto expect = [&](const std::string& content, const std::string& message) {
    expect_read_error(folder.file("p.npy", content), 0, message);
  };
  const std::string point = bytes(1.0) + bytes(2.0);
  expect("not an array", "byte 0: is not an array of NumPy");
  expect("\x93NUM", "is not an array");
  expect("\x93NUMPY\x01", "byte 7: the file ends within the header");
  expect(npy("<f8", false, "(1, 2)", point).substr(0, 40), "byte 40: the file ends within the header");
  expect(npy("{}", point, 9), "version 9");
  expect(npy("{}", point), "lacks descr");
  expect(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2)", point), "malformed");
  expect(npy("{'descr': '<f8', 'fortran_order': Maybe, 'shape': (1, 2)}", point), "True or False");
  expect(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 2)}", point), "tuple of integers");
  expect(npy("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (1,)}", point), "arrays with fields");
  expect(npy("<U3", false, "(1, 2)", std::string(24, 'a')), "arrays of type '<U3' cannot be read");
  expect(npy("<i4", false, "(2, 2)", point), "float32 or float64");
  expect(npy("<f8", false, "(2,)", point), "shape (n, 2) or (n, 3)");
  expect(npy("<f8", false, "(2, 1)", point), "shape (n, 2) or (n, 3)");
  expect(npy("<f8", false, "(0, 2)", ""), "no points");
  const std::string two = npy("<f8", false, "(2, 2)", point);
  expect(two, at_byte(two.size(), "the file ends within the array"));
  const std::string one = npy("<f8", false, "(1, 2)", point);
  expect(one + "x", at_byte(one.size() - 16, "1 bytes after the array"));
  expect(npy("<f8", false, "(4000000000, 2)", point), "ends within the array");
  expect(npy("<f8", false, "(1152921504606846976, 2)", point), "ends within the array");
  expect(npy("<f8", false, "(9223372036854775807, 9223372036854775807)", point), "ends within the array");
  const std::string infinite = npy("<f8", false, "(1, 2)", bytes(1.0) + bytes(std::numeric_limits<double>::infinity()));
  expect(infinite, at_byte(infinite.size() - 8, "a coordinate is infinite"));
}

TEST(Raw, Errors) {
  const Folder folder;
  expect_read_error(folder.file("p.f64", std::string(17, '\0')), 0, "byte 17: the file ends within a point");
  expect_read_error(folder.file("q.f64", std::string(24, '\0')), 0, "byte 24: the file ends within a point");
  expect_read_error(folder.file("p.f32", std::string(12, '\0')), 0, "byte 12: the file ends within a point");
  const std::string nan = bytes(1.0) + bytes(2.0) + bytes(3.0) + bytes(std::numeric_limits<double>::quiet_NaN());
  expect_read_error(folder.file("n.f64", nan), 0, "byte 24: a coordinate is NaN");
  const std::string infinite = bytes(1.0F) + bytes(2.0F) + bytes(-std::numeric_limits<float>::infinity()) + bytes(1.0F);
  expect_read_error(folder.file("n.f32", infinite), 0, "byte 8: a coordinate is infinite");
}

}  // namespace
}  // namespace cadt::io::test
