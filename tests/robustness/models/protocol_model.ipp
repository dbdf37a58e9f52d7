// SPDX-License-Identifier: Apache-2.0
// The kernels' own text under relacy, which runs three threads step by step in random order and lets each load see any
// value that C++ allows. CADT_CONTIGUOUS is set by the including file: 1 for the memory orders of CPUs, 0 for those of
// GPUs, where fields are relaxed, fences order, and the owner reads its triangles again.
//
// Locks, validation, splits, flips and walks are those of lock.dev.h, split.dev.h, flip.dev.h and locate.dev.h; three
// threads split and flip in a mesh of eight vertices.
#include "tests/robustness/models/protocol.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <ostream>
#include <streambuf>
#include <string>
#include <thread>

// Where std::atomic_ref is in the text of atomics.dev.h there is a word of the model instead.
namespace {
namespace words {
std::uint32_t load(const std::uint32_t* word, std::memory_order order);
void store(std::uint32_t* word, std::uint32_t value, std::memory_order order);
bool compare_exchange(std::uint32_t* word, std::uint32_t& expected, std::uint32_t desired, std::memory_order order);
std::uint32_t fetch_add(std::uint32_t* word, std::uint32_t value, std::memory_order order);
std::uint32_t fetch_or(std::uint32_t* word, std::uint32_t value, std::memory_order order);
void fence(std::memory_order order);
void assert_owned(bool owned);

template <class T>
struct Reference {
  T* word;
  explicit Reference(T& at) : word(&at) {}
  T load(std::memory_order order) const { return words::load(word, order); }
  void store(T value, std::memory_order order) const { words::store(word, value, order); }
  T fetch_add(T value, std::memory_order order) const { return words::fetch_add(word, value, order); }
  T fetch_or(T value, std::memory_order order) const { return words::fetch_or(word, value, order); }
  bool compare_exchange_strong(T& expected, T desired, std::memory_order order,
                               std::memory_order = std::memory_order_relaxed) const {
    return compare_exchange(word, expected, desired, order);
  }
  bool compare_exchange_weak(T& expected, T desired, std::memory_order order) const {
    return compare_exchange(word, expected, desired, order);
  }
};
}  // namespace words
}  // namespace
namespace std {
template <class T>
using cadt_model_reference = words::Reference<T>;
}

namespace {
inline void cadt_assert_owned(std::uint32_t owned) { words::assert_owned(owned != 0); }
#if !CADT_CONTIGUOUS
// The host has none; as GPUs have it.
inline void cadt_fence_acq_rel() { words::fence(std::memory_order_acq_rel); }
#endif

#define CADT_CHECKED
#define atomic_ref cadt_model_reference
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "common/insertion/insert.dev.h"
#include "common/insertion/seed_triangle.dev.h"
#pragma GCC diagnostic pop
#undef atomic_ref
}  // namespace

// relacy gives the words of the C library other meanings, so it comes last.
#include <relacy/relacy.hpp>
#undef memory_order_relaxed
#undef memory_order_acquire
#undef memory_order_release
#undef memory_order_acq_rel

