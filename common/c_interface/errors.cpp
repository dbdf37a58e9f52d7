// SPDX-License-Identifier: Apache-2.0
#include <cadt/constrained.hpp>
#include <cadt/queries.hpp>

#include <array>
#include <new>
#include <utility>

#include "common/c_interface/guard.hpp"

namespace cadt::c_interface {
namespace {

cadt_error without_data(cadt_status status) noexcept {
  cadt_error error{};
  error.size = sizeof error;
  error.status = status;
  error.message = error.name = error.detail = "";
  error.index = -1;
  return error;
}

/// Of this thread. Without a destructor, so that it is there until the thread is gone.
thread_local cadt_error last{};

/// Whether the strings of this thread are destroyed already: a destructor that runs later may call the library.
thread_local bool ended = false;

struct Texts {
  std::array<std::string, 3> of_last;
  ~Texts() {
    ended = true;
    last = without_data(last.status);
  }
};

cadt_error& begin(cadt_status status) noexcept { return last = without_data(status); }

void keep_text(std::string message, std::string name = {}, std::string detail = {}) noexcept {
  thread_local Texts texts;
  if (ended) {
    last.message = "the thread is ending, and keeps no messages";
    return;
  }
  texts.of_last = {std::move(message), std::move(name), std::move(detail)};
  last.message = texts.of_last[0].c_str();
  last.name = texts.of_last[1].c_str();
  last.detail = texts.of_last[2].c_str();
}

void keep_sizes(std::size_t needed, std::size_t available) noexcept {
  last.needed = needed;
  last.available = available;
}

/// Rethrows the exception that is being handled. May run out of memory itself.
void keep_known() {
  try {
    throw;
  } catch (const InvalidArgument& e) {
    begin(CADT_INVALID_ARGUMENT);
    keep_text(e.what(), e.argument());
  } catch (const BufferTooSmall& e) {
    begin(CADT_BUFFER_TOO_SMALL);
    keep_sizes(e.needed(), e.available());
    keep_text(e.what());
  } catch (const InputError& e) {
    begin(CADT_INPUT_ERROR).index = static_cast<std::int64_t>(e.index());
    keep_text(e.what());
  } catch (const LimitError& e) {
    begin(CADT_LIMIT_ERROR);
    keep_sizes(e.count(), e.limit());
    keep_text(e.what());
  } catch (const OptionError& e) {
    begin(CADT_OPTION_ERROR);
    keep_text(e.what(), e.option());
  } catch (const BackendUnavailable& e) {
    begin(CADT_BACKEND_UNAVAILABLE);
    keep_text(e.what(), e.backend(), e.reason());
  } catch (const OutOfMemory& e) {
    begin(CADT_OUT_OF_MEMORY);
    keep_sizes(e.needed(), e.available());
    keep_text(e.what());
  } catch (const DeviceError& e) {
    begin(CADT_DEVICE_ERROR).code = e.code();
    keep_text(e.what(), e.call(), e.device());
  } catch (const KernelBuildError& e) {
    begin(CADT_KERNEL_BUILD_ERROR);
    keep_text(e.what(), e.device(), e.log());
  } catch (const Cancelled& e) {
    begin(CADT_CANCELLED);
    keep_text(e.what());
  } catch (const InvalidMesh& e) {
    begin(CADT_INVALID_MESH).index = e.first();
    keep_text(e.what(), e.check());
  } catch (const CrossingError& e) {
    begin(CADT_SEGMENTS_CROSS).index = e.pairs().front()[0];
    keep_sizes(e.pairs().size(), 0);
    keep_text(e.what());
  } catch (const DomainError& e) {
    begin(CADT_OPEN_BOUNDARY).index = e.vertex();
    keep_text(e.what());
  } catch (const NotDelaunay& e) {
    begin(CADT_NOT_DELAUNAY).index = e.edge();
    keep_text(e.what());
  } catch (const InternalError& e) {
    begin(CADT_INTERNAL_ERROR);
    keep_text(e.what());
  } catch (const std::bad_alloc&) {
    begin(CADT_OUT_OF_MEMORY).message = "the host has too little memory";
  } catch (const std::exception& e) {
    begin(CADT_ERROR);
    keep_text(e.what());
  } catch (...) {
    begin(CADT_ERROR).message = "an exception of an unknown type";
  }
}

}  // namespace

cadt_status keep_exception() noexcept {
  try {
    keep_known();
  } catch (...) {
    // There was no memory for the message: the status, which was kept first, says what happened.
    last.message = "there was too little memory for the message";
  }
  return last.status;
}

}  // namespace cadt::c_interface

using namespace cadt::c_interface;

extern "C" {

int32_t cadt_abi_version(void) { return CADT_ABI_VERSION; }

const char* cadt_version(void) { return CADT_VERSION; }

const char* cadt_status_name(cadt_status status) {
  constexpr std::array names = {"CADT_OK",
                                "CADT_INVALID_ARGUMENT",
                                "CADT_INPUT_ERROR",
                                "CADT_LIMIT_ERROR",
                                "CADT_OPTION_ERROR",
                                "CADT_BACKEND_UNAVAILABLE",
                                "CADT_OUT_OF_MEMORY",
                                "CADT_DEVICE_ERROR",
                                "CADT_KERNEL_BUILD_ERROR",
                                "CADT_CANCELLED",
                                "CADT_INVALID_MESH",
                                "CADT_INTERNAL_ERROR",
                                "CADT_BUFFER_TOO_SMALL",
                                "CADT_ERROR",
                                "CADT_SEGMENTS_CROSS",
                                "CADT_OPEN_BOUNDARY",
                                "CADT_NOT_DELAUNAY"};
  static_assert(names.size() == CADT_NOT_DELAUNAY + 1);
  return status < 0 || static_cast<std::size_t>(status) >= names.size() ? "unknown status"
                                                                        : names[static_cast<std::size_t>(status)];
}

cadt_status cadt_last_error(cadt_error* error) {
  // A failure of this function leaves the last error as it is.
  if (error == nullptr || error->size < sizeof(cadt_error)) return CADT_INVALID_ARGUMENT;
  give(error, last.message != nullptr ? last : without_data(CADT_OK), "error");
  return CADT_OK;
}

const char* cadt_last_error_message(void) {
  const char* message = last.message;
  return message != nullptr ? message : "";
}
}
