// SPDX-License-Identifier: Apache-2.0
#include "common/certify/certify.hpp"

#include <algorithm>
#include <vector>

#include "common/driver/counters.hpp"
#include "common/driver/device_text.hpp"
#include "common/insertion/insertion.hpp"

namespace cadt {

using namespace device_text;

namespace {

bool counts_work(const Context& ctx) { return ctx.options.statistics != StatisticsDetail::none; }

}  // namespace

std::size_t certify_words(const Context& ctx) {
  const std::size_t rows = counts_work(ctx) ? 1 + std::size_t{CADT_COUNTER_ROWS} : 1;
  return rows * CADT_COUNTER_STRIDE;
}

void launch_certify(Context& ctx, const DeviceMeshView& mesh, std::size_t begin, std::size_t size,
                    const Allocation& words, std::size_t row) {
  ctx.launcher.run<KernelId::cadt_certify>(mesh, begin, ctx.launcher.grid_strided(size), words, row, counts_work(ctx));
}

void read_certificate(Context& ctx, std::span<const std::uint32_t> words, std::size_t n) {
  const std::uint64_t edges = 3 * std::uint64_t{n} - 3;
  const std::uint32_t examined = words[0], illegal = words[1], wrong = words[2], broken = words[3];
  if (examined != edges || illegal != 0 || wrong != 0 || broken != 0)
    give_up("the mesh has ", examined, " edges, and there should be ", edges, "; ", illegal, " are illegal, ", wrong,
            " have sides that do not fit, ", broken, " turn back");
  ctx.statistics.legality_sweeps = std::max<std::uint64_t>(ctx.statistics.legality_sweeps, 1);
  ctx.statistics.certified_edges += examined;
  if (counts_work(ctx)) add_counters(ctx.statistics, words.subspan(CADT_COUNTER_STRIDE));
}

void certify(Context& ctx, const Mesh& mesh, std::size_t n) {
  const Allocation found = ctx.launcher.zeros(certify_words(ctx));
  const std::size_t most = slots_per_launch(ctx.device);
  for (std::size_t begin = 0; begin < mesh.all; begin += most) {
    const std::size_t size = std::min(most, mesh.all - begin);
    launch_certify(ctx, view_of(mesh, mesh.points), begin, size, found, 0);
    if (begin + size < mesh.all) ctx.device.finish();
    ctx.check("certify", 0.8 + 0.1 * static_cast<double>(begin + size) / static_cast<double>(mesh.all));
  }
  read_certificate(ctx, ctx.device.read_values(*found, certify_words(ctx)), n);
  ctx.end_phase("certify");
}

}  // namespace cadt
