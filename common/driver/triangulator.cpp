// SPDX-License-Identifier: Apache-2.0
// A call from points to result: sort the points, build the mesh, number and write the triangles.
#include <cadt/triangulator.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/constraints/constraints.hpp"
#include "common/driver/build.hpp"
#include "common/driver/choose_strategy.hpp"
#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/driver/gpu_bound.hpp"
#include "common/driver/registry.hpp"
#include "common/driver/session.hpp"
#include "common/driver/start_async.hpp"
#include "common/driver/thread_state.hpp"
#include "common/driver/triangulation_data.hpp"
#include "common/output/renumber.hpp"
#include "common/points/device_points.hpp"
#include "common/points/import.hpp"
#include "common/points/spatial_sort.hpp"
#include "common/verify/device/verify_on_device.hpp"

namespace cadt {
namespace {

using device_text::word;

/// Of the fractions that are reported: without segments a mesh is there at 0.8, with segments at 0.56.
constexpr double share_before_segments = 0.7;

/// Sorts the points, builds their mesh, with segments as edges if there is a `job`, and writes the result; what is
/// written straight to memory of the host goes to `host`.
void triangulate_into(Context& ctx, const InputPoints& input, Triangulation::Data* host, EarlyArrays& arrays,
                      DeviceTriangulation::Data& data, SegmentJob* job) {
  ctx.result_on_host = host != nullptr;
  const std::size_t n = input.size();
  if (job != nullptr) ctx.begin_share(0, share_before_segments);
  ctx.check("sort", 0);
  Allocation imported = input.import(ctx);
  ctx.end_phase("upload");
  SortedPoints points = sort_spatially(ctx, std::move(imported), n, may_use_stars(traits_of(ctx.device), ctx.options));
  data.statistics.distinct = data.distinct = points.distinct;
  data.statistics.wide_arithmetic = points.wide;
  data.duplicate_count = n - points.distinct;
  data.duplicate_points = std::move(points.duplicates);
  data.representatives = std::move(points.representatives);
  if (host != nullptr && ctx.device.info().gpu) arrays.begin(6 * points.distinct, ctx.options.threads);
  const KeyGrid grid = points.grid;
  const double scale = points.scale, scale_again = points.scale_again;
  Mesh mesh = build(ctx, std::move(points), input, job != nullptr ? MeshUse::constrained : MeshUse::whole);
  data.dimension = mesh.flat ? (data.distinct >= 2 ? 1 : 0) : 2;
  if (mesh.flat) return;
  if (job != nullptr) {
    mesh.scale = scale;
    mesh.scale_again = scale_again;
    constrain(ctx, mesh, grid, n, data.distinct, {data.duplicate_points, data.representatives, data.duplicate_count},
              *job);
    if (job->crossed) return;
    mesh.points.release();
  }
  ctx.check("output", 0.9);
  write_result(ctx, mesh, n);
  if (job != nullptr && job->rounded_places != nullptr)
    job->suspects = certify_places(ctx, mesh, *job->rounded_places, job->exact_points);
  if (job != nullptr) job->edge_flags = std::move(mesh.edge_flags);
  data.triangle_count = mesh.triangles;
  data.triangles = std::move(mesh.vertices.device);
  data.neighbors = std::move(mesh.across.device);
  if (host == nullptr) return;
  host->triangles = std::move(mesh.vertices.host);
  host->neighbors = std::move(mesh.across.host);
}

/// A whole call; `host` is null if the result stays on the device.
void run_call(const std::shared_ptr<Triangulator::State>& state, const InputPoints& points, const CallShape& shape,
              Triangulation::Data* host, DeviceTriangulation::Data& data, SegmentJob* job = nullptr,
              SegmentResults* segments = nullptr) {
  data.state = state;
  data.points = shape.points;
  begin_call(*state, shape.points, data.statistics);
  if (shape.points == 0) return;
  const MemoryPlan plan = plan_call(*state, shape);
  Context ctx(*state->device, state->memory, state->options, data.statistics, plan);
  EarlyArrays arrays;
  triangulate_into(ctx, points, host, arrays, data, job);
  ctx.end_phase("output");
  if (host != nullptr) {
    if (data.triangle_count != 0) read_mesh(ctx, data, *host, arrays);
    if (segments != nullptr) *segments = read_results(ctx, *job, data.triangle_count);
    host->duplicates = read_duplicates(data);
    ctx.end_phase("copy");
  }
  remember_size(*state, data.statistics, plan);
  end_call(*state, ctx, host == nullptr);
}

/// A call whose result is wanted on the host.
std::unique_ptr<Triangulation::Data> run_to_host(const std::shared_ptr<Triangulator::State>& state,
                                                 const InputPoints& points, const CallShape& shape,
                                                 SegmentJob* job = nullptr, SegmentResults* segments = nullptr) {
  require_size(shape.points);
  auto result = std::make_unique<Triangulation::Data>();
  DeviceTriangulation::Data data;  // after the result, which it may alias
  run_call(state, points, shape, result.get(), data, job, segments);
  result->points = data.points;
  result->triangle_count = data.triangle_count;
  result->dimension = data.dimension;
  result->constrained = job != nullptr;
  result->statistics = std::move(data.statistics);
  return result;
}

Triangulation to_host(const std::shared_ptr<Triangulator::State>& state, PointsView points, KeepPoints keep,
                      SegmentJob* job = nullptr, SegmentResults* segments = nullptr) {
  auto result =
      run_to_host(state, points, {points.size(), is_host(*state->device), false, points.scalar_size()}, job, segments);
  give_points(*result, points, keep);
  return Triangulation(std::move(result));
}

Triangulation to_host(const std::shared_ptr<Triangulator::State>& state, PointsView points) {
  return to_host(state, points, state->options.keep_points);
}

DeviceTriangulation to_device(const std::shared_ptr<Triangulator::State>& state, const DevicePoints& points) {
  return DeviceTriangulation(triangulate_on_device(state, points));
}

/// \throws InputError if `triangles` do not fit in an array of `size` words
void require_words(std::size_t size, std::size_t triangles, const char* name) {
  if (size == 0 || size >= 3 * triangles) return;
  throw InputError(std::string("the array for ") + name + " has " + std::to_string(size) + " elements, " +
                       std::to_string(3 * triangles) + " are needed; 6 a point are always enough",
                   size / 3);
}

/// Copies the mesh to arrays of `sizes` words (triangles, neighbours; 0: left out) by `copy`. Returns the number of
/// triangles.
template <class Copy>
std::size_t give_mesh(const DeviceTriangulation::Data& data, std::array<std::size_t, 2> sizes, const Copy& copy) {
  const std::size_t count = data.triangle_count;
  require_words(sizes[0], count, "triangles");
  require_words(sizes[1], count, "neighbors");
  if (count == 0) return 0;
  if (sizes[0] != 0) copy(data.triangles, 0);
  if (sizes[1] != 0) copy(data.neighbors, 1);
  data.state->device->finish();
  return count;
}

/// Copies points and mesh to the host and verifies them there.
template <class Real>
VerifyReport verify_copy(Device& device, const Allocation& input, const DeviceTriangulation::Data& data,
                         std::span<const Duplicate> duplicates, const VerifyOptions& options) {
  std::vector<Real> xy;
  std::vector<std::int32_t> triangles, neighbors;
  std::vector<std::uint32_t> flags;
  if (input) xy = device.read_values<Real>(*input, 2 * data.points);
  if (const std::size_t values = 3 * data.triangle_count; values != 0) {
    triangles = device.read_values<std::int32_t>(*data.triangles, values);
    neighbors = device.read_values<std::int32_t>(*data.neighbors, values);
    if (data.edge_flags) flags = device.read_values<std::uint32_t>(*data.edge_flags, data.triangle_count);
  }
  MeshView view;
  view.triangles = triangles;
  view.neighbors = neighbors;
  view.duplicates = duplicates;
  view.has_duplicates = true;
  view.edge_flags = flags;
  return cadt::verify(std::span<const Real>(xy), view, options);
}

}  // namespace

std::unique_ptr<DeviceTriangulation::Data> triangulate_on_device(const std::shared_ptr<Triangulator::State>& state,
                                                                 const DevicePoints& points, SegmentJob* job) {
  require_size(points.size);
  auto data = std::make_unique<DeviceTriangulation::Data>();
  run_call(state, points, {points.size, false, true, scalar_bytes(points.scalar)}, nullptr, *data, job);
  if (job != nullptr) data->edge_flags = std::move(job->edge_flags);
  return data;
}

Triangulation triangulate_on_host(const std::shared_ptr<Triangulator::State>& state, PointsView points) {
  return to_host(state, points);
}

Triangulation triangulate_with_segments(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                                        SegmentJob& job, SegmentResults& segments, KeepPoints keep) {
  return to_host(state, points, keep, &job, &segments);
}

std::unique_ptr<Triangulation::Data> triangulate_with_segments(const std::shared_ptr<Triangulator::State>& state,
                                                               const DevicePoints& points, SegmentJob& job,
                                                               SegmentResults& segments) {
  return run_to_host(state, points, {points.size, is_host(*state->device), true, scalar_bytes(points.scalar)}, &job,
                     &segments);
}

Triangulator::Triangulator(const Options& options)
    : state_(std::make_shared<State>(options, open_device(options), true)) {}
Triangulator::~Triangulator() = default;
Triangulator::Triangulator(Triangulator&&) noexcept = default;
Triangulator& Triangulator::operator=(Triangulator&&) noexcept = default;

const DeviceInfo& Triangulator::device() const noexcept { return state_->device->info(); }
Options& Triangulator::options() noexcept { return state_->options; }

std::optional<double> Triangulator::occupancy(unsigned work_group_size) const {
  return state_->device->occupancy(work_group_size);
}

Triangulation Triangulator::triangulate(PointsView points) { return to_host(state_, points); }

DeviceTriangulation Triangulator::triangulate(const DevicePoints& points) { return to_device(state_, points); }

std::size_t Triangulator::triangulate(PointsView points, std::span<std::int32_t> triangles,
                                      std::span<std::int32_t> neighbors) {
  require_size(points.size());
  DeviceTriangulation::Data data;
  run_call(state_, points, {points.size(), false, false, points.scalar_size()}, nullptr, data);
  return give_mesh(data, {triangles.size(), neighbors.size()}, [&](const Allocation& from, std::size_t which) {
    state_->device->read(*from, 0, (which == 0 ? triangles : neighbors).data(), 3 * data.triangle_count * word);
  });
}

std::size_t Triangulator::triangulate(const DevicePoints& points, const DeviceArray& triangles,
                                      const DeviceArray& neighbors) {
  for (const DeviceArray* array : {&triangles, &neighbors})
    if (array->size != 0 && array->memory == nullptr)
      throw InputError("an array of results has no memory: DeviceArray::memory is null", 0);
  require_size(points.size);
  DeviceTriangulation::Data data;
  run_call(state_, points, {points.size, false, true, scalar_bytes(points.scalar)}, nullptr, data);
  Statistics statistics;
  Context ctx(*state_->device, state_->memory, state_->options, statistics);
  return give_mesh(data, {triangles.size, neighbors.size}, [&](const Allocation& from, std::size_t which) {
    const DeviceArray& to = which == 0 ? triangles : neighbors;
    const Allocation array = ctx.memory.wrap(to.memory, to.size * word);
    ctx.launcher.run<KernelId::cadt_copy_words>(from, array, 0U, ctx.launcher.grid_strided(3 * data.triangle_count));
  });
}

std::future<Triangulation> Triangulator::triangulate_async(PointsView points) {
  return start_async([state = state_, points] { return to_host(state, points); });
}

std::future<DeviceTriangulation> Triangulator::triangulate_async(const DevicePoints& points) {
  return start_async([state = state_, points] { return to_device(state, points); });
}

VerifyReport Triangulator::verify(const DevicePoints& points, const DeviceTriangulation& mesh,
                                  const VerifyOptions& options) {
  const DeviceTriangulation::Data& data = mesh.data();
  if (data.state != state_) throw InputError("the mesh is one of another triangulator", 0);
  if (data.moved || data.added != 0)
    throw InputError(
        "crossings of segments have moved or added points: verify download_constrained() with the segments", 0);
  if (points.size != data.points)
    throw InputError("the mesh is one of " + std::to_string(data.points) + " points",
                     std::min(points.size, data.points));
  Device& device = *state_->device;
  begin_budget(*state_, data.points);
  Statistics statistics;
  Context ctx(device, state_->memory, state_->options, statistics);
  const std::vector<Duplicate> duplicates = read_duplicates(data);
  const Allocation input = points.size == 0 ? Allocation() : import_points(ctx, points);
  // The verifier's kernels need double precision.
  if (takes_floats_only(device)) return verify_copy<float>(device, input, data, duplicates, options);
  if (data.triangle_count == 0) return verify_copy<double>(device, input, data, duplicates, options);
  const auto count = static_cast<std::uint32_t>(data.triangle_count);
  const VerifyInput what{
      {input, data.triangles, data.neighbors, data.edge_flags, count, count, 0}, data.points, {}, duplicates, true};
  return verify_on_device(ctx, what, options);
}

std::size_t Triangulator::memory_needed(std::size_t points) const noexcept {
  if (points > max_points()) return std::numeric_limits<std::size_t>::max();
  return most_bytes(state_->memory, points, may_use_stars(traits_of(*state_->device), state_->options));
}

void Triangulator::reserve(std::size_t points) {
  require_size(points);
  const std::size_t n = points, limit = state_->options.max_memory;
  Memory& memory = state_->memory;
  begin_budget(*state_, n);
  (void)plan_call(*state_, {n, false, true, sizeof(double)});
  KnownSizes& known = state_->known;
  if (n <= known.reserved) return;
  if (!memory.caches()) {
    state_->device->reserve(most_bytes(memory, n, false));
  } else if (const bool stars = may_use_stars(traits_of(*state_->device), state_->options);
             limit == 0 || most_bytes(memory, n, stars) <= limit) {
    memory.drop_cached();  // too small
    begin_budget(*state_, n);
    reserve_buffers(memory, n, stars);
  } else {
    return;  // enough for a call, but not for caching all of its buffers
  }
  known.reserved = n;
  known.insertion = std::max(known.insertion, n);
}

std::shared_ptr<void> Triangulator::allocate(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  struct Held {
    std::shared_ptr<State> state;  // first member: destroyed last, after the memory
    Allocation memory;
  };
  const auto held = std::make_shared<Held>(Held{state_, state_->memory.allocate(bytes)});
  return {held, state_->device->handle(*held->memory)};
}

void Triangulator::release_memory() {
  state_->memory.drop_cached();  // the next budget forgets the known sizes
  state_->device->trim();
}

Triangulation triangulate(PointsView points, const Options& options) {
  require_size(points.size());
  const CallState state(options, points.size());
  Triangulation mesh = to_host(*state, points);
  const DeviceInfo& device = (*state)->device->info();
  if (device.gpu && is_free_to_choose(options)) measure_gpu_bound(device, options);
  return mesh;
}

}  // namespace cadt
