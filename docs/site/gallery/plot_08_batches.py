# SPDX-License-Identifier: Apache-2.0
"""
Thousands of small sets in one call
===================================

``triangulate_batch`` takes the points of all sets, one set after another. Each set gets the mesh
that it has alone, with the indices of its own points. The smaller the sets, the more one call
saves; on a graphics card, where a call costs more than a small set, it is the only way.
"""

import time
from itertools import pairwise

import cadt
import matplotlib.pyplot as plt
import numpy as np

rng = np.random.default_rng(6)
sizes = rng.integers(10, 90, 5000)
offsets = np.concatenate([[0], np.cumsum(sizes)])
angle = rng.random(offsets[-1]) * 2 * np.pi
radius = np.sqrt(rng.random(offsets[-1]))
lobes = np.repeat(rng.integers(2, 7, len(sizes)), sizes)  # a flower a set
points = (
    np.stack([np.cos(angle), np.sin(angle)], axis=1)
    * (radius * (1 + 0.45 * np.cos(lobes * angle)))[:, None]
)

batch = cadt.triangulate_batch(points, offsets)
start = time.perf_counter()
batch = cadt.triangulate_batch(points, offsets)
together = time.perf_counter() - start
start = time.perf_counter()
alone = [cadt.Delaunay(points[a:b]) for a, b in pairwise(offsets)]
one_by_one = time.perf_counter() - start
assert all(
    np.array_equal(batch[s].simplices, alone[s].simplices) for s in range(0, len(batch), 100)
)
print(
    f"{len(batch)} sets, {len(batch.simplices)} triangles: {1e3 * together:.0f} ms in one call, "
    f"{1e3 * one_by_one:.0f} ms one by one"
)

fig, axes = plt.subplots(4, 10, figsize=(12, 5), layout="constrained")
for s, ax in enumerate(axes.flat):
    own = points[offsets[s] : offsets[s + 1]]
    ax.triplot(*own.T, batch[s].simplices, lw=0.5, color=f"C{s % 10}")
    ax.set(aspect="equal", xticks=[], yticks=[])
    ax.axis("off")
fig.suptitle(f"40 of {len(batch)} sets")
plt.show()
