// SPDX-License-Identifier: Apache-2.0
// The host kernels with schedule noise (common/overlay/schedule_noise.dev.h), and an assertion of ownership at every
// store to a triangle. Linked before the library, this table replaces the real one.
#undef NDEBUG
#define CADT_WIDE 0
#define CADT_CHECKED
#define CADT_SCHEDULE_NOISE
#include "tests/robustness/concurrency/perturbed_table.hpp"

#include <thread>

namespace cadt::test {
std::atomic<std::uint64_t> site_counts[most_sites];
LockedCounts last_locked;
}  // namespace cadt::test

namespace {
inline void cadt_count_site(std::uint32_t site) {
  cadt::test::site_counts[site].fetch_add(1, std::memory_order_relaxed);
}
}  // namespace

#include "backends/host/kernel_table.ipp"

namespace {

static_assert(CADT_SITES <= cadt::test::most_sites);

// Its first work-item looks at all locked triangles before it counts; no kernel writes to them any more.
void flag_triangles(std::uint32_t item, std::uint32_t items, const cadt::Arg* args) {
  if (item == 0) {
    const auto* triangles = unpack<const cadt_locked_triangle*>(args[0]);
    const auto slots = unpack<cadt_u32>(args[2]);
    cadt::test::LockedCounts counts;
    for (cadt_u32 t = 0; t < slots; ++t) {
      const cadt_u32 lock = triangles[t].word[CADT_WORD_LOCK];
      counts.live += lock != 0 ? 1 : 0;
      counts.held += lock & 1;
    }
    cadt::test::last_locked = counts;
  }
  Trampoline<&cadt_flag_triangles>::run(item, items, args);
}

constexpr cadt::host::KernelTable with_counts() {
  cadt::host::KernelTable result = table;
  result[static_cast<std::size_t>(cadt::KernelId::cadt_flag_triangles)] = &flag_triangles;
  return result;
}

}  // namespace

namespace cadt::host {
constinit const KernelTable narrow_kernels = with_counts();
}

namespace cadt::test {
std::size_t number_of_sites() { return CADT_SITES; }
std::size_t index_of(Site site) {
  return site == Site::claimed    ? CADT_SITE_LOCKED
         : site == Site::released ? CADT_SITE_UNLOCKED
                                  : CADT_SITE_UNLOCKED_UNCHANGED;
}
}  // namespace cadt::test
