// SPDX-License-Identifier: Apache-2.0
// Each stage of the verifier's predicates against GMP: whatever sign it gives must be right.
#include "device_stages.hpp"
#include "truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <fstream>
#include <functional>
#include <random>
#include <span>
#include <sstream>
#include <vector>

namespace {

using cadt::verifier::Point;
namespace stage = cadt::verifier::stage;
using Quad = std::array<Point, 4>;

/// How often each stage gave a sign, and how often zero.
struct Taken {
  int filter = 0, integer = 0, expansion = 0, zero = 0, all = 0;
  int device_filter = 0, device_exact = 0;
};

std::string text(std::span<const Point> points) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const Point& p : points) out << p.x << ' ' << p.y << ' ';
  return out.str();
}

void compare(const stage::Sign& sign, int expected, int& taken, const char* name, std::span<const Point> points) {
  if (!sign) return;
  ++taken;
  ASSERT_EQ(*sign, expected) << name << ' ' << text(points);
}

void check_orientation(std::span<const Point> q, int expected, Taken& taken) {
  taken.zero += expected == 0 ? 1 : 0;
  compare(stage::orientation_filter(q[0], q[1], q[2]), expected, taken.filter, "filter", q);
  compare(stage::orientation_integer(q[0], q[1], q[2]), expected, taken.integer, "integer", q);
  compare(stage::orientation_expansion(q[0], q[1], q[2]), expected, taken.expansion, "expansion", q);
  compare(stage::orientation_long(q[0], q[1], q[2]), expected, taken.all, "long", q);
  compare(cadt::verifier::orientation(q[0], q[1], q[2]), expected, taken.all, "all stages", q);
  compare(device_stage::turn_filter(q[0], q[1], q[2]), expected, taken.device_filter, "device filter", q);
  compare(device_stage::turn_exact(q[0], q[1], q[2]), expected, taken.device_exact, "device exact", q);
}

void check_incircle(std::span<const Point> q, int expected, Taken& taken) {
  taken.zero += expected == 0 ? 1 : 0;
  compare(stage::incircle_filter(q[0], q[1], q[2], q[3]), expected, taken.filter, "filter", q);
  compare(stage::incircle_integer(q[0], q[1], q[2], q[3]), expected, taken.integer, "integer", q);
  compare(stage::incircle_expansion(q[0], q[1], q[2], q[3]), expected, taken.expansion, "expansion", q);
  compare(stage::incircle_long(q[0], q[1], q[2], q[3]), expected, taken.all, "long", q);
  compare(cadt::verifier::incircle(q[0], q[1], q[2], q[3]), expected, taken.all, "all stages", q);
  compare(device_stage::incircle_filter(q[0], q[1], q[2], q[3]), expected, taken.device_filter, "device filter", q);
  compare(device_stage::incircle_exact(q[0], q[1], q[2], q[3]), expected, taken.device_exact, "device exact", q);
}

struct Counts {
  Taken orientation, incircle;
};

Counts check_family(int count, const std::function<Quad(std::mt19937_64&)>& make) {
  std::mt19937_64 engine(20240607);
  Counts counts;
  for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
    const Quad q = make(engine);
    check_orientation({q.data(), 3}, truth::orientation(q[0], q[1], q[2]), counts.orientation);
    check_incircle(q, truth::incircle(q[0], q[1], q[2], q[3]), counts.incircle);
  }
  return counts;
}

double uniform(std::mt19937_64& e) { return std::ldexp(static_cast<double>(e() >> 11), -53); }
int whole(std::mt19937_64& e, int low, int high) { return std::uniform_int_distribution<int>(low, high)(e); }

/// Moves v by up to `most` units in the last place.
double nudge(std::mt19937_64& e, double v, int most) {
  const int steps = whole(e, -most, most);
  for (int i = 0; i < std::abs(steps); ++i) v = std::nextafter(v, steps > 0 ? HUGE_VAL : -HUGE_VAL);
  return v;
}

/// Integer points on the circle of squared radius 325 * 325 (as many as 28 + 8), in any order.
Point on_circle(std::mt19937_64& e) {
  static const std::vector<Point> all = [] {
    std::vector<Point> points;
    for (int x = -325; x <= 325; ++x)
      for (int y = -325; y <= 325; ++y)
        if (x * x + y * y == 325 * 325) points.push_back({double(x), double(y)});
    return points;
  }();
  return all[e() % all.size()];
}

