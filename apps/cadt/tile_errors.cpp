// SPDX-License-Identifier: Apache-2.0
#include "tile_errors.hpp"

#include "failure.hpp"
#include "text.hpp"
#include "tiles/manifest.hpp"

#include <cadt/errors.hpp>

#include <fmt/format.h>

namespace cadt::cli {

void with_tile_errors(const std::function<void()>& work) {
  try {
    work();
  } catch (const tiles::ResumeError& e) {
    throw Failure(exit_file, e.what());
  } catch (const InputError& e) {  // it names the file and the point
    throw Failure(exit_file, e.what());
  } catch (const LimitError& e) {
    throw Failure(exit_file, fmt::format("{} ({}, at most {})", e.what(), e.count(), e.limit()));
  } catch (const OutOfMemory& e) {
    throw Failure(exit_memory,
                  fmt::format("out of memory: {} (needed: {}, free: {}); --tile-points makes tiles smaller", e.what(),
                              human_bytes(e.needed()), e.available() == 0 ? "unknown" : human_bytes(e.available())));
  }
}

}  // namespace cadt::cli
