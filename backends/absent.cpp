// SPDX-License-Identifier: Apache-2.0
// Stands in for the back ends that are not compiled in. The build defines CADT_..._ABSENT as the reason for each.
#include "common/driver/backend.hpp"

namespace cadt {
namespace {

class AbsentEntry final : public BackendEntry {
 public:
  AbsentEntry(Backend id, const char* name, const char* reason)
      : id_(id), name_(name), reason_(std::string("not compiled in (") + reason + ")") {}

  [[nodiscard]] Backend id() const noexcept override { return id_; }
  [[nodiscard]] std::vector<DeviceInfo> devices() override {
    DeviceInfo none;
    none.backend = id_;
    none.index = -1;
    none.reason = reason_;
    return {none};
  }
  [[nodiscard]] std::unique_ptr<Device> open(int /*index*/, const Options& /*options*/) override {
    throw BackendUnavailable(name_, reason_);
  }

 private:
  Backend id_;
  std::string name_, reason_;
};

}  // namespace

#ifdef CADT_OPENCL_ABSENT
BackendEntry& opencl_backend() {
  static AbsentEntry entry(Backend::opencl, "opencl", CADT_OPENCL_ABSENT);
  return entry;
}
#endif

#ifdef CADT_CUDA_ABSENT
BackendEntry& cuda_backend() {
  static AbsentEntry entry(Backend::cuda, "cuda", CADT_CUDA_ABSENT);
  return entry;
}
#endif

}  // namespace cadt
