// SPDX-License-Identifier: Apache-2.0
// The library's exceptions as those of cadt/_errors.py, with their data.
#include "common.hpp"

#include <cadt/constrained.hpp>
#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>
#include <cadt/queries.hpp>

#include "tiles/manifest.hpp"

namespace cadt_python {

namespace {

template <class... Data>
void raise(const char* type, const char* message, Data&&... data) {
  const nb::object exception = nb::module_::import_("cadt._errors").attr(type)(message, std::forward<Data>(data)...);
  PyErr_SetObject(exception.type().ptr(), exception.ptr());
}
template <class... Data>
void raise(const char* type, const std::exception& error, Data&&... data) {
  raise(type, error.what(), std::forward<Data>(data)...);
}

/// Without the name of the C++ struct: in Python, options are arguments.
std::string message_of(const cadt::OptionError& error) {
  const std::string message = error.what();
  return message.substr(message.find(error.option()));
}

void translate(const std::exception_ptr& thrown, void* /*unused*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const cadt::InputError& e) {
    raise("InputError", e, e.index());
  } catch (const cadt::InvalidMesh& e) {
    raise("InvalidMesh", e, e.check(), e.first());
  } catch (const cadt::LimitError& e) {
    raise("LimitError", e, e.count(), e.limit());
  } catch (const cadt::OptionError& e) {
    raise("OptionError", message_of(e).c_str(), e.option());
  } catch (const cadt::BackendUnavailable& e) {
    raise("BackendUnavailable", e, e.backend(), e.reason());
  } catch (const cadt::OutOfMemory& e) {
    raise("OutOfMemory", e, e.needed(), e.available());
  } catch (const cadt::DeviceError& e) {
    raise("DeviceError", e, e.call(), e.device(), e.code());
  } catch (const cadt::KernelBuildError& e) {
    raise("KernelBuildError", e, e.device(), e.options(), e.log());
  } catch (const cadt::CrossingError& e) {
    std::vector<std::int32_t> pairs;
    for (const auto& pair : e.pairs()) pairs.insert(pairs.end(), pair.begin(), pair.end());
    const std::string what = e.what(),
                      advice = "; repair them, or take crossing=\"exact\" or crossing=(\"grid\", width)";
    raise("CrossingError", (what.substr(0, what.find(';')) + advice).c_str(), array_of(std::move(pairs), 2));
  } catch (const cadt::DomainError& e) {
    const std::string advice = ", or take domain=\"layers\" or domain=\"outer\"";
    raise("DomainError", (e.what() + advice).c_str(), e.vertex());
  } catch (const cadt::NotDelaunay& e) {
    raise("NotDelaunay", e, e.edge());
  } catch (const cadt::Cancelled& e) {
    raise("Cancelled", e);
  } catch (const cadt::io::FileError& e) {
    raise("FileError", e, e.path());
  } catch (const cadt::tiles::ResumeError& e) {
    raise("ResumeError", e);
  } catch (const cadt::InternalError& e) {
    raise("InternalError", e);
  } catch (const cadt::Error& e) {
    raise("Error", e);
  }
}

}  // namespace

void bind_errors() { nb::register_exception_translator(translate); }

}  // namespace cadt_python
