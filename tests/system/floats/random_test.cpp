// SPDX-License-Identifier: Apache-2.0
// Random sets of floats, small and of every kind that is hard: the mesh of a device without doubles is that of the
// host.
//
// CADT_FLOAT_SETS: how many.
#include "tests/support/families.hpp"
#include "tests/system/floats/floats.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

namespace cadt::test {
namespace {

enum class Kind { any_bits, subnormal, integers, near_a_line, near_a_circle, few_exponents, kinds };

float any_finite(Random& random) {
  for (;;) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
    if (std::isfinite(value)) return value;
  }
}

// A unit or some of the last place away.
float nearby(float value, std::size_t units, bool up) {
  const float towards = up ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < units; ++i) value = std::nextafter(value, towards);
  return value;
}

Floats random_set(Random& random, Kind kind) {
  const std::size_t n = 3 + random.below(kind == Kind::any_bits ? 40 : 200), side = 2 + random.below(30);
  // Of one magnitude each, from where subnormal numbers are to near the largest.
  const int exponent = static_cast<int>(random.below(240)) - 140;
  const double slope = random.uniform(-2, 2);
  Floats xy;
  for (std::size_t i = 0; i < n; ++i) {
    float x = 0, y = 0;
    switch (kind) {
      case Kind::any_bits:
        x = any_finite(random), y = any_finite(random);
        break;
      case Kind::subnormal:
        x = std::bit_cast<float>(static_cast<std::uint32_t>(random.below(1U << 24)));
        y = -std::bit_cast<float>(static_cast<std::uint32_t>(random.below(side)));
        break;
      case Kind::integers:
        x = std::ldexp(static_cast<float>(random.below(side)), exponent);
        y = std::ldexp(static_cast<float>(random.below(side)) - 7, exponent);
        break;
      case Kind::near_a_line: {
        const double t = random.uniform(-1, 1);
        x = static_cast<float>(std::ldexp(t, exponent));
        y = nearby(static_cast<float>(std::ldexp(slope * t, exponent)), random.below(3), random.below(2) == 1);
        break;
      }
      case Kind::near_a_circle: {
        const double angle = random.uniform(0, 6.2831853);
        x = static_cast<float>(std::ldexp(std::cos(angle), exponent));
        y = nearby(static_cast<float>(std::ldexp(std::sin(angle), exponent)), random.below(3), random.below(2) == 1);
        break;
      }
      default:
        x = std::ldexp(static_cast<float>(random.uniform(-1, 1)), -static_cast<int>(random.below(60)));
        y = std::ldexp(static_cast<float>(random.uniform(-1, 1)), -static_cast<int>(random.below(60)));
    }
    xy.push_back(x);
    xy.push_back(y);
  }
  return xy;
}

class FloatRandom : public FloatTest {};

TEST_F(FloatRandom, Sets) {
  const char* text = std::getenv("CADT_FLOAT_SETS");
  const int sets = text != nullptr ? std::atoi(text) : 600;
  Triangulator device(float_options()), host(host_options());
  std::size_t ties = 0, triangles = 0;
  for (int set = 0; set < sets; ++set) {
    Random random(static_cast<std::uint64_t>(set) + 1);
    const auto kind = static_cast<Kind>(set % static_cast<int>(Kind::kinds));
    const Floats xy = random_set(random, kind);
    const Triangulation mesh = device.triangulate(FloatSpan(xy)), expected = host.triangulate(FloatSpan(xy));
    ASSERT_EQ(mesh.hash(), expected.hash()) << "set " << set << ", kind " << set % static_cast<int>(Kind::kinds);
    ASSERT_TRUE(mesh.statistics().certified) << set;
    ASSERT_TRUE(verify(FloatSpan(xy), mesh).ok) << set;
    ties += mesh.statistics().ties;
    triangles += mesh.number_of_triangles();
  }
  EXPECT_GT(ties, 100U);
  RecordProperty("triangles", std::to_string(triangles));
}

}  // namespace
}  // namespace cadt::test
