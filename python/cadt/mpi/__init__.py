# SPDX-License-Identifier: Apache-2.0
"""One mesh of points that are spread over the ranks of an MPI communicator, through mpi4py.

>>> from mpi4py import MPI
>>> mesh = cadt.mpi.triangulate(MPI.COMM_WORLD, np.random.default_rng(MPI.COMM_WORLD.rank).random((1000, 2)))
>>> mesh.sums.triangles == sum(MPI.COMM_WORLD.allgather(sum(len(p.triangles) for p in mesh.parts.values())))
True

Start programs with ``mpirun -n 16 python -m mpi4py program.py``: then an exception that is one rank's alone ends all of
them. Any MPI will do that mpi4py runs with; messages are those of the host's memory, each below 2**31 elements.
"""

from __future__ import annotations

from cadt.mpi._run import Mesh, triangulate

__all__ = ["Mesh", "triangulate"]
