# SPDX-License-Identifier: Apache-2.0
"""One mesh of points in files, made by the workers of a Dask cluster.

>>> import dask.distributed                                                        # doctest: +SKIP
>>> client = dask.distributed.Client("scheduler:8786")                             # doctest: +SKIP
>>> mesh = cadt.dask.triangulate(sorted(glob("*.laz")), client, consumer=raster)   # doctest: +SKIP
>>> mesh.sums.triangles, mesh.values[0]                                            # doctest: +SKIP

A worker takes one card: start workers with ``dask cuda worker`` (or ``LocalCUDACluster``), which gives each of them its own
``CUDA_VISIBLE_DEVICES``, or name them by the number of their card: ``dask worker --name 0``, ``--name 1``, ...
"""

from __future__ import annotations

from cadt.dask._run import Mesh, triangulate

__all__ = ["Mesh", "triangulate"]
