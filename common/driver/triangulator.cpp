// SPDX-License-Identifier: Apache-2.0
// The whole run: order the points, build the mesh, number and write the triangles.
#include <cadt/triangulator.hpp>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/driver/registry.hpp"
#include "common/driver/session.hpp"
#include "common/driver/triangulation_data.hpp"
#include "common/insertion/insertion.hpp"
#include "common/output/renumber.hpp"
#include "common/points/device_points.hpp"
#include "common/points/import.hpp"
#include "common/points/spatial_sort.hpp"
#include "common/stars/mesh_from_stars.hpp"
#include "common/verify/device/verify_on_device.hpp"

namespace cadt {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);

/// Writes the arrays of the result where they are to be.
class Outputs {
 public:
  virtual ~Outputs() = default;
  /// `labels` are not needed any more after it. `points`: of the input.
  virtual void write(Context& ctx, Mesh& mesh, Allocation& input_ids, std::size_t points,
                     DeviceTriangulation::Data& data) = 0;

 protected:
  /// Whether the canonical order is made without a second array: to save memory, or since that second one would be in
  /// nothing that is kept.
  static bool in_place(const Context& ctx, const Mesh& mesh) noexcept {
    return mesh.in_arrays() && (ctx.saves_memory || ctx.memory.pools(mesh.slots * word));
  }
  static Numbering number(Context& ctx, const Mesh& mesh, const Allocation& input_ids, std::size_t points,
                          DeviceTriangulation::Data& data) {
    Numbering numbering = renumber(ctx, mesh, input_ids, points);
    data.triangle_count = numbering.triangles;
    ctx.check("collect", 0.95);
    return numbering;
  }
};

class OnDevice final : public Outputs {
 public:
  void write(Context& ctx, Mesh& mesh, Allocation& input_ids, std::size_t points,
             DeviceTriangulation::Data& data) override {
    if (in_place(ctx, mesh)) {
      data.triangle_count = renumber_in_place(ctx, mesh, input_ids, points);
      data.triangles = std::move(mesh.vertices);
      data.neighbors = std::move(mesh.half_edges);
      return;
    }
    emit(ctx, mesh, input_ids, number(ctx, mesh, input_ids, points, data), data);
  }

  static void emit(Context& ctx, Mesh& mesh, const Allocation& input_ids, const Numbering& numbering,
                   DeviceTriangulation::Data& data) {
    const std::size_t bytes = 3 * data.triangle_count * word;
    if (!mesh.in_arrays()) {
      data.triangles = ctx.memory.allocate(bytes);
      data.neighbors = ctx.memory.allocate(bytes);
      write_triangles(ctx, mesh, input_ids, numbering, data.triangles, data.neighbors);
    } else if (!numbering.numbers) {  // the arrays of the mesh become those of the result
      write_triangles(ctx, mesh, input_ids, numbering, mesh.vertices, mesh.half_edges);
      data.triangles = std::move(mesh.vertices);
      data.neighbors = std::move(mesh.half_edges);
    } else {  // one after the other, so that each takes the place of the one before
      data.neighbors = ctx.memory.allocate(bytes);
      write_triangles(ctx, mesh, input_ids, numbering, {}, data.neighbors);
      mesh.half_edges.release();
      data.triangles = ctx.memory.allocate(bytes);
      write_triangles(ctx, mesh, input_ids, numbering, data.triangles, {});
    }
  }
};

