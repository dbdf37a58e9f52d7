# SPDX-License-Identifier: Apache-2.0
"""
Scattered heights to a shaded relief
====================================

Laser scanners and echo sounders give points; maps want a grid. ``rasterize`` fills a grid from the
triangles: no search, each cell belongs to exactly one triangle.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource

# %%
# A landscape of 200,000 points: hills of all sizes, and a river that no point lies in.

rng = np.random.default_rng(3)
points = rng.random((200_000, 2)) * (3000, 2000)
x, y = points.T
height = np.zeros(len(points))
for octave in range(7):
    angle, phase = rng.random((2, 6)) * 2 * np.pi
    for a, p in zip(angle, phase):
        wave = 2.0**octave / 1800 * 2 * np.pi
        height += 90 / 2.0 ** (1.1 * octave) * np.sin(wave * (np.cos(a) * x + np.sin(a) * y) + p)
river = np.abs(y - 1000 - 300 * np.sin(x / 450)) < 40
points, height = points[~river], height[~river]

# %%
# One cell is two metres. Triangles with an edge longer than 60 m would bridge the river: they
# become no data (NaN).

tri = cadt.Delaunay(points)
dem = tri.rasterize(height, bounds=(0, 0, 3000, 2000), resolution=2, max_edge=60)
print(tri)
print("raster", dem.shape, "cells without data", np.isnan(dem).sum())

light = LightSource(azdeg=315, altdeg=40)
# Light falls on heights; what has none is water.
relief = light.shade(
    np.nan_to_num(dem, nan=np.nanmin(dem)),
    cmap=plt.get_cmap("gist_earth"),
    vert_exag=1.5,
    dx=2,
    dy=2,
    vmin=np.nanmin(dem) - 60,
    vmax=np.nanmax(dem) + 20,
    blend_mode="soft",
)
relief[np.isnan(dem)] = (0.55, 0.72, 0.85, 1)
fig, ax = plt.subplots(figsize=(9, 6), layout="constrained")
ax.imshow(relief, extent=(0, 3000, 0, 2000))
ax.set(xlabel="east (m)", ylabel="north (m)", title="200,000 heights, 1500 x 1000 cells")
plt.show()
