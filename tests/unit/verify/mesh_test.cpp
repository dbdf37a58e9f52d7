// SPDX-License-Identifier: Apache-2.0
// Valid meshes are accepted, with the right counts, whatever the number of threads and the form of the input.
#include "devices.hpp"
#include "small_delaunay.hpp"
#include "truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cfloat>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace {

using cadt::VerifyReport;

void expect_accepted(const TestMesh& m, std::uint64_t ties) {
  for (const bool bare : {false, true})
    for (const unsigned threads : {1U, 2U, 5U, 0U}) {
      const VerifyReport r = verify(m.points(), bare ? m.bare() : m.view(), {threads, true});
      EXPECT_TRUE(r.ok) << r.summary();
      EXPECT_EQ(r.summary().rfind("ok: ", 0), 0U);
      EXPECT_EQ(r.points, m.xy.size() / 2);
      EXPECT_EQ(r.triangles_examined, m.size());
      EXPECT_EQ(r.edges_examined, (m.triangles.size() - m.hull.size()) / 2);
      EXPECT_EQ(r.hull_vertices, m.hull.size());
      EXPECT_EQ(r.ties, ties);
      EXPECT_EQ(r.unusual_ties, 0U);
      ASSERT_EQ(r.checks.size(), 10U);
      for (const cadt::Check& c : r.checks) {
        EXPECT_TRUE(c.passed) << c.name;
        EXPECT_TRUE(c.what.empty()) << c.name << ": " << c.what;
        EXPECT_EQ(c.first, -1) << c.name;
      }
    }
  (void)on_host_and_devices(m.points(), m.view());
  (void)on_host_and_devices(m.points(), m.bare());
}

TEST(Accepted, RandomPoints) {
  for (int n = 3; n <= 40; n += 4) expect_accepted(brute_force_delaunay(random_points(n, static_cast<unsigned>(n))), 0);
}

TEST(Accepted, Duplicates) {
  std::vector<double> xy = random_points(15, 2);
  for (const std::size_t i : {4U, 4U, 9U, 0U}) xy.insert(xy.begin(), {xy[2 * i], xy[2 * i + 1]});
  const TestMesh m = brute_force_delaunay(xy);
  EXPECT_EQ(m.duplicates.size(), 4U);
  expect_accepted(m, 0);
}

TEST(Accepted, SignedZeros) {
  const TestMesh m =
      brute_force_delaunay({0.0, 0.0, -0.0, 0.0, 0.0, -0.0, -0.0, -0.0, 1, 0.0, 1, -0.0, 0.0, 1, -0.0, 1});
  EXPECT_EQ(m.size(), 1U);
  EXPECT_EQ(m.duplicates.size(), 5U);
  expect_accepted(m, 0);
}

TEST(Accepted, LatticeOfTheTestHelperIsTheOneByBruteForce) {
  const TestMesh m = lattice(4, 3);
  TestMesh truth = brute_force_delaunay(m.xy);
  const auto sorted = [](const TestMesh& mesh) {
    std::vector<std::array<std::int32_t, 3>> t;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      std::array<std::int32_t, 3> v{mesh.triangles[3 * i], mesh.triangles[3 * i + 1], mesh.triangles[3 * i + 2]};
      std::ranges::rotate(v, std::ranges::min_element(v));
      t.push_back(v);
    }
    std::ranges::sort(t);
    return t;
  };
  EXPECT_EQ(sorted(m), sorted(truth));
}

TEST(Accepted, LatticesOfEveryScale) {
  for (const double step : {1.0, DBL_TRUE_MIN, 0x1p-1040, 0x1p-216, 0x1p248, 0x1p1018, 0.1, 1e300, 1e-300}) {
    SCOPED_TRACE(step);
    TestMesh m = lattice(32, 32, step);
    expect_accepted(m, 961);
    for (double& v : m.xy) v -= 16 * step;
    if (step != 0.1) expect_accepted(m, 961);
  }
}

TEST(Accepted, LatticeFarFromTheOrigin) {
  TestMesh m = lattice(32, 32);
  for (double& v : m.xy) v += 1e15;
  expect_accepted(m, 961);
}

TEST(Accepted, WholeFormat) {
  const double m = DBL_MAX;
  const TestMesh corners = brute_force_delaunay({m, m, -m, m, -m, -m, m, -m, 0, 0, 1, 1, m / 2, -m / 3});
  EXPECT_EQ(corners.size(), 8U);
  expect_accepted(corners, 0);
  const double s = DBL_TRUE_MIN;
  const TestMesh mixed = brute_force_delaunay({0, 0, 1, 0, 0, 1, s, s, 1, s, .5, .5});
  EXPECT_EQ(mixed.size(), 6U);
  expect_accepted(mixed, 1);
}

TEST(Accepted, Hub) { expect_accepted(hub(1000), 0); }

TEST(Accepted, LargeEnoughForManyBlocks) { expect_accepted(lattice(150, 140), 149 * 139); }

TEST(Accepted, ManyDuplicatesOfOnePoint) {
  std::vector<double> xy{0, 0, 1, 0, 0, 1};
  for (int i = 0; i < 20000; ++i) xy.insert(xy.end(), {1.0, 0.0});
  TestMesh m;
  m.xy = std::move(xy);
  m.triangles = {0, 1, 2};
  m.complete();
  expect_accepted(m, 0);
}