TEST(Predicates, Uniform) {
  const Counts c = check_family(5000, [](auto& e) {
    Quad q;
    for (Point& p : q) p = {uniform(e) - 0.5, uniform(e)};
    return q;
  });
  EXPECT_GT(c.incircle.filter, 4900);
  EXPECT_GT(c.orientation.filter, 4900);
  EXPECT_GT(c.incircle.device_filter, 4900);
  EXPECT_GT(c.orientation.device_filter, 4900);
}

TEST(Predicates, SmallIntegers) {
  const Counts c = check_family(20000, [](auto& e) {
    Quad q;
    for (Point& p : q) p = {double(whole(e, -4, 4)), double(whole(e, -4, 4))};
    return q;
  });
  EXPECT_EQ(c.incircle.integer, 20000);
  EXPECT_EQ(c.incircle.expansion, 20000);
  EXPECT_EQ(c.incircle.device_exact, 20000);
  EXPECT_EQ(c.orientation.device_exact, 20000);
  EXPECT_GT(c.incircle.zero, 1000);
  EXPECT_GT(c.orientation.zero, 1000);
}

TEST(Predicates, IntegersAtTheLimitOfTheIntegerStage) {
  const Counts c = check_family(20000, [](auto& e) {
    const auto extreme = [&] {
      return (whole(e, 0, 1) != 0 ? 0x1p30 - 1 : 0) + (whole(e, 0, 3) == 0 ? whole(e, -2, 2) : 0);
    };
    Quad q;
    for (Point& p : q) p = {extreme(), extreme()};
    return q;
  });
  EXPECT_GT(c.incircle.integer, 1000);
  EXPECT_LT(c.incircle.integer, 20000) << "differences of 2^30 and more must be left to the next stage";
}

TEST(Predicates, OrientationOf62Bits) {
  check_family(20000, [](auto& e) {
    const auto wide = [&] {
      return (whole(e, 0, 1) != 0 ? 1 : -1) * (0x1p62 - 512.0 * whole(e, 0, 3)) + whole(e, 0, 1);
    };
    Quad q;
    for (Point& p : q) p = {wide(), wide()};
    q[whole(e, 0, 3)].x = whole(e, 0, 1);
    return q;
  });
}

TEST(Predicates, Cocircular) {
  const Counts c = check_family(20000, [](auto& e) {
    const double scale = std::ldexp(1.0, whole(e, -40, 40));
    Quad q;
    for (Point& p : q) p = on_circle(e), p.x *= scale, p.y *= scale;
    return q;
  });
  EXPECT_EQ(c.incircle.zero, 20000);
  EXPECT_EQ(c.incircle.integer, 20000);
  EXPECT_EQ(c.incircle.device_filter, 0);
  EXPECT_EQ(c.incircle.device_exact, 20000);
}

TEST(Predicates, NearlyCocircular) {
  const Counts c = check_family(20000, [](auto& e) {
    const double scale = whole(e, 0, 1) != 0 ? 1e-3 : 1e5 / 3;
    Quad q;
    for (Point& p : q) {
      p = on_circle(e);
      p.x = nudge(e, p.x * scale, 2), p.y = nudge(e, p.y * scale, 2);
    }
    return q;
  });
  EXPECT_GT(c.incircle.expansion, 100);
  EXPECT_LT(c.incircle.filter, 19000);
}

TEST(Predicates, RectanglesOf53Bits) {
  const Counts c = check_family(20000, [](auto& e) {
    const double x = uniform(e), y = uniform(e), X = x + uniform(e), Y = y + uniform(e);
    Quad q{Point{x, y}, {X, y}, {X, Y}, {x, Y}};
    std::shuffle(q.begin(), q.end(), e);
    if (whole(e, 0, 1) != 0) q[3].x = nudge(e, q[3].x, 1);
    return q;
  });
  EXPECT_GT(c.incircle.zero, 5000);
  EXPECT_GT(c.incircle.expansion, 1000);
}

TEST(Predicates, NearlyCollinear) {
  const Counts c = check_family(20000, [](auto& e) {
    const double dx = uniform(e), dy = uniform(e);
    Quad q;
    for (Point& p : q) {
      const double t = 24 * uniform(e);
      p = {nudge(e, 0.5 + t * dx, 3), nudge(e, 0.5 + t * dy, 3)};
    }
    return q;
  });
  EXPECT_LT(c.orientation.filter, 19000);
}

TEST(Predicates, AnyBitPattern) {
  const Counts c = check_family(20000, [](auto& e) {
    const auto any = [&] {
      for (;;) {
        const double v = std::bit_cast<double>(e());
        if (std::isfinite(v)) return v;
      }
    };
    Quad q;
    for (Point& p : q) p = {any(), any()};
    return q;
  });
  EXPECT_LT(c.incircle.expansion, 20000);
}

