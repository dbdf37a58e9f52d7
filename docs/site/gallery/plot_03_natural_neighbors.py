# SPDX-License-Identifier: Apache-2.0
"""
Natural neighbours against linear
=================================

Three ways from values at points to values between them. ``linear`` bends at the edges of the triangles, ``nearest`` jumps, and
``natural`` (Sibson's natural neighbours) is smooth but at the points themselves. All three have the points' values at the points.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource

import cadt


def hills(x, y):
    return np.sin(5 * x) * np.cos(4 * y) + 0.5 * np.exp(-40 * ((x - 0.6) ** 2 + (y - 0.4) ** 2))


rng = np.random.default_rng(7)
corners = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
points = np.concatenate([rng.random((350, 2)), corners])
value = hills(*points.T)
tri = cadt.Delaunay(points)

side = 400
centre = (np.arange(side) + 0.5) / side
truth = hills(*np.meshgrid(centre, centre[::-1]))  # the first row is the top one

light = LightSource(azdeg=315, altdeg=35)
fig, axes = plt.subplots(1, 4, figsize=(13, 3.8), layout="constrained")
images = {"truth": truth}
for method in ("nearest", "linear", "natural"):
    images[method] = tri.rasterize(value, bounds=(0, 0, 1, 1), shape=(side, side), method=method)
for ax, (name, image) in zip(axes, images.items()):
    ax.imshow(light.shade(image, plt.get_cmap("viridis"), vert_exag=0.25, dx=1 / side, dy=1 / side, blend_mode="soft",
                          vmin=truth.min(), vmax=truth.max()), extent=(0, 1, 0, 1))
    error = np.sqrt(np.nanmean((image - truth) ** 2))
    ax.set(title=name if name == "truth" else f"{name}: error {error:.3f}", xticks=[], yticks=[])
    ax.plot(*points.T, "w.", ms=1)
plt.show()
