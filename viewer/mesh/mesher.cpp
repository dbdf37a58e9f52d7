// SPDX-License-Identifier: Apache-2.0
#include "viewer/mesh/mesher.hpp"

#include "viewer/gl/errors.hpp"

#include <vector>

namespace cadt::viewer {

std::string_view to_string(Interop interop) noexcept {
  switch (interop) {
    case Interop::automatic:
      return "auto";
    case Interop::cuda:
      return "cuda";
    case Interop::opencl:
      return "opencl";
    case Interop::copy:
      return "copy";
  }
  return "unknown";
}

struct Mesher::Device {
  Triangulator triangulator;
  Interop interop = Interop::copy;
  std::string reason;
  explicit Device(const Options& options) : triangulator(options) {}
};

Mesher::Mesher(const Options& options, Interop interop) : device_(std::make_unique<Device>(options)) {
  if (interop == Interop::cuda || interop == Interop::opencl)
    throw DisplayError("--interop " + std::string(to_string(interop)) + " is not possible: this build has it not");
}

Mesher::~Mesher() = default;
Interop Mesher::interop() const noexcept { return device_->interop; }
const std::string& Mesher::reason() const noexcept { return device_->reason; }
const DeviceInfo& Mesher::device() const noexcept { return device_->triangulator.device(); }
Options& Mesher::options() noexcept { return device_->triangulator.options(); }

void Mesher::triangulate(MeshBuffers& mesh) {
  const std::vector<double> xy = mesh.points.read_values<double>(2 * mesh.point_count);
  mesh.bytes_through_host += xy.size() * sizeof(double);
  const Triangulation result = device_->triangulator.triangulate(std::span<const double>(xy));
  mesh.write_triangles(result.triangles());
}

}  // namespace cadt::viewer
