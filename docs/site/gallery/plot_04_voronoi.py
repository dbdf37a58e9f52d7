# SPDX-License-Identifier: Apache-2.0
"""
Voronoi cells within a box
==========================

``voronoi_polygons`` cuts the cells at a rectangle. They cover it without overlap, in the order of
the points, so a value for each point colours its cell.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

rng = np.random.default_rng(5)
radius, angle = rng.random(400) ** 0.7, rng.random(400) * 2 * np.pi
points = np.stack([radius * np.cos(angle), 0.6 * radius * np.sin(angle)], axis=1)

tri = cadt.Delaunay(points)
box = (-1.1, -0.7, 1.1, 0.7)
indptr, xy = tri.voronoi_polygons(box)
cells = np.split(xy, indptr[1:-1])
areas = np.array(
    [
        0.5 * abs(np.dot(c[:, 0], np.roll(c[:, 1], -1)) - np.dot(c[:, 1], np.roll(c[:, 0], -1)))
        for c in cells
    ]
)
print("area of the box", 2.2 * 1.4, "sum of the cells", areas.sum())

fig, ax = plt.subplots(figsize=(9, 5.8), layout="constrained")
drawn = PolyCollection(
    cells, array=np.log10(areas), cmap="YlGnBu_r", edgecolor="white", linewidth=0.6
)
ax.add_collection(drawn)
ax.plot(*points.T, "k.", ms=2)
ax.set(
    xlim=box[::2],
    ylim=box[1::2],
    aspect="equal",
    title="Voronoi cells of 400 points, by area",
    xticks=[],
    yticks=[],
)
fig.colorbar(drawn, ax=ax, label="log10 of the area", shrink=0.8)
plt.show()
