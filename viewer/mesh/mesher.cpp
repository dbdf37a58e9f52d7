// SPDX-License-Identifier: Apache-2.0
#include "viewer/mesh/mesher.hpp"

#include "viewer/gl/errors.hpp"
#include "viewer/mesh/interop.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>

namespace cadt::viewer {
namespace {

bool contains(const std::string& text, const std::string& part) {
  const auto equal = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return !std::ranges::search(text, part, equal).empty();
}

}  // namespace

bool is_named(const DeviceInfo& info, const std::string& device) {
  if (device.empty()) return true;
  if (std::ranges::all_of(device, [](unsigned char c) { return std::isdigit(c) != 0; }))
    return device == std::to_string(info.index);
  return contains(info.name, device) || contains(info.platform, device);
}

std::string name_of_display() {
  const auto* const renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer == nullptr ? "an unknown device" : renderer;
}

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

Mesher::Mesher(const Options& chosen, Interop interop) {
  Options options = chosen;
  options.order = Order::fast;
  const auto try_interop = [&](Interop kind, Backend backend, auto open) {
    if (opened_ != nullptr || (interop != Interop::automatic && interop != kind)) return;
    std::string why;
    if (options.backend != Backend::automatic && options.backend != backend)
      why = "the mesh is computed by the back end '" + std::string(to_string(options.backend)) + "'";
    else
      opened_ = open(options, why);
    if (opened_ != nullptr) {
      interop_ = kind;
      return;
    }
    if (interop == kind)
      throw DisplayError("--interop " + std::string(to_string(kind)) + " is not possible: " + why +
                         "; leave --interop out, and the fastest that is possible is taken");
    reason_ += (reason_.empty() ? "" : "; ") + std::string(to_string(kind)) + ": " + why;
  };
  try_interop(Interop::cuda, Backend::cuda, open_cuda);
  try_interop(Interop::opencl, Backend::opencl, open_opencl);
  if (opened_ == nullptr) opened_ = open_copy(options);
}

Mesher::~Mesher() = default;
const DeviceInfo& Mesher::device() const noexcept { return opened_->triangulator().device(); }
std::string Mesher::reason() const {
  const std::string note = opened_->note();
  return reason_.empty() || note.empty() ? reason_ + note : reason_ + "; " + note;
}
Options& Mesher::options() noexcept { return opened_->triangulator().options(); }

void Mesher::triangulate(MeshBuffers& mesh, Statistics* statistics) {
  mesh.triangle_count = 0;  // after an error the mesh has none
  if (mesh.point_count != 0) mesh.triangle_count = opened_->triangulate(mesh, statistics);
}

}  // namespace cadt::viewer
