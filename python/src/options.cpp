// SPDX-License-Identifier: Apache-2.0
// Options, devices, statistics.
#include "common.hpp"

namespace cadt_python {

cadt::PointsView view_of(const Points& points) {
  const std::size_t n = points.shape(0);
  if (points.shape(1) != 2) throw nb::value_error("points must have shape (n, 2)");
  if (n == 0) return {};
  const auto strided = [&]<class R>(const R* first) {
    return cadt::PointsView::strided(first, first + points.stride(1), n,
                                     static_cast<std::size_t>(points.stride(0)) * sizeof(R));
  };
  if (points.stride(0) < 0) throw nb::value_error("points must not run backwards in memory");
  if (points.dtype() == nb::dtype<double>()) return strided(static_cast<const double*>(points.data()));
  if (points.dtype() == nb::dtype<float>()) return strided(static_cast<const float*>(points.data()));
  throw nb::type_error("points must be float64 or float32");
}

namespace {
unsigned number_of_forks = 0;  // written while the child has one thread
}
unsigned forks() noexcept { return number_of_forks; }
void forked() noexcept { ++number_of_forks; }

void Call::report(const cadt::Progress& p) {
  const auto now = Clock::now();
  if (now < next_ || raised_) return;
  next_ = now + std::chrono::milliseconds(50);
  with_gil([&] {
    if (PyErr_CheckSignals() == 0) {
      if (progress_.is_none()) return;
      PyObject* phase = PyUnicode_FromStringAndSize(p.phase.data(), static_cast<Py_ssize_t>(p.phase.size()));
      PyObject* answer = PyObject_CallFunction(progress_.ptr(), "Nd", phase, p.fraction);
      Py_XDECREF(answer);
      if (answer != nullptr) return;
    }
    raised_.emplace();
    source_.request_stop();
  });
}

cadt::Options on_host(const cadt::Options& options) {
  cadt::Options host = options;
  host.backend = cadt::Backend::host;
  host.device.clear();
  host.queue.reset();
  return host;
}

nb::dict to_dict(const cadt::Statistics& s) {
  nb::dict d;
  d["backend"] = s.backend;
  d["device"] = s.device;
  d["threads"] = s.threads;
  d["points"] = s.points;
  d["distinct"] = s.distinct;
  for (const cadt::NamedCounter& counter : cadt::counters_of_work) d[counter.name] = s.*counter.value;
  d["sets"] = s.sets;
  d["batched_sets"] = s.batched_sets;
  d["bytes_device_peak"] = s.bytes_device_peak;
  d["bytes_to_device"] = s.bytes_to_device;
  d["bytes_from_device"] = s.bytes_from_device;
  d["wide_arithmetic"] = s.wide_arithmetic;
  d["certified"] = s.certified;
  nb::dict milliseconds;
  for (const auto& [phase, time] : s.milliseconds) milliseconds[phase.c_str()] = time;
  d["milliseconds"] = milliseconds;
  nb::dict shares;
  for (const auto& [name, share] : s.thread_time) shares[name.c_str()] = share;
  d["thread_time"] = shares;
  nb::list flips;
  for (const std::uint64_t edges : s.flips_per_edge) flips.append(edges);
  d["flips_per_edge"] = flips;
  return d;
}

void bind_options(nb::module_& m) {
  nb::class_<cadt::Options>(m, "Options")
      .def(
          "__init__",
          [](cadt::Options* self, const std::string& backend, const std::string& device, unsigned threads,
             bool canonical, std::size_t max_memory, const std::string& statistics,
             std::optional<std::uintptr_t> queue) {
            new (self) cadt::Options;
            self->backend = cadt::backend_from_string(backend);
            self->device = device;
            self->threads = threads;
            self->order = canonical ? cadt::Order::canonical : cadt::Order::fast;
            self->max_memory = max_memory;
            self->statistics = statistics == "none"     ? cadt::StatisticsDetail::none
                               : statistics == "timing" ? cadt::StatisticsDetail::timing
                                                        : cadt::StatisticsDetail::counters;
            if (queue) self->queue = reinterpret_cast<void*>(*queue);
          },
          nb::arg("backend") = "auto", nb::arg("device") = "", nb::arg("threads") = 0, nb::arg("canonical") = true,
          nb::arg("max_memory") = 0, nb::arg("statistics") = "counters", nb::arg("queue") = nb::none())
      .def_prop_ro("backend", [](const cadt::Options& o) { return std::string(cadt::to_string(o.backend)); })
      .def("on_host", &on_host);

  m.def("forked", &forked);
  m.def("devices", [] {
    const std::vector<cadt::DeviceInfo> devices = without_gil([] { return cadt::list_devices(); });
    nb::list list;
    for (const cadt::DeviceInfo& device : devices) {
      nb::dict d;
      d["backend"] = std::string(cadt::to_string(device.backend));
      d["index"] = device.index;
      d["platform"] = device.platform;
      d["name"] = device.name;
      d["driver"] = device.driver;
      d["usable"] = device.usable;
      d["reason"] = device.reason;
      d["memory_bytes"] = device.memory_bytes;
      d["compute_units"] = device.compute_units;
      d["fp64"] = device.fp64;
      d["gpu"] = device.gpu;
      d["watchdog"] = device.watchdog;
      d["largest_buffer_bytes"] = device.largest_buffer_bytes;
      d["atomics"] = device.atomics;
      list.append(d);
    }
    return list;
  });
}

}  // namespace cadt_python
