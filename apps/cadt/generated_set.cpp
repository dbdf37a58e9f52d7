// SPDX-License-Identifier: Apache-2.0
#include "generated_set.hpp"

#include <fmt/format.h>

#include "numbers.hpp"

namespace cadt::cli {

void add_generated_set(CLI::App& command, std::string& set, std::string& n, std::uint64_t& seed) {
  CLI::Option* const generate =
      command.add_option("--generate", set, "in place of files: a point set (see: cadt generate --list)")
          ->type_name("SET");
  command.add_option("-n", n, fmt::format("with --generate: number of points, 250000, 2M or 1e6 (default: {})", n))
      ->type_name("N")
      ->needs(generate);
  command.add_option("--seed", seed, "with --generate: equal seeds give equal points (default: 1)")
      ->type_name("S")
      ->transform(whole_number())
      ->needs(generate);
}

}  // namespace cadt::cli