namespace {
namespace words {

constexpr std::size_t vertices = 8, threads = 3;

// Only addresses: what is in the words the model knows, or `plain` while the mesh is made by one thread.
struct Memory {
  cadt_locked_triangle locked[2 * vertices];
  cadt_u32 vertex_to_triangle[vertices];
};
Memory plain;
constexpr std::size_t count = sizeof(Memory) / sizeof(cadt_u32);
rl::atomic<cadt_u32>* cells = nullptr;  // null: `plain` is meant

std::size_t place(const std::uint32_t* word) {
  return static_cast<std::size_t>(word - reinterpret_cast<const std::uint32_t*>(&plain));
}
rl::memory_order order_of(std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      return rl::mo_relaxed;
    case std::memory_order_acquire:
      return rl::mo_acquire;
    case std::memory_order_release:
      return rl::mo_release;
    default:
      return rl::mo_acq_rel;
  }
}

std::uint32_t load(const std::uint32_t* word, std::memory_order order) {
  return cells == nullptr ? *word : cells[place(word)].load(order_of(order), RL_INFO);
}
void store(std::uint32_t* word, std::uint32_t value, std::memory_order order) {
  if (cells == nullptr)
    *word = value;
  else
    cells[place(word)].store(value, order_of(order), RL_INFO);
}
bool compare_exchange(std::uint32_t* word, std::uint32_t& expected, std::uint32_t desired, std::memory_order order) {
  if (cells != nullptr)
    return cells[place(word)].compare_exchange_strong(expected, desired, order_of(order), RL_INFO, rl::mo_relaxed,
                                                      RL_INFO);
  if (*word != expected) return false;
  *word = desired;
  return true;
}
std::uint32_t fetch_add(std::uint32_t* word, std::uint32_t value, std::memory_order order) {
  if (cells != nullptr) return cells[place(word)].fetch_add(value, order_of(order), RL_INFO);
  *word += value;
  return *word - value;
}
std::uint32_t fetch_or(std::uint32_t* word, std::uint32_t value, std::memory_order order) {
  if (cells != nullptr) return cells[place(word)].fetch_or(value, order_of(order), RL_INFO);
  const std::uint32_t old = *word;
  *word |= value;
  return old;
}
[[maybe_unused]] void fence(std::memory_order order) {
  if (cells != nullptr) rl::atomic_thread_fence(order_of(order), RL_INFO);
}
void assert_owned(bool owned) {
  if (cells != nullptr) RL_ASSERT(owned && "a store to a record that nobody holds");
}

}  // namespace words

using words::cells, words::plain, words::vertices, words::threads, model::Totals;

// Found by trial: each of three edges of the mesh of the first six is illegal, and the two others lie beside them.
const std::array<cadt_point, vertices> points = {
    {{0.1, 0.1}, {0.9, 0.12}, {0.45, 0.9}, {0.46, 0.72}, {0.29, 0.41}, {0.85, 0.18}, {0.35, 0.44}, {0.3, 0.32}}};
constexpr cadt_u32 from_start = 6;  // vertices of the mesh that the threads find; they insert the others

cadt_locked_mesh view() {
  cadt_locked_mesh mesh{};
  mesh.locked = plain.locked;
  mesh.points = points.data();
  mesh.vertex_to_triangle = plain.vertex_to_triangle;
  mesh.second = 1;
  mesh.third = 2;
  mesh.center = {(points[0].x + points[1].x + points[2].x) / 3, (points[0].y + points[1].y + points[2].y) / 3};
  return mesh;
}

struct Start {
  std::array<cadt_u32, words::count> image{};
  std::array<cadt_u32, 16> illegal{};  // links of edges; no vector: relacy keeps its own book of memory
  std::size_t illegal_size = 0;
};

// A mesh that has not been legalised, so that there is something to flip.
Start make_start() {
  cells = nullptr;
  plain = {};
  const cadt_locked_mesh mesh = view();
  cadt_counters counters;
  cadt_counters_clear(&counters);
  cadt_make_seed_mesh(&mesh, &counters);
  for (cadt_u32 i = 3; i < from_start; ++i) {
    cadt_u32 hint = 0, edges[4];
    if (cadt_try_insert(&mesh, i, points[i], &hint, edges, &counters) == 0) std::abort();
    plain.vertex_to_triangle[i] = hint;
  }
  Start start;
  std::memcpy(start.image.data(), &plain, sizeof plain);
  for (cadt_u32 t = 0; t < 2 * vertices; ++t)
    for (cadt_u32 k = 0; k < 3 && plain.locked[t].word[CADT_WORD_LOCK] != 0; ++k) {
      const cadt_snapshot s = cadt_snapshot_from(&mesh, t, k);
      if (CADT_TRIANGLE_OF(s.n0) < t) continue;
      const cadt_snapshot u = cadt_snapshot_from(&mesh, CADT_TRIANGLE_OF(s.n0), CADT_EDGE_OF(s.n0));
      if (cadt_is_illegal(&mesh, s.v0, s.v1, s.v2, u.v0, &counters))
        start.illegal.at(start.illegal_size++) = CADT_HALF_EDGE(t, k);
    }
  return start;
}

const Start& start() {
  static const Start made = make_start();
  return made;
}

Totals totals;

