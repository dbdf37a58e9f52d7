# SPDX-License-Identifier: Apache-2.0
"""
The order of triangles
======================

In canonical order (the default) triangles are sorted by their lowest points, so arrays are equal on
every device. In ``order="fast"`` they are in the order in which the device made them: along the
Hilbert curve on which it sorts the points. Neighbours in the plane are then neighbours in memory,
which loops over triangles like. The set of triangles is the same.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np

rng = np.random.default_rng(14)
points = rng.random((4000, 2))
canonical = cadt.Delaunay(points)
fast = cadt.Delaunay(points, order="fast")
assert canonical.hash == fast.hash
rows = lambda mesh: {tuple(sorted(row)) for row in mesh.simplices.tolist()}
assert rows(canonical) == rows(fast)

fig, axes = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
for ax, mesh, title in (
    (axes[0], canonical, "canonical: by the lowest point"),
    (axes[1], fast, "fast: as the device made them"),
):
    drawn = ax.tripcolor(
        *points.T, mesh.simplices, facecolors=np.arange(mesh.n_triangles), cmap="turbo"
    )
    step = np.linalg.norm(np.diff(points[mesh.simplices].mean(axis=1), axis=0), axis=1)
    ax.set(
        title=f"{title}\nmean distance from one to the next: {step.mean():.3f}",
        aspect="equal",
        xticks=[],
        yticks=[],
    )
fig.colorbar(drawn, ax=axes, label="number of the triangle", shrink=0.8)
plt.show()
