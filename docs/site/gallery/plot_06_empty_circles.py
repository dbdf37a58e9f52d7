# SPDX-License-Identifier: Apache-2.0
"""
The largest empty circles
=========================

Where are the holes? Circumcircles of triangles have no point inside. ``largest_empty_circles(k)``
finds the k largest with their centres in the convex hull. (On its boundary a larger circle may have
its centre.) Many of them overlap: here the largest that do not.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np

rng = np.random.default_rng(11)
points = rng.random((3000, 2)) * (1.6, 1)
for centre, radius in (((0.35, 0.6), 0.14), ((1.0, 0.3), 0.1), ((1.25, 0.75), 0.12)):  # clearings
    points = points[np.hypot(*(points - centre).T) > radius]

tri = cadt.Delaunay(points)
centers, radii, triangles = tri.largest_empty_circles(1000)
apart: list[int] = []
for i in range(len(radii)):
    if (
        all(np.hypot(*(centers[i] - centers[j])) > radii[i] + radii[j] for j in apart)
        and len(apart) < 20
    ):
        apart.append(i)
centers, radii, triangles = centers[apart], radii[apart], triangles[apart]
inside = np.linalg.norm(points[None] - centers[:, None], axis=2).min(axis=1)
print("largest radii", radii[:4].round(4), "- distance to the nearest point", inside[:4].round(4))

fig, ax = plt.subplots(figsize=(9, 5.6), layout="constrained")
ax.plot(*points.T, ".", color="0.35", ms=2)
for rank, (c, r) in enumerate(zip(centers, radii), 1):
    ax.add_patch(plt.Circle(c, r, facecolor="C1", edgecolor="C3", alpha=0.45))
    ax.annotate(str(rank), c, ha="center", va="center", fontsize=8)
ax.triplot(*points.T, tri.simplices[triangles[:3]], color="C0", lw=1)
ax.set(
    aspect="equal",
    xticks=[],
    yticks=[],
    title="the 20 largest empty circles apart, and the triangles of the first three",
)
plt.show()
