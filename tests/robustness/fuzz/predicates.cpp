// SPDX-License-Identifier: Apache-2.0
// The predicates of both builds against whole numbers of any length: every sign of every stage, and which stage it was
// (tests/unit/predicates/cases.hpp). One input gives up to 64 cases: its points, bent towards lines and circles, and
// those a few units in the last place away.
#include <bit>
#include <cmath>
#include <random>
#include <sstream>

#include "tests/robustness/fuzz/fuzz.hpp"
#include "tests/robustness/fuzz/signs.hpp"
#include "tests/unit/predicates/cases.hpp"

namespace {

using cadt::test::Four;
using cadt::test::SignCase;

// Towards degenerate: a rectangle, a point mirrored or turned, the third on the line of two, all of one exponent.
void bend(Four& p, unsigned way) {
  switch (way & 7u) {
    case 1:
      p[2] = {p[1].x, p[3].y}, p[0] = {p[3].x, p[1].y};
      break;
    case 2:
      p[1] = {-p[0].x, -p[0].y}, p[2] = {-p[0].y, p[0].x}, p[3] = {p[0].x, -p[0].y};
      break;
    case 3:
      p[2] = {p[0].x + (p[1].x - p[0].x) / 2, p[0].y + (p[1].y - p[0].y) / 2};
      break;
    case 4:
      p[3] = {p[0].x + p[1].x - p[2].x, p[0].y + p[1].y - p[2].y};
      break;
    case 5:
      for (auto& q : p) q = {std::round(std::remainder(q.x, 64.0)), std::round(std::remainder(q.y, 64.0))};
      break;
    case 6:
      p[1] = {p[0].y, p[0].x}, p[2] = {-p[0].x, p[0].y}, p[3] = {-p[0].y, -p[0].x};
      break;
    default:
      break;
  }
}

bool finite(const Four& p) {
  for (const auto& q : p)
    if (!std::isfinite(q.x) || !std::isfinite(q.y)) return false;
  return true;
}

void check(const std::vector<SignCase>& cases, const std::vector<std::uint32_t>& words, const char* build) {
  const cadt::test::WrongSigns wrong = cadt::test::compare(cases, words);
  if (wrong.fields == 0) return;
  std::ostringstream out;
  out << build << ": found " << std::hex << words[wrong.first] << ", expected " << cases[wrong.first].word << " for"
      << std::hexfloat;
  for (const auto& q : cases[wrong.first].points) out << "  " << q.x << ' ' << q.y;
  cadt::fuzz::fail(out.str());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static cadt::fuzz::Counter signs("signs of predicates");
  cadt::fuzz::Bytes bytes(data, size);
  const auto way = bytes.take<std::uint8_t>(), many = bytes.take<std::uint8_t>();
  const auto seed = bytes.take<std::uint16_t>();
  Four p{};
  for (auto& q : p) {
    for (double* v : {&q.x, &q.y}) {
      auto bits = bytes.take<std::uint64_t>();
      // Most inputs: exponents of 64 binades; integers over all of them take a hundred times as long.
      if (way >> 5 != 7u) bits = (bits & 0x800FFFFFFFFFFFFFu) | (std::uint64_t{991} + (bits >> 52 & 63u)) << 52;
      *v = std::bit_cast<double>(bits);
      if (way & 8u) *v = std::ldexp(std::remainder(*v, 1.0), -static_cast<int>(many & 15u));
    }
  }
  bend(p, way);
  cadt::test::Random random(seed);
  cadt::test::SignSet set;
  for (unsigned i = 0; i <= (many & 63u); ++i) {
    if (finite(p)) cadt::test::add_case(set, p);
    auto& q = p[random() % 4];
    double& v = random() & 1 ? q.x : q.y;
    v = std::nextafter(v, random() & 1 ? HUGE_VAL : -HUGE_VAL);
    if (way & 16u) v = std::ldexp(v, static_cast<int>(random() % 5) - 2);
  }
  check(set.narrow, cadt::fuzz::narrow_words(set.narrow), "narrow");
  check(set.wide, cadt::fuzz::wide_words(set.wide), "wide");
  signs += 8 * (set.narrow.size() + set.wide.size());  // fields of a word
  return 0;
}
