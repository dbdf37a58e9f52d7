// SPDX-License-Identifier: Apache-2.0
// The layout of --help: names in one column, wrapped descriptions in the other.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace cadt::cli {

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_usage(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
};

}  // namespace cadt::cli