struct SplitsAndFlips : rl::test_suite<SplitsAndFlips, threads> {
  rl::atomic<cadt_u32> memory[words::count];
  std::array<cadt_counters, threads> tallies;

  void before() {
    cells = memory;
    for (std::size_t w = 0; w < words::count; ++w) memory[w].store(start().image[w], rl::mo_relaxed, RL_INFO);
    for (cadt_counters& counters : tallies) cadt_counters_clear(&counters);
  }

  // The first flips, the second inserts and flips what it finds illegal, the third does both.
  void thread(unsigned index) {
    const cadt_locked_mesh mesh = view();
    cadt_counters& counters = tallies[index];
    const std::size_t size_of_illegal = start().illegal_size;
    for (std::size_t e = 0; index != 1 && e < size_of_illegal; ++e)
      flip(mesh, start().illegal[index == 0 ? e : size_of_illegal - 1 - e], CADT_NONE, counters);
    if (index == 0) return;
    const cadt_u32 i = from_start - 1 + index;
    cadt_u32 hint = cadt_load_relaxed(mesh.vertex_to_triangle + 3), edges[4], size = 0;
    for (int tries = 0; tries < 3 && size == 0; ++tries)
      size = cadt_try_insert(&mesh, i, points[i], &hint, edges, &counters);
    for (cadt_u32 e = 0; e < size; ++e) flip(mesh, edges[e], i, counters);
  }

  static void flip(const cadt_locked_mesh& mesh, cadt_u32 link, cadt_u32 apex, cadt_counters& counters) {
    cadt_u32 partner = 0, all_sides = 0;
    const cadt_point at = apex == CADT_NONE ? cadt_point{0, 0} : points[apex];
    for (int tries = 0; tries < 2; ++tries)
      if (cadt_flip_if_illegal(&mesh, link, apex, at, &partner, &all_sides, &counters) != CADT_EDGE_CONFLICT) return;
  }

  void after() {
    const cadt_locked_mesh mesh = view();
    cadt_counters none;
    cadt_counters_clear(&none);
    std::uint64_t splits = 0, live = 0;
    for (const cadt_counters& counters : tallies) {
      splits += counters.count[CADT_COUNT_SPLITS] + counters.count[CADT_COUNT_EDGE_SPLITS];
      totals.flips += counters.count[CADT_COUNT_FLIPS];
      totals.lost += counters.count[CADT_COUNT_LOCK_FAILURES];
      totals.invalid += counters.count[CADT_COUNT_INVALIDATED];
    }
    totals.splits += splits;
    for (cadt_u32 t = 0; t < 2 * vertices; ++t) {
      const cadt_snapshot s = cadt_snapshot_of(&mesh, t);
      RL_ASSERT((s.lock & 1u) == 0u && "a record is held at the end");
      if (s.lock == 0) continue;
      ++live;
      const bool ghost = s.v0 == CADT_GHOST || s.v1 == CADT_GHOST || s.v2 == CADT_GHOST;
      RL_ASSERT((ghost || cadt_orientation(points[s.v0], points[s.v1], points[s.v2], &none) > 0) &&
                "a triangle is not counterclockwise");
      for (cadt_u32 k = 0; k < 3; ++k) {
        const cadt_u32 across = CADT_NEIGHBOR(s, k), n = CADT_TRIANGLE_OF(across);
        RL_ASSERT(n < 2 * vertices && CADT_EDGE_OF(across) < 3 && "a link to nowhere");
        const cadt_snapshot u = cadt_snapshot_from(&mesh, n, CADT_EDGE_OF(across));
        RL_ASSERT(u.lock != 0 && u.n0 == CADT_HALF_EDGE(t, k) && "a neighbour does not know its neighbour");
        RL_ASSERT(u.v1 == CADT_VERTEX(s, CADT_PREV(k)) && u.v2 == CADT_VERTEX(s, CADT_NEXT(k)) &&
                  "neighbours do not share an edge");
      }
    }
    RL_ASSERT(live == 2 * (from_start + splits) - 2 && "triangles are lost");
    cells = nullptr;
  }
};

