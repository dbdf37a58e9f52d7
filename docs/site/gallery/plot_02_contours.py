# SPDX-License-Identifier: Apache-2.0
"""
Contours of scattered points
============================

``to_matplotlib`` gives a ``matplotlib.tri.Triangulation``, with the same triangles and neighbours.
So contours, and all else that matplotlib does with triangles, need no grid.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np

rng = np.random.default_rng(1)
# More points where the ground is steep, as surveyors do it.
points = np.concatenate([rng.random((1500, 2)), rng.normal((0.62, 0.55), 0.12, (2500, 2))])
points = points[((points >= 0) & (points <= 1)).all(axis=1)]
x, y = points.T
depth = -20 - 15 * x + 34 * np.exp(-((x - 0.62) ** 2 + (y - 0.55) ** 2) / 0.02) + 5 * np.sin(9 * y)

tri = cadt.Delaunay(points)
mesh = tri.to_matplotlib()

fig, (left, right) = plt.subplots(
    1, 2, figsize=(10, 5), layout="constrained", sharex=True, sharey=True
)
tri.plot(left, linewidth=0.3)
left.set(title=f"{tri.n_triangles} triangles", aspect="equal")
filled = right.tricontourf(mesh, depth, levels=np.arange(-45, 20, 5), cmap="terrain")
lines = right.tricontour(mesh, depth, levels=np.arange(-45, 20, 5), colors="k", linewidths=0.5)
right.clabel(lines, fontsize=7)
right.set(title="depth around a shoal", aspect="equal")
fig.colorbar(filled, ax=right, label="m")
plt.show()