TEST(Predicates, Subnormal) {
  const Counts c = check_family(20000, [](auto& e) {
    Quad q;
    for (Point& p : q) p = {DBL_TRUE_MIN * whole(e, 0, 3), DBL_TRUE_MIN * whole(e, -2, 2)};
    if (whole(e, 0, 9) == 0) q[0].x = 1;
    return q;
  });
  EXPECT_GT(c.incircle.zero, 1000);
}

TEST(Predicates, LimitsOfTheFormat) {
  check_family(40000, [](auto& e) {
    static const std::vector<double> values{0.0,      -0.0,    DBL_MAX, -DBL_MAX, DBL_MAX / 2, DBL_MIN, DBL_TRUE_MIN,
                                            -DBL_MIN, 1,       -1,      0.5,      1e300,       -1e300,  1e-300,
                                            1e-301,   0x1p250, 0x1p251, 0x1p-216, 0x1p-217,    0x1p510, 0x1p-480};
    Quad q;
    for (Point& p : q) p = {values[e() % values.size()], values[e() % values.size()]};
    return q;
  });
}

/// The same near-degenerate quadruple at all scales: where products underflow or overflow the filters must give way.
TEST(Predicates, EveryScale) {
  int exponent = -1080;
  const Counts c = check_family(2090 * 8, [&](auto& e) {
    if (e() % 8 == 0) exponent = exponent < 1010 ? exponent + 1 : -1080;
    Quad q;
    for (Point& p : q) {
      p = on_circle(e);
      p.x = std::ldexp(nudge(e, p.x / 512, 1), exponent), p.y = std::ldexp(nudge(e, p.y / 512, 1), exponent);
    }
    return q;
  });
  EXPECT_GT(c.incircle.zero, 100);
}

/// Thin sets: x and y differ by many binades, so that one of the filters' factors is near its limit.
TEST(Predicates, Anisotropic) {
  check_family(20000, [](auto& e) {
    const int ex = whole(e, -500, 500), ey = whole(e, -500, 500);
    Quad q;
    for (Point& p : q) p = {std::ldexp(nudge(e, whole(e, -3, 3), 1), ex), std::ldexp(nudge(e, whole(e, -3, 3), 1), ey)};
    return q;
  });
}

/// A tiny cluster and a point far away: products of the tiny differences underflow, those of the others do not.
TEST(Predicates, OneFarFromThree) {
  check_family(40000, [](auto& e) {
    const int tiny = whole(e, -545, -200), far = whole(e, 0, 200);
    Quad q;
    for (Point& p : q) p = {std::ldexp(uniform(e), tiny + whole(e, -2, 2)), std::ldexp(uniform(e), tiny)};
    q[e() % 4] = {std::ldexp(uniform(e) - 0.5, far), std::ldexp(uniform(e) - 0.5, far)};
    return q;
  });
}

/// All but ties, with terms of degree 4 near the smallest double: there the two sides of a tie round apart, and by far
/// more than a bound that has underflowed.
TEST(Predicates, TiesWhoseTermsUnderflow) {
  check_family(60000, [](auto& e) {
    const int exponent = whole(e, -284, -262);
    Quad q;
    for (Point& p : q) p = on_circle(e);
    Point& moved = q[e() % 4];
    moved.x = nudge(e, moved.x, 1), moved.y = nudge(e, moved.y, 1);
    for (Point& p : q) p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent)};
    return q;
  });
}

TEST(Predicates, FiltersGiveWayWhereTheyMust) {
  const double huge = DBL_MAX, tiny = DBL_TRUE_MIN;
  EXPECT_FALSE(stage::orientation_filter({-huge, -huge}, {huge, -huge}, {0, huge}));
  EXPECT_FALSE(stage::incircle_filter({-huge, 0}, {huge, 0}, {0, huge}, {0, 0}));
  EXPECT_FALSE(stage::orientation_filter({0, 0}, {tiny, 0}, {0, tiny}));
  EXPECT_FALSE(stage::incircle_filter({0, 0}, {tiny, 0}, {0, tiny}, {tiny, tiny}));
  EXPECT_FALSE(stage::incircle_expansion({0, 0}, {0x1p251, 0}, {0, 1}, {1, 1}));
  EXPECT_FALSE(stage::incircle_expansion({0, 0}, {0x1p-217, 0}, {0, 1}, {1, 1}));
  EXPECT_FALSE(stage::incircle_expansion({0, 0}, {1, 0}, {0, 1}, {1, 0x1.8p-53})) << "a difference that is rounded";
  EXPECT_EQ(*stage::orientation_filter({1, 0}, {1, 1}, {1, huge}), 0);
  EXPECT_FALSE(device_stage::turn_filter({-huge, -huge}, {huge, -huge}, {0, huge}));
  EXPECT_FALSE(device_stage::incircle_filter({-huge, 0}, {huge, 0}, {0, huge}, {0, 0}));
  EXPECT_FALSE(device_stage::turn_filter({0, 0}, {tiny, 0}, {0, tiny}));
  EXPECT_FALSE(device_stage::incircle_filter({0, 0}, {tiny, 0}, {0, tiny}, {tiny, tiny}));
  EXPECT_FALSE(device_stage::incircle_exact({0, 0}, {0x1p241, 0}, {0, 1}, {1, 1}));
  EXPECT_FALSE(device_stage::incircle_exact({0, 0}, {0x1p-217, 0}, {0, 1}, {1, 1}));
  EXPECT_FALSE(device_stage::incircle_exact({0, 1}, {0, 0x1.8p-53}, {1, 0}, {1, 1})) << "a difference that is rounded";
  EXPECT_FALSE(device_stage::turn_exact({1, 0}, {0x1.8p-53, 0}, {0, 1})) << "a difference that is rounded";
}

