// SPDX-License-Identifier: Apache-2.0
// Triangle's call in C: which arrays it fills, in whose memory, and what it does with wrong input.
#include <cadt/triangulateio.h>

#include <gtest/gtest.h>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

extern "C" int run_as_c99(int* triangles, double* center);

namespace {

using Struct = cadt_triangulateio;
using Ints = std::vector<int>;
using Values = std::vector<double>;

// Triangle's layout, as its users' compiled code has it on 64-bit machines.
static_assert(sizeof(void*) != 8 || (sizeof(Struct) == 168 && offsetof(Struct, numberofpoints) == 24 &&
                                     offsetof(Struct, trianglelist) == 32 && offsetof(Struct, neighborlist) == 56 &&
                                     offsetof(Struct, segmentlist) == 80 && offsetof(Struct, holelist) == 104 &&
                                     offsetof(Struct, regionlist) == 120 && offsetof(Struct, edgelist) == 136 &&
                                     offsetof(Struct, normlist) == 152 && offsetof(Struct, numberofedges) == 160));

/// Arrays that are freed at the end unless they are the caller's.
class Output : public Struct {
 public:
  Output() : Struct{} {}
  ~Output() {
    for (void* array :
         std::initializer_list<void*>{pointlist, pointattributelist, pointmarkerlist, trianglelist, neighborlist,
                                      segmentlist, segmentmarkerlist, edgelist, edgemarkerlist, normlist}) {
      if (callers_.count(array) == 0) cadt_trifree(array);
    }
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  void is_callers(void* array) { callers_.insert(array); }

 private:
  std::set<void*> callers_;
};

Ints ints(const int* values, int count) { return values == nullptr ? Ints{} : Ints(values, values + count); }
Values doubles(const double* values, int count) {
  return values == nullptr ? Values{} : Values(values, values + count);
}

/// Four points, the third one twice.
class TriangulateIo : public ::testing::Test {
 protected:
  void SetUp() override {
    in.pointlist = points.data();
    in.numberofpoints = 5;
  }
  Values points = {0, 0, 4, 0, 4, 2, 4, 2, 0, 3};
  Values attributes = {1, 2, 3, 4, 5};
  Ints markers = {0, 7, 0, 8, 0};
  Struct in{};
  Output out, vorout;
};

TEST(TriangulateIoC99, RunsAsAProgramOfTriangle) {
  std::array<int, 3> triangle{};
  std::array<double, 2> center{};
  ASSERT_EQ(run_as_c99(triangle.data(), center.data()), 0);
  EXPECT_EQ(triangle, (std::array{0, 1, 2}));
  EXPECT_EQ(center, (std::array{1.0, 1.0}));
}

TEST_F(TriangulateIo, CountsFromOneUnlessAskedOtherwise) {
  ASSERT_EQ(cadt_triangle("n", &in, &out, nullptr), CADT_TRIANGLE_DONE) << cadt_triangle_message();
  EXPECT_STREQ(cadt_triangle_message(), "");
  EXPECT_EQ(out.numberoftriangles, 2);
  EXPECT_EQ(out.numberofcorners, 3);
  EXPECT_EQ(ints(out.trianglelist, 6), (Ints{1, 2, 3, 1, 3, 5}));
  EXPECT_EQ(ints(out.neighborlist, 6), (Ints{-1, 2, -1, -1, -1, 1}));
  EXPECT_EQ(doubles(out.pointlist, 10), points);
  EXPECT_EQ(ints(out.pointmarkerlist, 5), (Ints{1, 1, 1, 0, 1}));
  EXPECT_EQ(out.numberofedges, 5);
  EXPECT_EQ(out.numberofsegments, 4);
  EXPECT_EQ(out.edgelist, nullptr);
  EXPECT_EQ(out.segmentlist, nullptr);
  EXPECT_EQ(out.pointattributelist, nullptr);
  Output zero;
  ASSERT_EQ(cadt_triangle("zn", &in, &zero, nullptr), CADT_TRIANGLE_DONE);
  EXPECT_EQ(ints(zero.trianglelist, 6), (Ints{0, 1, 2, 0, 2, 4}));
  EXPECT_EQ(ints(zero.neighborlist, 6), (Ints{-1, 1, -1, -1, -1, 0}));
}

TEST_F(TriangulateIo, FillsEveryArray) {
  in.pointattributelist = attributes.data();
  in.numberofpointattributes = 1;
  in.pointmarkerlist = markers.data();
  ASSERT_EQ(cadt_triangle("zevc", &in, &out, &vorout), CADT_TRIANGLE_DONE) << cadt_triangle_message();
  EXPECT_EQ(doubles(out.pointattributelist, 5), attributes);
  EXPECT_EQ(ints(out.pointmarkerlist, 5), (Ints{1, 7, 1, 8, 1}));
  EXPECT_EQ(ints(out.segmentlist, 8), (Ints{0, 1, 1, 2, 2, 4, 4, 0}));
  EXPECT_EQ(ints(out.segmentmarkerlist, 4), (Ints{1, 1, 1, 1}));
  EXPECT_EQ(ints(out.edgelist, 10), (Ints{1, 2, 2, 0, 0, 1, 2, 4, 4, 0}));
  EXPECT_EQ(ints(out.edgemarkerlist, 5), (Ints{1, 0, 1, 1, 1}));
  EXPECT_EQ(vorout.numberofpoints, 2);
  EXPECT_EQ(vorout.numberofpointattributes, 1);
  // (2, 1) is the middle of points 0 and 2; in the triangle 0 2 4 the second centre is at y = 1.5, x = 1.75.
  EXPECT_EQ(doubles(vorout.pointlist, 4), (Values{2, 1, 1.75, 1.5}));
  EXPECT_EQ(vorout.pointattributelist[0], 2);  // the middle of 1 and 3
  EXPECT_EQ(vorout.numberofedges, 5);
  EXPECT_EQ(ints(vorout.edgelist, 10), (Ints{0, -1, 0, 1, 0, -1, 1, -1, 1, -1}));
  EXPECT_EQ(doubles(vorout.normlist, 10), (Values{2, 0, 0, 0, 0, -4, 1, 4, -3, 0}));
  Output one, voronoi;
  ASSERT_EQ(cadt_triangle("evc", &in, &one, &voronoi), CADT_TRIANGLE_DONE);
  EXPECT_EQ(ints(one.segmentlist, 2), (Ints{1, 2}));
  EXPECT_EQ(ints(one.edgelist, 2), (Ints{2, 3}));
  EXPECT_EQ(ints(voronoi.edgelist, 4), (Ints{1, -1, 1, 2}));
}

TEST_F(TriangulateIo, LeavesOutWhatIsNotWanted) {
  in.pointattributelist = attributes.data();
  in.numberofpointattributes = 1;
  ASSERT_EQ(cadt_triangle("BNEPecn", &in, &out, nullptr), CADT_TRIANGLE_DONE);
  EXPECT_EQ(out.pointlist, nullptr);
  EXPECT_EQ(out.pointattributelist, nullptr);
  EXPECT_EQ(out.pointmarkerlist, nullptr);
  EXPECT_EQ(out.trianglelist, nullptr);
  EXPECT_EQ(out.segmentlist, nullptr);
  EXPECT_EQ(out.segmentmarkerlist, nullptr);
  EXPECT_EQ(out.edgemarkerlist, nullptr);
  EXPECT_NE(out.edgelist, nullptr);
  EXPECT_NE(out.neighborlist, nullptr);
  EXPECT_EQ(out.numberoftriangles, 2);
  Output marked;
  ASSERT_EQ(cadt_triangle("cB", &in, &marked, nullptr), CADT_TRIANGLE_DONE);
  EXPECT_NE(marked.segmentlist, nullptr);
  EXPECT_EQ(marked.segmentmarkerlist, nullptr);
  EXPECT_EQ(marked.pointmarkerlist, nullptr);
}

TEST_F(TriangulateIo, JettisonsDuplicates) {
  in.pointmarkerlist = markers.data();
  ASSERT_EQ(cadt_triangle("zj", &in, &out, nullptr), CADT_TRIANGLE_DONE);
  EXPECT_EQ(out.numberofpoints, 4);
  EXPECT_EQ(doubles(out.pointlist, 8), (Values{0, 0, 4, 0, 4, 2, 0, 3}));
  EXPECT_EQ(ints(out.pointmarkerlist, 4), (Ints{1, 7, 1, 1}));
  EXPECT_EQ(ints(out.trianglelist, 6), (Ints{0, 1, 2, 0, 2, 3}));
}

TEST_F(TriangulateIo, WritesToTheCallersMemory) {
  Ints triangles(7, -7), edges(11, -7);
  out.trianglelist = triangles.data();
  out.edgelist = edges.data();
  out.pointlist = points.data();  // that of the input, as Triangle's header proposes
  for (void* array : std::initializer_list<void*>{triangles.data(), edges.data(), points.data()}) out.is_callers(array);
  const Values before = points;
  ASSERT_EQ(cadt_triangle("ze", &in, &out, nullptr), CADT_TRIANGLE_DONE);
  EXPECT_EQ(out.trianglelist, triangles.data());
  EXPECT_EQ(triangles, (Ints{0, 1, 2, 0, 2, 4, -7}));
  EXPECT_EQ(edges, (Ints{1, 2, 2, 0, 0, 1, 2, 4, 4, 0, -7}));
  EXPECT_EQ(points, before);
}

TEST_F(TriangulateIo, TakesFewPointsAndLines) {
  in.numberofpoints = 0;
  in.pointlist = nullptr;
  ASSERT_EQ(cadt_triangle("zev", &in, &out, &vorout), CADT_TRIANGLE_DONE) << cadt_triangle_message();
  EXPECT_EQ(out.numberoftriangles, 0);
  EXPECT_EQ(vorout.numberofpoints, 0);
  EXPECT_NE(out.trianglelist, nullptr);  // something to free, as from malloc
  points = {0, 0, 1, 1, 2, 2};
  in.pointlist = points.data();
  in.numberofpoints = 3;
  Output line;
  ASSERT_EQ(cadt_triangle("ze", &in, &line, nullptr), CADT_TRIANGLE_DONE);
  EXPECT_EQ(line.numberoftriangles, 0);
  EXPECT_EQ(line.numberofedges, 0);
  EXPECT_EQ(line.numberofpoints, 3);
}

/// Two squares, one in the other, with a hole in the inner one.
TEST_F(TriangulateIo, TakesSegmentsHolesAndRegions) {
  Values corners = {0, 0, 6, 0, 6, 6, 0, 6, 2, 2, 4, 2, 4, 4, 2, 4, 5, 5};
  Values holes = {3, 3}, regions = {1, 1, 8.5, 0};
  Ints segments = {1, 2, 2, 3, 3, 4, 4, 1, 5, 6, 6, 7, 7, 8, 8, 5};
  Ints segment_markers = {3, 0, 0, 0, 0, 0, 0, 4};
  in.pointlist = corners.data();
  in.numberofpoints = 9;
  in.segmentlist = segments.data();
  in.segmentmarkerlist = segment_markers.data();
  in.numberofsegments = 8;
  in.holelist = holes.data();
  in.numberofholes = 1;
  in.regionlist = regions.data();
  in.numberofregions = 1;
  ASSERT_EQ(cadt_triangle("pAe", &in, &out, nullptr), CADT_TRIANGLE_DONE) << cadt_triangle_message();
  EXPECT_EQ(out.numberoftriangles, 10);
  EXPECT_EQ(out.numberoftriangleattributes, 1);
  EXPECT_EQ(doubles(out.triangleattributelist, 10), Values(10, 8.5));
  EXPECT_EQ(out.numberofsegments, 8);
  EXPECT_EQ(ints(out.segmentlist, 16), (Ints{1, 2, 1, 4, 2, 3, 3, 4, 5, 6, 5, 8, 6, 7, 7, 8}));
  EXPECT_EQ(ints(out.segmentmarkerlist, 8), (Ints{3, 1, 1, 1, 1, 4, 1, 1}));
  EXPECT_EQ(ints(out.pointmarkerlist, 9), (Ints{3, 3, 1, 1, 4, 1, 1, 4, 0}));
  EXPECT_EQ(out.holelist, holes.data());
  EXPECT_EQ(out.numberofholes, 1);
  EXPECT_EQ(out.regionlist, regions.data());
  EXPECT_EQ(out.numberofregions, 1);
  cadt_trifree(out.triangleattributelist);
  Output all;
  for (int& v : segments) --v;
  ASSERT_EQ(cadt_triangle("zpOBP", &in, &all, nullptr), CADT_TRIANGLE_DONE) << cadt_triangle_message();
  EXPECT_EQ(all.numberoftriangles, 12);
  EXPECT_EQ(all.segmentlist, nullptr);
  EXPECT_EQ(all.triangleattributelist, nullptr);
  EXPECT_EQ(all.numberofsegments, 8);
}

struct Wrong {
  const char* name;
  void (*spoil)(Struct& in);
  const char* switches;
  int status;
  const char* says;
};

TEST_F(TriangulateIo, RefusesAndChangesNothing) {
  static Ints ends = {0, 1, 4, 5};
  static Values infinite = {0, 0, 1, 0, 0, std::numeric_limits<double>::infinity(), 3, 3, 4, 4};
  static Values regions = {0, 0, 1, 0, std::numeric_limits<double>::quiet_NaN(), 0, 1, 0};
  for (const Wrong& wrong : std::vector<Wrong>{
           {"switch", [](Struct&) {}, "zpq", CADT_TRIANGLE_SWITCHES, "-q adds points"},
           {"points", [](Struct& s) { s.pointlist = nullptr; }, "z", CADT_TRIANGLE_INPUT, "pointlist is NULL"},
           {"count", [](Struct& s) { s.numberofpoints = -1; }, "z", CADT_TRIANGLE_INPUT, "numberofpoints is neg"},
           {"attributes", [](Struct& s) { s.numberofpointattributes = 2; }, "z", CADT_TRIANGLE_INPUT,
            "pointattributelist is NULL"},
           {"attribute count", [](Struct& s) { s.numberofpointattributes = -2; }, "z", CADT_TRIANGLE_INPUT,
            "numberofpointattributes is neg"},
           {"infinity", [](Struct& s) { s.pointlist = infinite.data(); }, "z", CADT_TRIANGLE_INPUT,
            "pointlist, point 2"},
           {"segments", [](Struct& s) { s.numberofsegments = 1; }, "zp", CADT_TRIANGLE_INPUT, "segmentlist is NULL"},
           {"segment count", [](Struct& s) { s.numberofsegments = -1; }, "zp", CADT_TRIANGLE_INPUT,
            "numberofsegments is neg"},
           {"segment", [](Struct& s) { s.numberofsegments = 2, s.segmentlist = ends.data(); }, "zp",
            CADT_TRIANGLE_INPUT, "segment 1 counted from 0: there is no point 5"},
           {"first segment", [](Struct& s) { s.numberofsegments = 2, s.segmentlist = ends.data(); }, "p",
            CADT_TRIANGLE_INPUT, "segment 0 counted from 0: there is no point 0"},
           {"holes", [](Struct& s) { s.numberofholes = 1; }, "zp", CADT_TRIANGLE_INPUT, "holelist is NULL"},
           {"regions", [](Struct& s) { s.numberofregions = 1; }, "zp", CADT_TRIANGLE_INPUT, "regionlist is NULL"},
           {"a hole at infinity", [](Struct& s) { s.numberofholes = 3, s.holelist = infinite.data(); }, "zp",
            CADT_TRIANGLE_INPUT, "holelist, hole 2 counted from 0: its place is not finite"},
           {"a region nowhere", [](Struct& s) { s.numberofregions = 2, s.regionlist = regions.data(); }, "zp",
            CADT_TRIANGLE_INPUT, "regionlist, region 1 counted from 0: its place is not finite"},
           {"region count", [](Struct& s) { s.numberofregions = -1; }, "zp", CADT_TRIANGLE_INPUT,
            "numberofregions is neg"},
           {"hole count", [](Struct& s) { s.numberofholes = -1; }, "zp", CADT_TRIANGLE_INPUT, "numberofholes is neg"},
           {"voronoi", [](Struct&) {}, "v", CADT_TRIANGLE_INPUT, "vorout"},
           {"no switches", [](Struct&) {}, nullptr, CADT_TRIANGLE_INPUT, "is NULL"},
       }) {
    Struct spoiled = in;
    wrong.spoil(spoiled);
    Struct result{};
    result.numberofpoints = 77;
    const Struct before = result;
    EXPECT_EQ(cadt_triangle(wrong.switches, &spoiled, &result, nullptr), wrong.status) << wrong.name;
    EXPECT_NE(std::string(cadt_triangle_message()).find(wrong.says), std::string::npos)
        << wrong.name << ": " << cadt_triangle_message();
    EXPECT_EQ(std::memcmp(&before, &result, sizeof before), 0) << wrong.name;
  }
  EXPECT_EQ(cadt_triangle("z", nullptr, &out, nullptr), CADT_TRIANGLE_INPUT);
  EXPECT_EQ(cadt_triangle("z", &in, nullptr, nullptr), CADT_TRIANGLE_INPUT);
}

TEST_F(TriangulateIo, MessagesBelongToTheThread) {
  EXPECT_EQ(cadt_triangle("q", &in, &out, nullptr), CADT_TRIANGLE_SWITCHES);
  std::thread([] {
    EXPECT_STREQ(cadt_triangle_message(), "");
    EXPECT_EQ(cadt_triangle(nullptr, nullptr, nullptr, nullptr), CADT_TRIANGLE_INPUT);
  }).join();
  EXPECT_NE(std::string(cadt_triangle_message()).find("-q"), std::string::npos);
}

TEST_F(TriangulateIo, LongMessagesAreCut) {
  std::string all;
  for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
  EXPECT_EQ(cadt_triangle(all.c_str(), &in, &out, nullptr), CADT_TRIANGLE_SWITCHES);
  EXPECT_EQ(std::strlen(cadt_triangle_message()), 2047U);
}

}  // namespace
