# SPDX-License-Identifier: Apache-2.0
"""
Natural neighbours against linear
=================================

Three ways from values at points to values between them. ``linear`` bends at the edges of the
triangles, ``nearest`` jumps, and ``natural`` (Sibson's natural neighbours) is smooth except at the
points. All three have the points' values at the points.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource


def hills(x, y):
    return np.sin(5 * x) * np.cos(4 * y) + 0.5 * np.exp(-40 * ((x - 0.6) ** 2 + (y - 0.4) ** 2))


rng = np.random.default_rng(7)
side = np.linspace(0, 1, 11)[:-1]  # and ten points on each side of the square
sides = [
    np.stack([side, 0 * side], 1),
    np.stack([1 - side, 1 + 0 * side], 1),
    np.stack([0 * side, 1 - side], 1),
    np.stack([1 + 0 * side, side], 1),
]
points = np.concatenate([rng.random((180, 2)), *sides])
value = hills(*points.T)
tri = cadt.Delaunay(points)

cells = 400
centre = (np.arange(cells) + 0.5) / cells
truth = hills(*np.meshgrid(centre, centre[::-1]))  # the first row is the top one

light = LightSource(azdeg=315, altdeg=35)
fig, axes = plt.subplots(1, 4, figsize=(13, 3.8), layout="constrained")
images = {"truth": truth}
for method in ("nearest", "linear", "natural"):
    images[method] = tri.rasterize(value, bounds=(0, 0, 1, 1), shape=(cells, cells), method=method)
for ax, (name, image) in zip(axes, images.items()):
    ax.imshow(
        light.hillshade(image, vert_exag=0.5, dx=1 / cells, dy=1 / cells),
        cmap="gray",
        extent=(0, 1, 0, 1),
    )
    error = np.sqrt(np.nanmean((image - truth) ** 2))
    ax.set(title=name if name == "truth" else f"{name}: error {error:.3f}", xticks=[], yticks=[])
    ax.plot(*points.T, ".", color="C3", ms=2)
plt.show()
