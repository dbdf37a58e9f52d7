// SPDX-License-Identifier: Apache-2.0
#include "output_options.hpp"

#include "failure.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "numbers.hpp"
#include "text.hpp"

#include <cadt/io/errors.hpp>
#include <cadt/io/mesh_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace cadt::cli {
namespace {
constexpr int most_width = 32000;  // of what io draws, and its height at most

/// Those who read it take the base from the .node file beside it, if that is not an output as well.
int default_base(const std::string& path, const std::vector<Output>& outputs) {
  const std::string node = std::filesystem::path(path).replace_extension(".node").string();
  if (std::ranges::any_of(outputs, [&](const Output& output) { return output.path == node; })) return 0;
  try {
    return io::base_beside(path).value_or(0);
  } catch (const io::FileError&) {  // nor can others read by it
    return 0;
  }
}
}  // namespace

void add_output_options(CLI::App& command, OutputOptions& o, const std::string& formats, const std::string& indexed) {
  command
      .add_option("-o,--output", o.outputs,
                  "write the mesh or a picture of it; may be given several times; '-' is standard output (with -t)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option("-t,--to", o.formats,
                  "format of the outputs: " + formats +
                      "; default: from each suffix. Once for all outputs, or once for each (auto: from the suffix)")
      ->type_name("FORMAT")
      ->allow_extra_args(false);
  command
      .add_option("--base", o.base,
                  "first index in " + indexed + " files: 0 or 1 (default: that of the .node file beside it, else 0)")
      ->type_name("0|1")
      ->check(CLI::IsMember({0, 1}).description(""));
  command.add_flag("--ascii", o.ascii, "text instead of binary where the format has both (ply)");
  command
      .add_option("--width", o.width,
                  fmt::format("width of pictures, 16 to {} (default: 1600, or less where the height would "
                              "be above 4000); above 200,000 triangles 16384 at most",
                              most_width))
      ->type_name("PIXELS")
      ->transform(whole_number(16, most_width));
}

void write_outputs(const std::vector<Output>& outputs, const OutputOptions& options, ProgressLine& line,
                   const std::function<void(const std::string& path, const io::WriteOptions&)>& write) {
  io::WriteOptions how;
  how.ascii = options.ascii;
  if (options.width) {  // what is asked for is not made narrower because the points are high
    how.width = *options.width;
    how.max_height = most_width;
  }
  std::vector<std::string> written;
  for (const Output& output : outputs) {
    {
      const InPhase phase(writing_phase(output.path));
      line.step(fmt::format("writing {}", display_name(output.path, false)));
      how.format = output.format;
      how.base = options.base ? *options.base : default_base(output.path, outputs);
      write(output.path, how);
      if (output.path == "-") finish_stdout();
    }
    written.push_back(display_name(output.path, false));
    check_interrupt_after(written, &line);
  }
  line.clear();
}

void print_summary(const std::string& summary, bool alone, bool quiet) {
  if (alone) {
    print(summary);
  } else if (!quiet) {
    say(summary);
  }
}

}  // namespace cadt::cli
