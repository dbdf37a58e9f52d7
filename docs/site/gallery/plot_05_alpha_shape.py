# SPDX-License-Identifier: Apache-2.0
"""
Alpha shapes: the outline of points
===================================

The convex hull closes bays and holes. ``alpha_shape`` keeps the triangles whose circle is small,
and gives the boundary of what is left: the lower the radius, the more it follows the points.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

rng = np.random.default_rng(2)
points = rng.random((60_000, 2)) * (4, 2) - (2, 1)
x, y = points.T
ring = np.abs(np.hypot(x + 0.9, y) - 0.65) < 0.22  # a letter C, and a letter A ...
gap = (x > -0.75) & (np.abs(y) < 0.3)
legs = (np.abs(np.abs(x - 0.9) - 0.42 * (0.85 - y)) < 0.14) & (np.abs(y) < 0.85)
bar = (np.abs(x - 0.9) < 0.45) & (np.abs(y + 0.25) < 0.1)
points = points[(ring & ~gap) | legs | bar][:6000]

tri = cadt.Delaunay(points)
fig, axes = plt.subplots(1, 3, figsize=(12, 3.2), layout="constrained", sharex=True, sharey=True)
for ax, r in zip(axes, (np.inf, 0.15, 0.045)):
    triangles, edges = tri.alpha_shape(r)
    ax.tripcolor(
        *points.T,
        tri.simplices[triangles],
        facecolors=np.ones(len(triangles)),
        cmap="Blues",
        vmin=0,
        vmax=3,
    )
    ax.plot(*points.T, ".", color="0.4", ms=0.6)
    ax.add_collection(LineCollection(points[edges], color="C3", linewidth=1.6))
    ax.set(
        title=f"radius {r}: {len(triangles)} triangles, {len(edges)} edges",
        aspect="equal",
        xticks=[],
        yticks=[],
    )
plt.show()
