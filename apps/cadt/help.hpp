// SPDX-License-Identifier: Apache-2.0
// The layout of --help: names in one column, wrapped descriptions in the other. And what is said of words that are
// none.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace cadt::cli {

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_usage(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
};

/// "; did you mean NAME?" of the name that takes the fewest changes of a letter, if it is near; else nothing.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& names);
/// What is wrong with a word that is no command of the program, and which one may be meant.
[[nodiscard]] std::string explain_command(const CLI::App& app, const std::string& word);
/// What is wrong with the words of a command: the option that it does not have, and which one may be meant.
[[nodiscard]] std::string explain(const CLI::ParseError& error, const CLI::App& command, const std::string& name);

}  // namespace cadt::cli
