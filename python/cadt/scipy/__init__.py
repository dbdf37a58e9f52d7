# SPDX-License-Identifier: Apache-2.0
"""SciPy's classes for points in the plane, computed by cadt.

>>> from cadt.scipy import Delaunay
>>> tri = Delaunay([[0, 0], [0, 1.1], [1, 0], [1, 1]])
>>> tri.simplices
array([[0, 2, 3],
       [0, 3, 1]], dtype=int32)
>>> isinstance(tri, scipy.spatial.Delaunay)
True

The classes derive from SciPy's, with its attributes, shapes and dtypes, so whatever takes SciPy's takes these:
``scipy.interpolate``, ``delaunay_plot_2d``, ``voronoi_plot_2d``, matplotlib. What is different:

- The triangulation is exact. Every distinct point is a vertex; points that equal another are in `coplanar`. The order of
  triangles is cadt's (canonical), the same on every machine.
- `find_simplex` is exact too, and the tolerance applies outside of the hull alone.
- `add_points` of an incremental triangulation triangulates anew.
- More or fewer dimensions, ``furthest_site`` and Qhull options that ask for another result are SciPy's, which a
  `QhullWarning` says once each.
- Points on one line raise `FlatPointsError`, which is a ``scipy.spatial.QhullError``.
"""

from __future__ import annotations

try:
    import scipy.spatial  # noqa: F401
except ImportError as e:
    raise ImportError('cadt.scipy needs SciPy: pip install "cadt[scipy]"') from e

from scipy.spatial import tsearch

from cadt.scipy._delaunay import Delaunay
from cadt.scipy._interpolate import (
    CloughTocher2DInterpolator,
    LinearNDInterpolator,
    NaturalNeighborInterpolator,
    NearestNDInterpolator,
    griddata,
)
from cadt.scipy._qhull import FlatPointsError, QhullWarning
from cadt.scipy._voronoi import Voronoi

__all__ = [
    "CloughTocher2DInterpolator",
    "Delaunay",
    "FlatPointsError",
    "LinearNDInterpolator",
    "NaturalNeighborInterpolator",
    "NearestNDInterpolator",
    "QhullWarning",
    "Voronoi",
    "griddata",
    "tsearch",
]
