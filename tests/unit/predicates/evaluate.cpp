// SPDX-License-Identifier: Apache-2.0
// One build of the predicates, perhaps with a planted fault, on the cases of a file. tests/unit/predicates/mutants.py
// compiles it, with the headers as they are or patched, once for each build:
//   -DCADT_WIDE=1                     the wide build
//   -DCADT_FLOAT=1                    the build for floats, with their cases
//   -DCADT_AS_GPU                     the narrow build of GPUs, without the cheap filter of incircle
//   -DCADT_VERIFIER                   the predicates of the verifier on devices; what they leave open counts as right
//   -DCADT_PLANT_FLUSH                fault: subnormal numbers are 0
//   -DCADT_PLANT_ROUNDING=FE_UPWARD   fault: another rounding
// usage: evaluate FILE; prints the name of each set, the number of its cases, of those with a wrong sign, and of those
// that are right by another stage than the bounds ask for.
#include <atomic>
#include <cfenv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>
#if defined(CADT_PLANT_FLUSH)
#include <xmmintrin.h>
#endif

namespace {
#include "common/portable/atomics.dev.h"
#if defined(CADT_AS_GPU)
#undef CADT_CONTIGUOUS
#define CADT_CONTIGUOUS 0
#endif
#if defined(CADT_VERIFIER)
#include "common/verify/device/verify_predicates.dev.h"
#else
#include "common/predicates/predicate_probe.dev.h"
#endif

// As SignCase of cases.hpp, which is not included: a patched header could reach it.
struct Case {
  double points[8];
  double most;
  std::uint64_t word;
};

#if defined(CADT_VERIFIER)
// The first two fields of the expected words, with a wrong answer in its place. The determinant of the word is that of
// bit 8; an edge is legal where it is negative.
std::vector<cadt_u32> verifier_words(const std::vector<Case>& cases) {
  std::vector<cadt_u32> words;
  for (const Case& c : cases) {
    const cadt_point p[4] = {
        {c.points[0], c.points[1]}, {c.points[2], c.points[3]}, {c.points[4], c.points[5]}, {c.points[6], c.points[7]}};
    auto word = static_cast<cadt_u32>(c.word);
    const cadt_i32 turn = static_cast<cadt_i32>(word & 3u) - 1, legal = 1 - static_cast<cadt_i32>(word >> 8 & 3u);
    for (const cadt_i32 sign : {cadt_verify_turn_filter(p[0], p[1], p[2]), cadt_verify_turn_exact(p[0], p[1], p[2])})
      if (sign != CADT_UNKNOWN && sign != turn) word ^= 1u;
    for (const cadt_i32 sign :
         {cadt_verify_edge_filter(p[0], p[1], p[2], p[3]), cadt_verify_edge_exact(p[0], p[1], p[2], p[3])})
      if (sign != CADT_UNKNOWN && sign != legal) word ^= 4u;
    words.push_back(word);
  }
  return words;
}
#endif

// Streams of the C library: this file is compiled a few hundred times.
template <class T>
std::vector<T> read_array(std::FILE* in) {
  std::uint64_t count = 0;
  if (std::fread(&count, sizeof count, 1, in) != 1) return {};
  std::vector<T> values(count);
  if (std::fread(values.data(), sizeof(T), count, in) != count) values.clear();
  return values;
}
}  // namespace

int main(int argc, char** argv) {
  std::FILE* in = argc == 2 ? std::fopen(argv[1], "rb") : nullptr;
  if (in == nullptr) return 2;
  bool any = false;
  for (std::vector<char> name; !(name = read_array<char>(in)).empty(); any = true) {
    std::vector<Case> cases = read_array<Case>(in), wide = read_array<Case>(in), floats = read_array<Case>(in);
    if (CADT_WIDE) cases.swap(CADT_FLOAT ? floats : wide);
    const auto count = static_cast<cadt_u32>(cases.size());
    std::vector<cadt_point> points;
    std::vector<cadt_real> most;
    for (const Case& c : cases) {
      for (int i = 0; i < 8; i += 2)
        points.push_back({static_cast<cadt_real>(c.points[i]), static_cast<cadt_real>(c.points[i + 1])});
      most.push_back(static_cast<cadt_real>(c.most));
    }
    std::vector<cadt_u32> words(cases.size());
#if defined(CADT_PLANT_FLUSH)
    _mm_setcsr(_mm_getcsr() | 0x8040u);
#elif defined(CADT_PLANT_ROUNDING)
    std::fesetround(CADT_PLANT_ROUNDING);
#endif
#if defined(CADT_VERIFIER)
    words = verifier_words(cases);
#else
    cadt_predicate_probe(0, 1, points.data(), most.data(), words.data(), count, count);
#endif
    std::fesetenv(FE_DFL_ENV);
    unsigned long signs = 0, stages = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const std::uint64_t bits = cases[i].word ^ words[i];
      if (bits != 0) (bits & 0xFFFFu ? signs : stages) += 1;
    }
    std::printf("%.*s %u %lu %lu\n", static_cast<int>(name.size()), name.data(), count, signs, stages);
  }
  return any ? 0 : 1;
}
