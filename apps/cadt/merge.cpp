// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "failure.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "text.hpp"
#include "tile_errors.hpp"
#include "tiles/mesh_directory.hpp"

#include <cadt/io/mesh_file.hpp>

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace cadt::cli {
namespace {

struct MergeCommand {
  std::string mesh, pvtu, ply;
  std::vector<std::string> outputs, formats;
  int base = 0;
  bool ascii = false, quiet = false;
};

/// `written`: what is complete before.
void write_merged(const MergeCommand& c, const tiles::MeshDirectory& directory, const std::vector<Output>& outputs,
                  std::vector<std::string> written) {
  const Failure damaged(
      exit_verify, fmt::format("{}: its triangles are not those of its manifest; see: cadt verify {}", c.mesh, c.mesh));
  io::PointSet points;
  Triangulation mesh;
  try {
    tiles::MergedMesh merged = tiles::merge(directory);
    points.xy = std::move(merged.xy);
    mesh = Triangulation::adopt(points.view(), merged.triangles, merged.neighbors, Trust::geometry);
  } catch (const InvalidMesh&) {
    throw damaged;
  }
  if (mesh.hash() != directory.manifest().hash) throw damaged;
  for (const Output& output : outputs) {
    io::WriteOptions write;
    write.format = output.format;
    write.base = c.base;
    write.ascii = c.ascii;
    {
      const InPhase phase(writing_phase(output.path));
      io::write_mesh(output.path, points, mesh, write);
      if (output.path == "-") finish_stdout();
    }
    written.push_back(display_name(output.path, false));
    check_interrupt_after(written);
    if (!c.quiet)
      say(fmt::format("{} points, {} triangles written to {}\n", points.size(), mesh.number_of_triangles(),
                      written.back()));
  }
}

int run(const MergeCommand& c) {
  const std::vector<Output> outputs = plan_outputs(c.outputs, c.formats, io::mesh_write_formats(), {});
  if (outputs.empty() && c.pvtu.empty() && c.ply.empty())
    throw Failure(exit_usage, "name what is to be written: -o for one mesh, --pvtu or --ply for pieces");
  for (const Output& output : outputs) require_outside(output.path, c.mesh);
  for (const std::string& folder : {c.pvtu, c.ply}) require_outside(folder, c.mesh);
  with_tile_errors([&] {
    const tiles::MeshDirectory directory(c.mesh);
    std::vector<std::string> written;
    const auto write_pieces = [&](const std::string& folder, const auto& write) {
      if (folder.empty()) return;
      {
        const InPhase phase(Phase::cooperative);
        write(directory, folder, interrupt_token());
      }
      written.push_back(folder);
      check_interrupt_after(written);
    };
    write_pieces(c.pvtu, tiles::export_pvtu);
    write_pieces(c.ply, tiles::export_ply);
    if (!outputs.empty()) write_merged(c, directory, outputs, std::move(written));
  });
  return exit_done;
}

}  // namespace

void add_merge(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("merge", "make one mesh, or pieces for other programs, of a mesh in tiles");
  const auto options = std::make_shared<MergeCommand>();
  command->add_option("MESH", options->mesh, "directory of cadt tiles")->required();
  command
      ->add_option(
          "-o,--output", options->outputs,
          "one mesh in canonical order, the same file as that of cadt triangulate; may be given several times; "
          "'-' is standard output (with -t)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("-t,--to", options->formats,
                   "format of the outputs: " + join(io::mesh_write_formats(), " ") +
                       "; default: from each suffix. Once for all outputs, or once for each")
      ->type_name("FORMAT")
      ->allow_extra_args(false);
  command->add_option("--base", options->base, "first index in .node .ele .neigh files: 0 or 1 (default: 0)")
      ->type_name("0|1")
      ->check(CLI::IsMember({0, 1}).description(""));
  command->add_flag("--ascii", options->ascii, "text instead of binary where the format has both (ply)");
  command
      ->add_option("--pvtu", options->pvtu,
                   "folder for mesh.pvtu and a piece for each node, with the input indices as GlobalNodeIds: ParaView "
                   "reads any size of it")
      ->type_name("DIR");
  command->add_option("--ply", options->ply, "folder for a .ply file of each node")->type_name("DIR");
  command->add_flag("-q,--quiet", options->quiet, "nothing on standard error but errors");
  command->footer(
      "One mesh takes 32-bit indices: 536,870,910 points at most. Its memory is about 140 bytes a point.\n"
      "Triangles are compared with the manifest; cadt verify examines coordinates as well.\n\n"
      "Examples:\n"
      "  cadt merge mesh.cadt -o mesh.ele -o mesh.npz\n"
      "  cadt merge mesh.cadt --pvtu pieces\n");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace cadt::cli