TEST(Predicates, MinusZeroIsZero) {
  EXPECT_EQ(cadt::verifier::incircle({0.0, -0.0}, {1, 0.0}, {1, 1}, {-0.0, 1}), 0);
  EXPECT_EQ(cadt::verifier::orientation({-0.0, 1}, {0.0, 2}, {-0.0, 3}), 0);
  EXPECT_FALSE(cadt::verifier::lexicographic_less({-0.0, 1}, {0.0, 1}));
  EXPECT_TRUE(cadt::verifier::lexicographic_less({0.0, 1}, {-0.0, 2}));
}

TEST(Predicates, PerturbationChoosesByTheGreatestPoint) {
  std::mt19937_64 engine(7);
  int inside = 0, outside = 0, edges = 0;
  for (int i = 0; i < 20000; ++i) {
    Quad q;
    for (Point& p : q)
      p = i % 2 == 0 ? on_circle(engine) : Point{double(whole(engine, 0, 2)), double(whole(engine, 0, 2))};
    if (cadt::verifier::orientation(q[0], q[1], q[2]) < 0) std::swap(q[1], q[2]);
    const auto distinct = [&](std::size_t j, std::size_t k) { return !cadt::verifier::equal(q[j], q[k]); };
    if (cadt::verifier::orientation(q[0], q[1], q[2]) == 0 || !distinct(0, 3) || !distinct(1, 3) || !distinct(2, 3) ||
        truth::incircle(q[0], q[1], q[2], q[3]) != 0)
      continue;
    const int side = cadt::verifier::incircle_perturbed(q[0], q[1], q[2], q[3]);
    ASSERT_EQ(side, truth::incircle_perturbed(q[0], q[1], q[2], q[3]));
    // The device looks at the edge between q[0] and q[3], which is there if q[3] is across it.
    if (cadt::verifier::orientation(q[3], q[2], q[1]) > 0) {
      ASSERT_EQ(device_stage::tie_is_usual(q[0], q[1], q[2], q[3]), side < 0);
      ++edges;
    }
    (side > 0 ? inside : outside) += 1;
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
  EXPECT_GT(edges, 500);
}

class Fixtures : public testing::TestWithParam<const char*> {};

TEST_P(Fixtures, SignsAreThoseOfTheFile) {
  const auto folder = truth::hard_data();
  if (folder.empty()) GTEST_SKIP() << "no data: set CADT_DATA_DIR";
  const auto path = folder / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const bool circle = std::string(GetParam()).find("incircle") != std::string::npos;
  std::ifstream in(path);
  int id = 0, lines = 0, sign = 0;
  Taken taken;
  while (in >> id) {
    Quad q{};
    for (std::size_t i = 0; i < (circle ? 4U : 3U); ++i) in >> q[i].x >> q[i].y;
    in >> sign;
    ASSERT_TRUE(in) << "line " << lines + 1;
    ++lines;
    if (circle) {
      check_incircle(q, sign, taken);
    } else {
      check_orientation({q.data(), 3}, sign, taken);
    }
    ASSERT_FALSE(HasFatalFailure()) << "id " << id;
  }
  EXPECT_GE(lines, 500);
}

INSTANTIATE_TEST_SUITE_P(Predicates, Fixtures,
                         testing::Values("gen_threshold_orient2d.txt", "gen_threshold_incircle.txt",
                                         "predicates_pscico_orient2d.txt", "predicates_pscico_incircle.txt"),
                         [](const auto& fixture) {
                           const std::string name = fixture.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