/// The arrays of a Triangulation if the device can write them, else copies on the device.
class OnHost final : public Outputs {
 public:
  explicit OnHost(Triangulation::Data& to) : to_(to) {}
  void write(Context& ctx, Mesh& mesh, Allocation& input_ids, std::size_t points,
             DeviceTriangulation::Data& data) override {
    if (in_place(ctx, mesh)) return on_device_.write(ctx, mesh, input_ids, points, data);
    const Numbering numbering = number(ctx, mesh, input_ids, points, data);
    const std::size_t values = 3 * data.triangle_count;
    to_.triangles = make_words(values);
    to_.neighbors = make_words(values);
    data.triangles = ctx.memory.export_to(to_.triangles.get(), values * word);
    data.neighbors = ctx.memory.export_to(to_.neighbors.get(), values * word);
    direct_ = data.triangles && data.neighbors;
    if (direct_)
      write_triangles(ctx, mesh, input_ids, numbering, data.triangles, data.neighbors);
    else
      OnDevice::emit(ctx, mesh, input_ids, numbering, data);
  }
  /// True if the arrays are filled when the device has finished.
  [[nodiscard]] bool direct() const noexcept { return direct_; }

 private:
  Triangulation::Data& to_;
  OnDevice on_device_;
  bool direct_ = false;
};

template <class Points>
void build(Context& ctx, const Points& points, std::size_t n, bool stars, Outputs& outputs,
           DeviceTriangulation::Data& data) {
  Statistics& statistics = data.statistics;
  ctx.check("sort", 0);
  Allocation input = import_points(ctx, points);
  ctx.end_phase("upload");
  ctx.regathers = std::is_same_v<Points, DevicePoints>;
  SortedPoints order = sort_spatially(ctx, std::move(input), n, stars);
  statistics.distinct = data.distinct = order.distinct;
  statistics.wide_arithmetic = order.wide;
  if constexpr (std::is_same_v<Points, DevicePoints>)
    order.points_again = [&](const SortedPoints& sorted) { return import_in_order(ctx, points, sorted); };
  data.duplicate_count = n - order.distinct;
  data.duplicate_points = std::move(order.duplicates);
  data.representatives = std::move(order.representatives);
  Mesh mesh = stars ? build_mesh(ctx, order) : insert_incrementally(ctx, order);
  order.points.release();
  if (mesh.flat) {
    data.dimension = order.distinct >= 2 ? 1 : 0;
    return;
  }
  data.dimension = 2;
  ctx.check("collect", 0.9);
  outputs.write(ctx, mesh, order.input_ids, n, data);
}

Triangulation to_host(const std::shared_ptr<Triangulator::State>& state, PointsView points) {
  require_size(points.size());
  auto result = std::make_unique<Triangulation::Data>();
  DeviceTriangulation::Data data;
  data.state = state;
  data.points = points.size();
  begin_call(*state, points.size(), data.statistics);
  if (points.size() != 0) {
    const bool saves = require_memory(*state, points.size(), {is_host(*state->device), false, points.scalar_size()});
    Context ctx(*state->device, state->memory, state->options, data.statistics);
    ctx.saves_memory = saves;
    OnHost outputs(*result);
    build(ctx, points, points.size(), prefers_stars(state->options, *state->device), outputs, data);
    ctx.end_phase("collect");
    if (data.dimension == 2) read_mesh(ctx, data, outputs.direct(), *result);
    read_duplicates(*state->device, data, *result);
    ctx.end_phase("copy");
    remember_size(*state, data.statistics, saves);
    end_call(*state, ctx, false);
  }
  result->points = data.points;
  result->triangle_count = data.triangle_count;
  result->dimension = data.dimension;
  result->statistics = std::move(data.statistics);
  return Triangulation(std::move(result));
}

DeviceTriangulation to_device(const std::shared_ptr<Triangulator::State>& state, const DevicePoints& points) {
  require_size(points.size);
  auto data = std::make_unique<DeviceTriangulation::Data>();
  data->state = state;
  data->points = points.size;
  begin_call(*state, points.size, data->statistics);
  if (points.size != 0) {
    const bool saves = require_memory(*state, points.size, {false, true, scalar_bytes(points.scalar)});
    Context ctx(*state->device, state->memory, state->options, data->statistics);
    ctx.saves_memory = saves;
    OnDevice outputs;
    build(ctx, points, points.size, prefers_stars(state->options, *state->device), outputs, *data);
    ctx.end_phase("collect");
    remember_size(*state, data->statistics, saves);
    end_call(*state, ctx, true);
  }
  return DeviceTriangulation(std::move(data));
}

