// SPDX-License-Identifier: Apache-2.0
// The whole run: order the points, build the mesh, number and write the triangles.
#include <cadt/triangulator.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/host/build_mesh.hpp"
#include "common/host/collect.hpp"
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

constexpr std::size_t fixed = std::size_t{1} << 16;  // counters, partial results

/// Device bytes of the phase that needs most, but for crowded cells: writing the result (124 a point), or sorting the
/// triangles (96) where the result goes straight to memory of the host's. docs/performance.md has the plan.
std::size_t least_bytes(std::size_t n, bool result_elsewhere) { return fixed + n * (result_elsewhere ? 97 : 124); }

/// The same with the star stage.
std::size_t star_bytes(std::size_t n) { return fixed + n * 150; }

/// Whether the star stage is what Strategy::automatic chooses, if there is the memory. It needs many cheap lanes: CPUs
/// are faster without it.
bool prefers_stars(const Options& options, const Device& device) {
  if (options.strategy != Strategy::automatic) return options.strategy == Strategy::stars;
  return device.info().gpu && options.stabilize == Stabilize::off && !options.watch &&
         options.statistics != StatisticsDetail::timing;
}

/// Words a point of the buffers that a call without new ones needs: records, points sorted and not, results, their
/// numbers, and lists of a word or less.
constexpr std::size_t kept_words[] = {16, 6, 6, 4, 4, 2, 1, 1, 1, 1, 1, 1};

/// With the star stage besides: neighbours of the stars, lists, and what the rest of the points needs.
constexpr std::size_t kept_star_words[] = {12, 1, 1, 1, 1, 1, 1};

/// The same, with buffers that wait for a later phase or call.
std::size_t most_bytes(const Memory& memory, std::size_t n, bool stars) {
  std::size_t words = 0;
  for (const std::size_t one : kept_words) words += one;
  for (const std::size_t one : kept_star_words) words += stars ? one : 0;
  return memory.keeps() ? 4 * fixed + n * words * word : stars ? star_bytes(n) : least_bytes(n, false);
}

void require_size(std::size_t points) {
  if (points <= max_points()) return;
  throw LimitError("at most " + std::to_string(max_points()) + " points can be triangulated in one call, not " +
                       std::to_string(points) + ": split the input",
                   points, max_points());
}

void require_rules(const Options& options) {
  constexpr unsigned most_flips = 1000;  // counters have ten bits
  if (options.flip_threshold > most_flips)
    throw OptionError("flip_threshold", std::to_string(options.flip_threshold) + " is more than " +
                                            std::to_string(most_flips) + ", the most flips that are told apart");
  if (options.strategy == Strategy::stars && (options.stabilize != Stabilize::off || options.watch))
    throw OptionError("strategy", "stars goes with neither stabilize nor watch: they are about insertion");
  if (!(options.quality_epsilon >= 0)) throw OptionError("quality_epsilon", "must be a number and not negative");
}

bool is_host(const Device& device) { return device.info().backend == Backend::host; }

/// Where the arrays of the result are to be written. Called when their size is known.
class Outputs {
 public:
  virtual ~Outputs() = default;
  virtual void make(Run& run, DeviceTriangulation::Data& data) = 0;
};

class OnDevice final : public Outputs {
 public:
  void make(Run& run, DeviceTriangulation::Data& data) override {
    const std::size_t bytes = 3 * data.triangle_count * word;
    data.triangles = run.memory.allocate(bytes);
    data.neighbors = run.memory.allocate(bytes);
  }
};

/// The arrays of a Triangulation if the device can write them, else copies on the device.
class OnHost final : public Outputs {
 public:
  explicit OnHost(Triangulation::Data& to) : to_(to) {}
  void make(Run& run, DeviceTriangulation::Data& data) override {
    const std::size_t values = 3 * data.triangle_count;
    to_.triangles = make_words(values);
    to_.neighbors = make_words(values);
    data.triangles = run.memory.export_to(to_.triangles.get(), values * word);
    data.neighbors = run.memory.export_to(to_.neighbors.get(), values * word);
    direct_ = data.triangles && data.neighbors;
    if (!direct_) OnDevice().make(run, data);
  }
  /// True if the arrays are filled when the device has finished.
  [[nodiscard]] bool direct() const noexcept { return direct_; }

 private:
  Triangulation::Data& to_;
  bool direct_ = false;
};

template <class Points>
void build(Run& run, const Points& points, std::size_t n, bool stars, Outputs& outputs,
           DeviceTriangulation::Data& data) {
  Statistics& statistics = data.statistics;
  run.check("sort", 0);
  Allocation input = import_points(run, points);
  run.end_phase("upload");
  SpatialOrder order = sort_points(run, std::move(input), n, stars);
  statistics.distinct = data.distinct = order.distinct;
  statistics.wide_arithmetic = order.wide;
  data.duplicate_count = n - order.distinct;
  data.duplicate_points = std::move(order.duplicates);
  data.representatives = std::move(order.representatives);
  const DeviceMesh mesh = stars ? build_mesh_with_stars(run, order) : build_mesh(run, order);
  order.points.release();
  if (mesh.flat) {
    data.dimension = order.distinct >= 2 ? 1 : 0;
    return;
  }
  data.dimension = 2;
  run.check("collect", 0.9);
  const Numbering numbering = number_triangles(run, mesh, order.labels, n);
  data.triangle_count = numbering.triangles;
  run.check("collect", 0.95);
  outputs.make(run, data);
  emit_triangles(run, mesh, order.labels, numbering, data.triangles, data.neighbors);
}