// Nothing but a triangle that three threads lock and change, and one that is held all the time: the fields must be
// those of the version. A small model, so that rare interleavings come up.
struct Claims : rl::test_suite<Claims, threads> {
  rl::atomic<cadt_u32> memory[words::count];
  cadt_u32 changes[threads];

  static constexpr cadt_u32 fields[] = {0, 1, 2, 4, 5, 6};
  static cadt_u32 expected(cadt_u32 version) { return 4 * version; }  // also a link to record `version`

  void before() {
    cells = memory;
    for (auto& cell : memory) cell.store(0, rl::mo_relaxed, RL_INFO);
    for (const cadt_u32 field : fields) memory[field].store(expected(2), rl::mo_relaxed, RL_INFO);
    memory[CADT_WORD_LOCK].store(2, rl::mo_relaxed, RL_INFO);
    memory[8 + CADT_WORD_LOCK].store(3, rl::mo_relaxed, RL_INFO);
    for (cadt_u32& count : changes) count = 0;
  }

  static cadt_lock_set claim_of(cadt_u32 version, cadt_u32 second) {
    return {{0, second, CADT_NONE, CADT_NONE}, {version, CADT_ANY_VERSION, 0, 0}};
  }

  void thread(unsigned index) {
    const cadt_locked_mesh mesh = view();
    cadt_counters counters;
    cadt_counters_clear(&counters);
    for (int round = 0; round < 2; ++round) {
      if (index == 1) { /* loses the second record, gives the first one back */
        cadt_lock_set claim = claim_of(CADT_ANY_VERSION, 1);
        RL_ASSERT(!cadt_try_lock(&mesh, &claim, &counters) && "a record that is held was claimed");
        continue;
      }
      cadt_snapshot s = cadt_snapshot_of(&mesh, 0);
      if (!cadt_is_unlocked(s.lock)) continue;
      cadt_lock_set claim = claim_of(s.lock, CADT_NONE);
      if (!cadt_try_lock(&mesh, &claim, &counters)) continue;
      if (!cadt_validate(&mesh, 0, 0, CADT_HALF_EDGES_ALL, &s)) {
        cadt_unlock_invalid(&mesh, &claim, &counters);
        continue;
      }
      const cadt_u32 now = expected(claim.version[0]), next = expected(claim.version[0] + 2);
      RL_ASSERT(s.v0 == now && s.v1 == now && s.v2 == now && s.n0 == now && s.n1 == now && s.n2 == now &&
                "a claim was won with fields of another version");
      cadt_store_vertices(&mesh, 0, next, next, next);
      for (cadt_u32 k = 0; k < 3; ++k) cadt_store_half_edge(&mesh, 0, k, next);
      cadt_fence_before_unlock();
      cadt_unlock(&mesh, &claim);
      ++changes[index];
    }
  }

  void after() {
    const cadt_locked_mesh mesh = view();
    const cadt_snapshot s = cadt_snapshot_of(&mesh, 0);
    RL_ASSERT(s.lock == 2 + 2 * (changes[0] + changes[2]) && s.v0 == expected(s.lock) && "a change is lost");
    cells = nullptr;
  }
};

// No string stream: relacy keeps a book of all memory, of its own messages too.
struct FixedText : std::streambuf {
  char text[2000] = {};
  FixedText() { setp(text, text + sizeof text - 1); }
  int overflow(int character) override { return character; }
};

template <class Suite>
bool search(unsigned long runs, std::string& says) {
  FixedText text;
  std::ostream told(&text);
  rl::test_params parameters;
  parameters.output_stream = &told;
  parameters.progress_stream = &told;
  parameters.iteration_count = static_cast<rl::iteration_t>(runs);
  parameters.execution_depth_limit = 100000;
  const bool passed = rl::simulate<Suite>(parameters);
  cells = nullptr;
  says += text.text;
  return passed;
}

}  // namespace

namespace model {
Found CADT_MODEL_SEARCH(unsigned long runs) {
  totals = {};
  Found found;
  found.illegal = start().illegal_size;  // made before relacy takes over
  found.claims_passed = search<Claims>(10 * runs, found.text);
  if (found.claims_passed) found.mesh_passed = search<SplitsAndFlips>(runs, found.text);
  found.totals = totals;
  return found;
}

}  // namespace model
