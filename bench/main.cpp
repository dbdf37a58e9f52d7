// SPDX-License-Identifier: Apache-2.0
// cadt-bench: the tables and figures of the paper on this machine, as CSV and JSON.
#include "apps/cadt/failure.hpp"
#include "apps/cadt/help.hpp"
#include "bench/commands.hpp"
#include "bench/interrupt.hpp"

#include <malloc.h>

#include <cadt/io/errors.hpp>
#include <cadt/version.hpp>

#include <fmt/format.h>

#include <csignal>
#include <memory>
#include <new>

namespace {

using namespace cadt;

class Formatter : public cli::HelpFormatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (app->get_parent() != nullptr) return cli::HelpFormatter::make_usage(app, std::move(name));
    return "\nUsage: cadt-bench EXPERIMENT... --out DIR [OPTIONS]\n       cadt-bench compare|once|machine [OPTIONS]\n";
  }
};

int parse_and_run(int argc, char** argv) {
  CLI::App app("cadt-bench repeats the measurements of the paper on this machine, and writes them as CSV and JSON.",
               "cadt-bench");
  app.set_version_flag("--version", "cadt-bench " CADT_VERSION, "print the version and exit");
  app.set_help_flag("-h,--help", "print this help and exit");
  app.formatter(std::make_shared<Formatter>());
  bench::Action action;
  bench::add_experiments(app, action);
  bench::add_compare(app, action);
  bench::add_once(app, action);
  bench::add_machine(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {  // help and version
    return app.exit(done);
  } catch (const CLI::ParseError& error) {
    throw cli::Failure(cli::exit_usage, fmt::format("{}; see: cadt-bench --help", error.what()));
  }
  bench::install_interrupt_handlers();
  return action();
}

int error(int code, std::string_view message) {
  cli::say(fmt::format("cadt-bench: error: {}\n", message));
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  // Results of some size always come in fresh pages. Else malloc would keep the pages of one result for the next, or
  // give them back, as earlier measurements have it: 25 MB arrays then take 3 or 27 ms to fill.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows over its limit is an error of the write, with the file's name
  std::signal(SIGPIPE, SIG_IGN);
  try {
    const int code = parse_and_run(argc, argv);
    cli::finish_stdout();
    return code;
  } catch (const cli::Failure& failure) {
    return error(failure.code(), failure.what());
  } catch (const io::FileError& failure) {
    return error(cli::exit_file, failure.what());
  } catch (const BackendUnavailable& failure) {
    return error(cli::exit_device, failure.what());
  } catch (const std::bad_alloc&) {
    return error(cli::exit_memory, "out of memory");
  } catch (const std::exception& failure) {
    return error(cli::exit_internal, failure.what());
  }
}