void begin_account(Triangulator::State& state, std::size_t n) {
  if (state.memory.dropped()) state.known_points = state.known_star_points = state.reserved_points = 0;
  state.memory.begin(state.options.max_memory, n <= state.reserved_points);
}

/// What the statistics say before and after each call.
void open_account(Triangulator::State& state, std::size_t n, DeviceTriangulation::Data& data) {
  require_rules(state.options);
  const DeviceInfo& info = state.device->info();
  data.points = n;
  data.statistics.points = n;
  data.statistics.certified = true;  // no edge is illegal until one is found
  data.statistics.backend = to_string(info.backend);
  data.statistics.device = info.name;
  data.statistics.threads = state.device->threads();
  begin_account(state, n);
}

/// \throws OutOfMemory before any work
void require_memory(Triangulator::State& state, std::size_t n, bool result_elsewhere) {
  const bool stars = state.options.strategy == Strategy::stars;  // Strategy::automatic does without, if it must
  if (n <= (stars ? state.known_star_points : state.known_points) && state.options.max_memory == 0) return;
  state.memory.require(stars ? star_bytes(n) : least_bytes(n, result_elsewhere));
}

/// Whether the star stage is to run.
bool choose_stars(Triangulator::State& state, std::size_t n) {
  if (!prefers_stars(state.options, *state.device)) return false;
  if (n <= state.known_star_points && state.options.max_memory == 0) return true;
  return state.options.strategy == Strategy::stars || state.memory.allows(star_bytes(n));
}

void close_account(Triangulator::State& state, Run& run, DeviceTriangulation::Data& data) {
  run.finish();
  data.statistics.launches = run.launcher.launches();
  data.statistics.kernels = run.launcher.kernel_times();
  data.statistics.bytes_device_peak = state.memory.peak();
  state.known_points = std::max(state.known_points, data.points);
  if (data.statistics.proven_stars != 0) state.known_star_points = std::max(state.known_star_points, data.points);
  run.check("collect", 1);
}

Triangulation to_host(const std::shared_ptr<Triangulator::State>& state, PointsView points) {
  require_size(points.size());
  auto result = std::make_unique<Triangulation::Data>();
  DeviceTriangulation::Data data;
  data.state = state;
  open_account(*state, points.size(), data);
  if (points.size() != 0) {
    require_memory(*state, points.size(), is_host(*state->device));
    Run run(*state->device, state->memory, state->options, data.statistics);
    OnHost outputs(*result);
    build(run, points, points.size(), choose_stars(*state, points.size()), outputs, data);
    run.end_phase("collect");
    if (data.dimension == 2) read_mesh(run, data, outputs.direct(), *result);
    read_duplicates(*state->device, data, *result);
    run.end_phase("copy");
    close_account(*state, run, data);
  }
  result->points = data.points;
  result->triangle_count = data.triangle_count;
  result->dimension = data.dimension;
  result->statistics = std::move(data.statistics);
  return Triangulation(std::move(result));
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

DeviceTriangulation Triangulator::triangulate(const DevicePoints& points) {
  require_size(points.size);
  auto data = std::make_unique<DeviceTriangulation::Data>();
  data->state = state_;
  open_account(*state_, points.size, *data);
  if (points.size != 0) {
    require_memory(*state_, points.size, false);
    Run run(*state_->device, state_->memory, state_->options, data->statistics);
    OnDevice outputs;
    build(run, points, points.size, choose_stars(*state_, points.size), outputs, *data);
    run.end_phase("collect");
    close_account(*state_, run, *data);
  }
  return DeviceTriangulation(std::move(data));
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
  if (data.triangle_count == 0) {
    std::vector<double> xy(2 * points.size);
    if (!xy.empty()) device.read(*input, 0, xy.data(), xy.size() * sizeof xy[0]);
    MeshView view;
    view.duplicates = host.duplicates;
    view.has_duplicates = true;
    return cadt::verify(xy, view, options);
  }
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
  require_memory(*state_, n, false);
  if (n <= state_->reserved_points) return;
  if (!memory.keeps()) {
    state_->device->reserve(choose_stars(*state_, n) ? star_bytes(n) : least_bytes(n, false));
  } else if (const bool stars = choose_stars(*state_, n); limit == 0 || most_bytes(memory, n, stars) <= limit) {
    memory.drop_kept();  // too small
    begin_account(*state_, n);
    // The buffers of a call that are alive together; given back at once, so they are kept for it.
    std::vector<Allocation> together;
    for (const std::size_t words : kept_words) together.push_back(memory.allocate(n * words * word));
    if (stars)
      for (const std::size_t words : kept_star_words) together.push_back(memory.allocate(n * words * word));
  } else {
    return;  // enough for a call, but not for keeping all of its buffers
  }
  state_->reserved_points = n;
  state_->known_points = std::max(state_->known_points, n);
}

void Triangulator::release_memory() {
  state_->memory.drop_kept();
  state_->device->trim();
  state_->known_points = state_->known_star_points = state_->reserved_points = 0;
}

Triangulation triangulate(PointsView points, const Options& options) {
  require_size(points.size());
  return to_host(std::make_shared<Triangulator::State>(options, open_device(options), false), points);
}

}  // namespace cadt
