// SPDX-License-Identifier: Apache-2.0
// The whole run: order the points, build the mesh, number and write the triangles.
#include <cadt/triangulator.hpp>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/host/build_mesh.hpp"
#include "common/host/call.hpp"
#include "common/host/collect.hpp"
#include "common/host/device_points.hpp"
#include "common/host/device_triangulation.hpp"
#include "common/host/input_points.hpp"
#include "common/host/registry.hpp"
#include "common/host/run.hpp"
#include "common/host/spatial_order.hpp"
#include "common/host/star_stage.hpp"
#include "common/host/triangulation_data.hpp"
#include "common/host/verify_on_device.hpp"

namespace cadt {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);

/// Writes the arrays of the result where they are to be.
class Outputs {
 public:
  virtual ~Outputs() = default;
  /// `labels` are not needed any more after it. `points`: of the input.
  virtual void write(Run& run, DeviceMesh& mesh, Allocation& labels, std::size_t points,
                     DeviceTriangulation::Data& data) = 0;

 protected:
  /// Whether the canonical order is made without a second array: to save memory, or since that second one would be in
  /// nothing that is kept.
  static bool in_place(const Run& run, const DeviceMesh& mesh) noexcept {
    return mesh.in_arrays() && (run.saves_memory || run.memory.lends(mesh.slots * word));
  }
  static Numbering number(Run& run, const DeviceMesh& mesh, const Allocation& labels, std::size_t points,
                          DeviceTriangulation::Data& data) {
    Numbering numbering = number_triangles(run, mesh, labels, points);
    data.triangle_count = numbering.triangles;
    run.check("collect", 0.95);
    return numbering;
  }
};

class OnDevice final : public Outputs {
 public:
  void write(Run& run, DeviceMesh& mesh, Allocation& labels, std::size_t points,
             DeviceTriangulation::Data& data) override {
    if (in_place(run, mesh)) {
      data.triangle_count = emit_in_place(run, mesh, labels, points);
      data.triangles = std::move(mesh.vertices);
      data.neighbors = std::move(mesh.links);
      return;
    }
    emit(run, mesh, labels, number(run, mesh, labels, points, data), data);
  }

  static void emit(Run& run, DeviceMesh& mesh, const Allocation& labels, const Numbering& numbering,
                   DeviceTriangulation::Data& data) {
    const std::size_t bytes = 3 * data.triangle_count * word;
    if (!mesh.in_arrays()) {
      data.triangles = run.memory.allocate(bytes);
      data.neighbors = run.memory.allocate(bytes);
      emit_triangles(run, mesh, labels, numbering, data.triangles, data.neighbors);
    } else if (!numbering.numbers) {  // the arrays of the mesh become those of the result
      emit_triangles(run, mesh, labels, numbering, mesh.vertices, mesh.links);
      data.triangles = std::move(mesh.vertices);
      data.neighbors = std::move(mesh.links);
    } else {  // one after the other, so that each takes the place of the one before
      data.neighbors = run.memory.allocate(bytes);
      emit_triangles(run, mesh, labels, numbering, {}, data.neighbors);
      mesh.links.release();
      data.triangles = run.memory.allocate(bytes);
      emit_triangles(run, mesh, labels, numbering, data.triangles, {});
    }
  }
};

/// The arrays of a Triangulation if the device can write them, else copies on the device.
class OnHost final : public Outputs {
 public:
  explicit OnHost(Triangulation::Data& to) : to_(to) {}
  void write(Run& run, DeviceMesh& mesh, Allocation& labels, std::size_t points,
             DeviceTriangulation::Data& data) override {
    if (in_place(run, mesh)) return on_device_.write(run, mesh, labels, points, data);
    const Numbering numbering = number(run, mesh, labels, points, data);
    const std::size_t values = 3 * data.triangle_count;
    to_.triangles = make_words(values);
    to_.neighbors = make_words(values);
    data.triangles = run.memory.export_to(to_.triangles.get(), values * word);
    data.neighbors = run.memory.export_to(to_.neighbors.get(), values * word);
    direct_ = data.triangles && data.neighbors;
    if (direct_)
      emit_triangles(run, mesh, labels, numbering, data.triangles, data.neighbors);
    else
      OnDevice::emit(run, mesh, labels, numbering, data);
  }
  /// True if the arrays are filled when the device has finished.
  [[nodiscard]] bool direct() const noexcept { return direct_; }

