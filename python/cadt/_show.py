# SPDX-License-Identifier: Apache-2.0
"""Meshes for other libraries: matplotlib, PyVista, meshio, files."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt._errors import FileError, InputError
from cadt._points import as_values

if TYPE_CHECKING:
    from cadt._domains import DomainMesh
    from cadt._mesh import Mesh


def _need(module: str, extra: str) -> Any:
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError:
        raise ImportError(f"this needs {extra}: pip install {extra}") from None


def _heights(mesh: Mesh, z: Any) -> np.ndarray:
    """One a point; crossings get theirs as in `ConstrainedDelaunay.at_crossings`."""
    z = mesh._complete(z)
    values, one = as_values(z if mesh._gpu is None else mesh._gpu._as_host(z), mesh.n_points)
    if one:
        raise InputError(f"heights must have shape ({mesh.n_points},), not {(mesh.n_points, *one)}", 0)
    return values[:, 0]


def _in_space(mesh: Mesh, z: Any) -> np.ndarray:
    xyz = np.zeros((mesh.n_points, 3))
    xyz[:, :2] = mesh._host_points
    if z is not None:
        xyz[:, 2] = _heights(mesh, z)
    return xyz


def to_matplotlib(mesh: Mesh) -> Any:
    tri = _need("matplotlib.tri", "matplotlib")
    xy = mesh._host_points
    if mesh.n_triangles == 0:
        raise InputError("the mesh has no triangles, without which matplotlib makes no Triangulation", 0)
    mask = mesh._outside()
    result = tri.Triangulation(xy[:, 0], xy[:, 1], mesh._host_mesh.triangles, mask)
    result.is_delaunay = True
    if mask is not None:
        return result  # with neighbours of its own
    # Its own object in C++ must be made first: with neighbours it takes none (matplotlib 3.11).
    result.get_cpp_triangulation()
    # matplotlib's neighbour k is across the edge from vertex k to the next, ours is opposite vertex k.
    result._neighbors = np.ascontiguousarray(np.roll(mesh._host_mesh.neighbors, 1, axis=1))
    return result


def plot(mesh: Mesh, ax: Any, how: dict[str, Any]) -> Any:
    if ax is None:
        ax = _need("matplotlib.pyplot", "matplotlib").gca()
    if "lw" not in how:
        how.setdefault("linewidth", 0.6)
    if mesh.n_triangles:
        ax.triplot(to_matplotlib(mesh), **how)
    ax.set_aspect("equal")
    return ax


def plot_constrained(mesh: DomainMesh, ax: Any, inside: bool, how: dict[str, Any]) -> Any:
    if ax is None:
        ax = _need("matplotlib.pyplot", "matplotlib").gca()
    collections = _need("matplotlib.collections", "matplotlib")
    xy, on_host = mesh._host_points, mesh._on_host
    triangles = on_host.triangles_inside() if inside else on_host.mesh.triangles
    if "lw" not in how:
        how.setdefault("linewidth", 0.6)
    if len(triangles):
        ax.triplot(xy[:, 0], xy[:, 1], triangles, **how)
    ax.add_collection(collections.LineCollection(xy[on_host.edges], colors="black", linewidths=1.4, zorder=3))
    ax.autoscale_view()
    ax.set_aspect("equal")
    return ax


def to_pyvista(mesh: Mesh, z: Any, inside: bool = False) -> Any:
    pyvista = _need("pyvista", "pyvista")
    triangles, attributes = mesh._cells(inside)
    result = pyvista.PolyData(_in_space(mesh, z), np.insert(triangles, 0, 3, axis=1).ravel())
    for name, values in attributes.items():
        result.cell_data[name] = values
    return result


def to_meshio(mesh: Mesh, z: Any, inside: bool = False) -> Any:
    meshio = _need("meshio", "meshio")
    xyz = _in_space(mesh, z)
    triangles, attributes = mesh._cells(inside)
    of_cells = {name: [values] for name, values in attributes.items()}
    return meshio.Mesh(xyz if z is not None else xyz[:, :2], [("triangle", triangles)], cell_data=of_cells)


def save(mesh: Mesh, path: Any, z: Any, inside: bool = False) -> None:
    path = Path(path)
    suffix = path.suffix.lower()
    if not suffix:
        raise FileError(f"{path}: a suffix says the format: .npz, or with meshio .ply .vtk .obj .stl ...", str(path))
    if suffix != ".npz":
        try:
            known = _need("meshio", "meshio").extension_to_filetypes
        except ImportError as e:
            said = f"{path}: without meshio, which writes .ply .vtk .obj .stl ..., meshes are written to .npz alone"
            raise ImportError(f"{said}: pip install meshio") from e
        if suffix not in known:
            raise FileError(f"{path}: meshes are written to files that end in one of: .npz, {', '.join(known)}", str(path))
    heights = None if z is None else _heights(mesh, z)
    if suffix != ".npz" and len(mesh._cells(inside)[0]) == 0:
        raise InputError("there are no triangles, or none is inside; .npz takes such a mesh", 0)
    target = Path(os.path.realpath(path))  # a link is followed: the link stays
    try:
        handle, name = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=suffix, dir=target.parent)
    except OSError as e:
        raise _not_written(path, e) from None
    os.close(handle)
    try:
        if suffix == ".npz":
            # As the program's, whose readers take it.
            host = mesh._host_mesh
            triangles, attributes = mesh._cells(inside)
            arrays = {"points": mesh._host_points, "simplices": triangles, **attributes}
            if len(triangles) == len(host.triangles):
                arrays["neighbors"] = host.neighbors
                arrays["convex_hull"] = np.stack([host.hull, np.roll(host.hull, -1)], axis=1)
            if heights is not None:
                arrays["height"] = heights
            np.savez(name, **arrays)  # type: ignore[arg-type]
        else:
            # A plane mesh gets a third coordinate: most formats have no other.
            to_meshio(mesh, np.zeros(mesh.n_points) if heights is None else heights, inside).write(name)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, target)
    except OSError as e:
        os.unlink(name)
        raise _not_written(path, e) from None
    except BaseException:
        os.unlink(name)
        raise


def _not_written(path: Path, error: OSError) -> FileError:
    """Under the name that was given: that of the temporary file says nothing."""
    return FileError(f"{path}: cannot be written: {error.strerror or error}", str(path))
