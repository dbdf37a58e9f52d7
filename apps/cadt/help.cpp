// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace cadt::cli {
namespace {

constexpr std::size_t indent = 24;
constexpr std::size_t width = 92;

std::string entry(const std::string& name, std::string_view text) {
  std::string result = "  " + name;
  // A long name gets a line of its own.
  result += result.size() + 2 > indent ? "\n" + std::string(indent, ' ') : std::string(indent - result.size(), ' ');
  std::size_t column = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    if (column > indent && column + 1 + word.size() > width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) result += ' ', ++column;
    result += word;
    column += word.size();
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return result + '\n';
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  if (is_positional) return entry(option->get_name(true), option->get_description());
  std::string name = option->get_name(false, true);
  if (const auto comma = name.find(','); comma != std::string::npos) name.insert(comma + 1, " ");
  // CLI11 shows the value of a flag without argument in braces; the reader wants the argument.
  if (const auto brace = name.find('{'); brace != std::string::npos) {
    name = name.substr(0, brace) + "[=" + option->get_type_name() + "]";
  } else if (option->get_expected_max() != 0 && option->get_type_size() != 0) {
    name += " " + option->get_type_name();
  }
  return entry(name, option->get_description());
}

std::string HelpFormatter::make_option_usage(const CLI::Option* option) const {
  return option->get_required() ? option->get_name(true) : "[" + option->get_name(true) + "]";
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description());
}

std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
  if (app->get_parent() == nullptr) return "\nUsage: cadt COMMAND [OPTIONS] ...\n";
  return "\n" + CLI::Formatter::make_usage(app, std::move(name));
}

}  // namespace cadt::cli