/// Copies all to the host and verifies it there.
template <class Real>
VerifyReport verify_copy(Device& device, const Allocation& input, const DeviceTriangulation::Data& data,
                         std::span<const Duplicate> duplicates, const VerifyOptions& options) {
  std::vector<Real> xy(2 * data.points);
  if (!xy.empty()) device.read(*input, 0, xy.data(), xy.size() * sizeof xy[0]);
  std::vector<std::int32_t> triangles(3 * data.triangle_count), neighbors(triangles.size());
  if (!triangles.empty()) {
    device.read(*data.triangles, 0, triangles.data(), triangles.size() * word);
    device.read(*data.neighbors, 0, neighbors.data(), neighbors.size() * word);
  }
  MeshView view;
  view.triangles = triangles;
  view.neighbors = neighbors;
  view.duplicates = duplicates;
  view.has_duplicates = true;
  return cadt::verify(std::span<const Real>(xy), view, options);
}

}  // namespace

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

std::future<Triangulation> Triangulator::triangulate_async(PointsView points) {
  return std::async(std::launch::async, [state = state_, points] { return to_host(state, points); });
}

std::future<DeviceTriangulation> Triangulator::triangulate_async(const DevicePoints& points) {
  return std::async(std::launch::async, [state = state_, points] { return to_device(state, points); });
}

VerifyReport Triangulator::verify(const DevicePoints& points, const DeviceTriangulation& mesh,
                                  const VerifyOptions& options) {
  const DeviceTriangulation::Data& data = mesh.data();
  if (data.state != state_) throw InputError("the mesh is one of another triangulator", 0);
  if (points.size != data.points)
    throw InputError("the mesh is one of " + std::to_string(data.points) + " points",
                     std::min(points.size, data.points));
  Device& device = *state_->device;
  begin_budget(*state_, data.points);
  Statistics statistics;
  Context ctx(device, state_->memory, state_->options, statistics);
  Triangulation::Data host;
  read_duplicates(device, data, host);
  const Allocation input = points.size == 0 ? Allocation() : import_points(ctx, points);
  // The verifier's kernels need double precision.
  if (takes_floats_only(device)) return verify_copy<float>(device, input, data, host.duplicates, options);
  if (data.triangle_count == 0) return verify_copy<double>(device, input, data, host.duplicates, options);
  const VerifyInput what{input, data.triangles, data.neighbors, data.points, data.triangle_count, {}, host.duplicates,
                         true};
  return verify_on_device(ctx, what, options);
}

std::size_t Triangulator::memory_needed(std::size_t points) const noexcept {
  return most_bytes(state_->memory, points, prefers_stars(state_->options, *state_->device));
}

void Triangulator::reserve(std::size_t points) {
  require_size(points);
  const std::size_t n = points, limit = state_->options.max_memory;
  Memory& memory = state_->memory;
  begin_budget(*state_, n);
  (void)require_memory(*state_, n, {false, true, sizeof(double)});
  if (n <= state_->reserved_points) return;
  if (!memory.keeps()) {
    state_->device->reserve(least_bytes(n, false));
  } else if (const bool stars = prefers_stars(state_->options, *state_->device);
             limit == 0 || most_bytes(memory, n, stars) <= limit) {
    memory.drop_kept();  // too small
    begin_budget(*state_, n);
    reserve_buffers(memory, n, stars);
  } else {
    return;  // enough for a call, but not for keeping all of its buffers
  }
  state_->reserved_points = n;
  state_->known_points = std::max(state_->known_points, n);
}

void Triangulator::release_memory() {
  state_->memory.drop_kept();
  state_->device->trim();
  state_->forget_sizes();
}

Triangulation triangulate(PointsView points, const Options& options) {
  require_size(points.size());
  return to_host(std::make_shared<Triangulator::State>(options, open_device(options), false), points);
}

}  // namespace cadt