 private:
  Triangulation::Data& to_;
  OnDevice on_device_;
  bool direct_ = false;
};

template <class Points>
void build(Run& run, const Points& points, std::size_t n, bool stars, Outputs& outputs,
           DeviceTriangulation::Data& data) {
  Statistics& statistics = data.statistics;
  run.check("sort", 0);
  Allocation input = import_points(run, points);
  run.end_phase("upload");
  run.regathers = std::is_same_v<Points, DevicePoints>;
  SpatialOrder order = sort_points(run, std::move(input), n, stars);
  statistics.distinct = data.distinct = order.distinct;
  statistics.wide_arithmetic = order.wide;
  if constexpr (std::is_same_v<Points, DevicePoints>)
    order.points_again = [&](const SpatialOrder& sorted) { return import_in_order(run, points, sorted); };
  data.duplicate_count = n - order.distinct;
  data.duplicate_points = std::move(order.duplicates);
  data.representatives = std::move(order.representatives);
  DeviceMesh mesh = stars ? build_mesh_with_stars(run, order) : build_mesh(run, order);
  order.points.release();
  if (mesh.flat) {
    data.dimension = order.distinct >= 2 ? 1 : 0;
    return;
  }
  data.dimension = 2;
  run.check("collect", 0.9);
  outputs.write(run, mesh, order.labels, n, data);
}

Triangulation to_host(const std::shared_ptr<Triangulator::State>& state, PointsView points) {
  require_size(points.size());
  auto result = std::make_unique<Triangulation::Data>();
  DeviceTriangulation::Data data;
  data.state = state;
  data.points = points.size();
  open_account(*state, points.size(), data.statistics);
  if (points.size() != 0) {
    const bool saves = require_memory(*state, points.size(), {is_host(*state->device), false, points.scalar_size()});
    Run run(*state->device, state->memory, state->options, data.statistics);
    run.saves_memory = saves;
    OnHost outputs(*result);
    build(run, points, points.size(), prefers_stars(state->options, *state->device), outputs, data);
    run.end_phase("collect");
    if (data.dimension == 2) read_mesh(run, data, outputs.direct(), *result);
    read_duplicates(*state->device, data, *result);
    run.end_phase("copy");
    remember_size(*state, data.statistics, saves);
    close_account(*state, run, false);
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
  open_account(*state, points.size, data->statistics);
  if (points.size != 0) {
    const bool saves = require_memory(*state, points.size, {false, true, scalar_bytes(points.scalar)});
    Run run(*state->device, state->memory, state->options, data->statistics);
    run.saves_memory = saves;
    OnDevice outputs;
    build(run, points, points.size, prefers_stars(state->options, *state->device), outputs, *data);
    run.end_phase("collect");
    remember_size(*state, data->statistics, saves);
    close_account(*state, run, true);
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
  begin_account(*state_, data.points);
  Statistics statistics;
  Run run(device, state_->memory, state_->options, statistics);
  Triangulation::Data host;
  read_duplicates(device, data, host);
  const Allocation input = points.size == 0 ? Allocation() : import_points(run, points);
  // The verifier's kernels need double precision.
  if (takes_floats_only(device)) return verify_copy<float>(device, input, data, host.duplicates, options);
  if (data.triangle_count == 0) return verify_copy<double>(device, input, data, host.duplicates, options);
  const VerifyInput what{input, data.triangles, data.neighbors, data.points, data.triangle_count, {}, host.duplicates,
                         true};
  return verify_on_device(run, what, options);
}

std::size_t Triangulator::memory_needed(std::size_t points) const noexcept {
  return most_bytes(state_->memory, points, prefers_stars(state_->options, *state_->device));
}

void Triangulator::reserve(std::size_t points) {
  require_size(points);
  const std::size_t n = points, limit = state_->options.max_memory;
  Memory& memory = state_->memory;
  begin_account(*state_, n);
  (void)require_memory(*state_, n, {false, true, sizeof(double)});
  if (n <= state_->reserved_points) return;
  if (!memory.keeps()) {
    state_->device->reserve(least_bytes(n, false));
  } else if (const bool stars = prefers_stars(state_->options, *state_->device);
             limit == 0 || most_bytes(memory, n, stars) <= limit) {
    memory.drop_kept();  // too small
    begin_account(*state_, n);
    keep_buffers(memory, n, stars);
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
