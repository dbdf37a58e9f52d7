# SPDX-License-Identifier: Apache-2.0
"""Which triangles of a mesh with segments are inside, and these for other libraries."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _gpu, _show
from cadt._mesh import Mesh, read_only

if TYPE_CHECKING:
    from collections.abc import Callable


class DomainMesh(Mesh):
    """The part of `ConstrainedDelaunay` that is about domains."""

    _gpu: _gpu.ConstrainedMesh | None
    _made: _cadt.ConstrainedTriangulation  # without a GPU

    # Domains

    @property
    def inside(self) -> np.ndarray:
        """(t,) bool, with PyOpenCL int8: whether each triangle is inside (the parameter `domain`). Queries and rasters take
        all triangles; places `xi` are inside where ``(t >= 0) & mesh.inside[t]`` with ``t = mesh.find_simplex(xi)``."""
        return self._of("inside", lambda c: c.inside.view(bool), lambda g: g.inside)

    @property
    def triangles_inside(self) -> Any:
        """Those of `simplices` that are inside: (i, 3) int32."""
        return self._of("triangles_inside", lambda c: c.triangles_inside(), lambda g: g.triangles_inside)

    @property
    def region(self) -> Any:
        """(t,) int32: the region of each triangle: those that can be reached without crossing a segment have the same.

        Ways around outside of the hull count, so a single segment across it leaves one region.
        """
        return self._of("region", lambda c: c.region, lambda g: g.region)

    @property
    def n_regions(self) -> int:
        return self.region_value.shape[0]

    @property
    def region_value(self) -> np.ndarray:
        """(r,) int32: depth of each region ("layers"), winding number ("nonzero"), segments crossed modulo 2
        ("even_odd"), else 1 inside and 0 outside."""
        return self._of("region_value", lambda c: c.region_value, lambda g: g.region_value)

    @property
    def region_attribute(self) -> np.ndarray:
        """(r,) float64: what the parameter `regions` says of each region, else 0."""
        return self._of("region_attribute", lambda c: c.region_attribute, lambda g: g.region_attribute)

    # To other libraries

    def plot(self, ax: Any = None, *, inside: bool = True, **how: Any) -> Any:
        """Draws triangles (those inside, unless ``inside=False``) and, thicker, segments with matplotlib; returns the axes.

        `how` is passed to ``triplot``.
        """
        return _show.plot_constrained(self, ax, inside, how)

    def to_matplotlib(self) -> Any:
        """A ``matplotlib.tri.Triangulation`` of all triangles, whose mask hides those outside. Raises InputError without
        triangles."""
        return _show.to_matplotlib(self)

    def to_pyvista(self, z: Any = None, *, inside: bool = True) -> Any:
        """A ``pyvista.PolyData`` of the triangles inside, or with ``inside=False`` of all; `z`: heights of the points, else
        0. ``cell_data`` has the region of each."""
        return _show.to_pyvista(self, z, inside)

    def to_meshio(self, z: Any = None, *, inside: bool = True) -> Any:
        """A ``meshio.Mesh`` of the triangles inside, or with ``inside=False`` of all; `z`: heights of the points, else the
        mesh is plane. ``cell_data`` has the region of each, and takes more: labels of an image are
        ``[cadt.triangle_labels(mesh.points, mesh.triangles_inside, image)]``."""
        return _show.to_meshio(self, z, inside)

    def save(self, path: Any, z: Any = None, *, inside: bool = True) -> None:
        """As `Delaunay.save`: the triangles inside, or with ``inside=False`` all. ``.npz``, ``.vtk``, ``.vtu`` and ``.mesh``
        have the region of each; ``.npz`` has neighbors and convex_hull if no triangle is left out. For others than ``.npz``
        a triangle must be inside."""
        _show.save(self, path, z, inside)

    # Plumbing

    def _cells(self, inside: bool) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        host = self._on_host
        if not inside:
            return host.mesh.triangles, {"region": host.region}
        return host.triangles_inside(), {"region": host.region[host.inside.view(bool)]}

    def _outside(self) -> np.ndarray | None:
        outside = ~self._on_host.inside.view(bool)
        return outside if outside.any() else None

    def _of(self, name: str, of: Callable, of_gpu: Callable | None = None) -> Any:
        if name not in self._cache:
            there = None if self._gpu is None or of_gpu is None else of_gpu(self._gpu)
            if there is None:
                made = of(self._on_host)
                there = read_only(made) if self._gpu is None else self._gpu.array.like(made)
            self._cache[name] = there
        return self._cache[name]

    @property
    def _on_host(self) -> _cadt.ConstrainedTriangulation:
        """The mesh with its segments on the host; of a device, a copy."""
        if self._gpu is None:
            return self._made
        if "on_host" not in self._cache:
            self._cache["on_host"] = self._gpu.mesh.download_constrained()
        return self._cache["on_host"]

    @property
    def _host_mesh(self) -> _cadt.Triangulation:
        return self._on_host.mesh
