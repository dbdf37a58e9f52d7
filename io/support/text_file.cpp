// SPDX-License-Identifier: Apache-2.0
#include <cadt/io/text_file.hpp>

#include "io/support/atomic_file.hpp"

namespace cadt::io {

void write_text(const std::string& path, std::string_view text) {
  detail::AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace cadt::io