TEST(Accepted, AnyFormOfTheInput) {
  const TestMesh m = lattice(6, 5);
  std::vector<float> single(m.xy.begin(), m.xy.end());
  std::vector<double> x, y;
  for (std::size_t i = 0; i < m.xy.size(); i += 2) x.push_back(m.xy[i]), y.push_back(m.xy[i + 1]);
  EXPECT_TRUE(verify(std::span<const float>(single), m.view()).ok);
  EXPECT_TRUE(verify(cadt::PointsView(x, y), m.view()).ok);
  std::swap(x[0], x[29]);
  EXPECT_FALSE(verify(cadt::PointsView(x, y), m.view()).ok);
}

TEST(Accepted, NoTrianglesOfCollinearPoints) {
  for (const std::vector<double>& xy : std::vector<std::vector<double>>{{},
                                                                        {1, 2},
                                                                        {1, 2, 1, 2},
                                                                        {0, 0, 3, 2, 6, 4, -3, -2},
                                                                        {0, 1, 0, DBL_MAX, 0, -DBL_MAX},
                                                                        {0.0, 1, -0.0, 2, 0, 3}}) {
    TestMesh m;
    m.xy = xy;
    m.complete();
    EXPECT_TRUE(on_host_and_devices(m.points(), m.view()).ok);
    EXPECT_TRUE(on_host_and_devices(m.points(), m.bare()).ok);
  }
}

TEST(Accepted, OtherDecisionOfTies) {
  TestMesh m = lattice(4, 4);
  for (std::size_t i = 0; i < m.xy.size(); i += 2) m.xy[i] = -m.xy[i];  // the diagonals now fall to the left
  for (std::size_t t = 0; t < m.size(); ++t) std::swap(m.triangles[3 * t], m.triangles[3 * t + 1]);
  m.complete();
  const VerifyReport strict = on_host_and_devices(m.points(), m.view());
  const VerifyReport lenient = on_host_and_devices(m.points(), m.view(), {0, false});
  EXPECT_FALSE(strict.ok);
  EXPECT_EQ(strict.summary().rfind("ties failed", 0), 0U) << strict.summary();
  EXPECT_TRUE(lenient.ok);
  EXPECT_EQ(lenient.unusual_ties, 9U);
  EXPECT_NE(lenient.summary().find("9 of them decided in another way"), std::string::npos) << lenient.summary();
}

TEST(Accepted, FirstFailureDoesNotDependOnThreads) {
  TestMesh m = lattice(150, 140);
  for (const std::size_t t : {30000U, 17000U, 41000U}) std::swap(m.triangles[3 * t], m.triangles[3 * t + 1]);
  for (const unsigned threads : {1U, 2U, 7U}) {
    const VerifyReport r = verify(m.points(), m.bare(), {threads, true});
    EXPECT_EQ(r.checks[3].name, "orientation");
    EXPECT_EQ(r.checks[3].first, 17000);
    EXPECT_EQ(r.checks[3].failures, 3U);
  }
}

TEST(InvalidInput, NamesTheFirstPointThatIsNotFinite) {
  const TestMesh m = lattice(100, 100);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    for (const std::size_t value : {0U, 1U, 9001U, 19999U}) {
      std::vector<double> xy = m.xy;
      xy[value] = bad, xy.back() = bad;
      try {
        (void)verify(std::span<const double>(xy), m.view());
        FAIL() << "accepted";
      } catch (const cadt::InputError& e) {
        EXPECT_EQ(e.index(), value / 2);
      }
    }
}

TEST(InvalidInput, NoVerdictWithoutIeeeArithmetic) {
  const TestMesh m = lattice(3, 3);
  const auto refused = [&] {
    try {
      (void)verify(m.points(), m.view());
      return false;
    } catch (const cadt::Error&) {
      return true;
    }
  };
  const int before = std::fegetround();
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  const bool upward = refused();
  std::fesetround(before);
  EXPECT_TRUE(upward);
#ifdef __SSE2__
  const unsigned mode = _mm_getcsr();
  for (const unsigned flag : {0x8000U, 0x0040U}) {  // flush to zero, denormals are zero
    _mm_setcsr(mode | flag);
    const bool flushed = refused();
    _mm_setcsr(mode);
    EXPECT_TRUE(flushed) << flag;
  }
#endif
  EXPECT_FALSE(refused());
}

/// The small regression inputs, triangulated by brute force, against the counts that came with them.
TEST(HardInputs, CountsAreThoseOfTheFile) {
  const auto folder = truth::hard_data();
  if (folder.empty()) GTEST_SKIP() << "no data: set CADT_DATA_DIR";
  std::ifstream table(folder / "EXPECTED.tsv");
  int examined = 0;
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::string name;
    std::size_t n = 0, duplicates = 0, hull = 0, triangles = 0, edges = 0, ties = 0;
    fields >> name >> n >> duplicates >> hull >> triangles >> edges >> ties;
    ASSERT_TRUE(fields) << line;
    if (n > 40 || !std::filesystem::exists(folder / name)) continue;
    SCOPED_TRACE(name);
    std::ifstream file(folder / name);
    const std::vector<double> xy{std::istream_iterator<double>(file), {}};
    ASSERT_EQ(xy.size(), 2 * n);
    const TestMesh m = brute_force_delaunay(xy);
    EXPECT_EQ(m.size(), triangles);
    EXPECT_EQ(m.duplicates.size(), duplicates);
    const VerifyReport r = on_host_and_devices(m.points(), m.view());
    EXPECT_TRUE(r.ok) << r.summary();
    EXPECT_EQ(r.ties, ties);
    if (triangles > 0) {
      EXPECT_EQ(r.hull_vertices, hull);
    }
    ++examined;
  }
  EXPECT_GT(examined, 20);
}

}  // namespace
