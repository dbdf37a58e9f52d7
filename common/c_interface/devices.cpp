// SPDX-License-Identifier: Apache-2.0
// Defaults, and the devices of this machine.
#include "common/c_interface/convert.hpp"

using namespace cadt::c_interface;

extern "C" {

cadt_status cadt_options_init(cadt_options* options, size_t size) {
  return guarded([&] {
    cadt_options& out = required(options, "options");
    if (size < sizeof(cadt_options))
      throw InvalidArgument("size", "it is " + std::to_string(size) + ", not " + std::to_string(sizeof(cadt_options)) +
                                        ": give the size of the struct");
    std::memset(&out, 0, size);  // zero is the default of all members but these
    out.size = size;
    out.statistics = CADT_STATISTICS_COUNTERS;
  });
}

cadt_status cadt_list_devices(cadt_device_list** list) {
  return guarded([&] {
    auto& result = required(list, "list");
    result = new cadt_device_list{cadt::list_devices()};
  });
}

cadt_status cadt_device_list_size(const cadt_device_list* list, size_t* count) {
  return guarded([&] { required(count, "count") = required(list, "list").devices.size(); });
}

cadt_status cadt_device_list_get(const cadt_device_list* list, size_t index, cadt_device_info* info) {
  return guarded([&] {
    const auto& devices = required(list, "list").devices;
    if (index >= devices.size())
      throw InvalidArgument("index", "there are " + std::to_string(devices.size()) + " entries, none has the number " +
                                         std::to_string(index));
    give_device(devices[index], info);
  });
}

cadt_status cadt_triangulator_device(const cadt_triangulator* triangulator, cadt_device_info* info) {
  return guarded([&] { give_device(required(triangulator, "triangulator").triangulator.device(), info); });
}

void cadt_device_list_free(cadt_device_list* list) { delete list; }
}
