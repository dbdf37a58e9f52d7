// SPDX-License-Identifier: Apache-2.0
// The subcommands of cadt-bench. Each declares its options and, when the command line names it, sets the work.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace cadt::bench {

using Action = std::function<int()>;

void add_experiments(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_once(CLI::App& app, Action& action);
void add_machine(CLI::App& app, Action& action);

}  // namespace cadt::bench
