// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
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

namespace {

/// Letters to insert, delete or replace, or neighbours to exchange, so that one word becomes the other.
std::size_t changes(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    before_last = std::exchange(last, row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j] + (a[i] == b[j] ? 0U : 1U), last[j + 1] + 1, row[j] + 1});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        row[j + 1] = std::min(row[j + 1], before_last[j - 1] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const auto distance = [&](const std::string& name) { return changes(word, name); };
  const auto best = std::ranges::min_element(names, {}, distance);
  return best != names.end() && 3 * distance(*best) <= word.size() ? fmt::format("; did you mean {}?", *best) : "";
}

std::string explain_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  const std::string near = suggestion(word, names);
  return fmt::format("there is no command '{}'{}", word,
                     near.empty() ? fmt::format("; there are: {}", fmt::join(names, ", ")) : near);
}

std::string explain(const CLI::ParseError& error, const CLI::App& command, const std::string& name) {
  const std::vector<std::string> words = command.remaining(true);
  const auto option = std::ranges::find_if(words, [](const std::string& w) { return w.size() > 1 && w[0] == '-'; });
  const bool may_come_of_it = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                              dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (!may_come_of_it || option == words.end()) return error.what();
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options())
    for (const std::string& of : known->get_lnames()) names.push_back("--" + of);
  const std::string word = option->substr(0, option->find('='));
  return fmt::format("{} has no option {}{}", name, word, suggestion(word, names));
}

}  // namespace cadt::cli
