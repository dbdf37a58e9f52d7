// SPDX-License-Identifier: Apache-2.0
// The extension module cadt._cadt: the C++ interface for the Python code of the package, which documents it.
#include "common.hpp"
#ifdef CADT_PYTHON_TILES
#include "tiles.hpp"
#endif

NB_MODULE(_cadt, m) {
  using namespace cadt_python;
  // The library's exceptions, open devices and hooks of os.fork are those of the process.
  if (PyInterpreterState_GetID(PyInterpreterState_Get()) != 0)
    throw nb::import_error(
        "cadt works in the main interpreter alone, not in subinterpreters: use threads or processes");
  watch_for_the_end();
  // What daemon threads have when a process ends is no leak; what is one is looked for in Python's development mode.
  nb::set_leak_warnings(nb::cast<bool>(nb::module_::import_("sys").attr("flags").attr("dev_mode")));
  m.attr("version") = CADT_VERSION;
  bind_errors();
  bind_options(m);
  bind_mesh(m);
  bind_device(m);
  bind_constrained(m);
  bind_queries(m);
  bind_scipy(m);
  bind_part_raster(m);
  bind_squares(m);
#ifdef CADT_PYTHON_TILES
  bind_tile_nodes(m);
  bind_tile_tree(m);
  bind_tile_store(m);
#endif
}
