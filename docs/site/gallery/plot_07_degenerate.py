# SPDX-License-Identifier: Apache-2.0
"""
Degenerate points: lattices, duplicates, UTM coordinates
========================================================

Real data is degenerate: grids, where four points lie on each circle; points that were measured
twice; coordinates of millions of metres, of which a float keeps half a metre. Signs are exact here,
so none of it needs jitter or a tolerance. What is lost *before* the points arrive cannot be brought
back, though.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np

rng = np.random.default_rng(4)

# %%
# A lattice: each square has two diagonals to choose from. The choice is a rule on the points, so it
# is the same in each run and on each device, whatever the order of the points.

side = np.arange(12.0)
lattice = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
shuffled = rng.permutation(lattice)
lattice_mesh = cadt.Delaunay(lattice)
lengths = [
    np.linalg.norm(p[t] - p[np.roll(t, 1, axis=1)], axis=2).sum()
    for p, t in ((lattice, lattice_mesh.simplices), (shuffled, cadt.Delaunay(shuffled).simplices))
]
print(
    "lattice:", lattice_mesh.n_triangles, "triangles; cocircular edges:", lattice_mesh.verify().ties
)
assert lengths[0] == lengths[1]

# %%
# Points measured twice: the first is the vertex. Nothing is renumbered.

measured = rng.random((120, 2))
twice = np.concatenate([measured, measured[:40]])
twice_mesh = cadt.Delaunay(twice)
print(
    "duplicates:",
    (twice_mesh.duplicate_of >= 0).sum(),
    "- point 125 equals point",
    twice_mesh.duplicate_of[125],
)

# %%
# A scan in UTM coordinates. As floats, northings of five million metres are multiples of half a
# metre: most points fall on others, and the rest form a lattice. The mesh of those is right, and
# useless. Keep doubles, or subtract an offset first.

scan = rng.random((1500, 2)) * 6 + (691_000, 5_334_000)
as_floats = scan.astype(np.float32)
exact, rounded = cadt.Delaunay(scan), cadt.Delaunay(as_floats)
print("as doubles:", exact.n_triangles, "triangles; as floats:", rounded.n_triangles)
assert (rounded.duplicate_of >= 0).sum() > 500

fig, axes = plt.subplots(1, 4, figsize=(14, 3.9), layout="constrained")
origin = np.array((691_000, 5_334_000))
for ax, points, mesh, title in (
    (axes[0], lattice, lattice_mesh, "lattice"),
    (axes[1], twice, twice_mesh, "40 points twice"),
    (axes[2], scan - origin, exact, f"UTM, doubles: {exact.n_triangles} triangles"),
    (
        axes[3],
        as_floats.astype(float) - origin,
        rounded,
        f"UTM, floats: {rounded.n_triangles} triangles",
    ),
):
    ax.triplot(*points.T, mesh.simplices, lw=0.5, color="C0")
    again = mesh.duplicate_of >= 0
    ax.plot(*points[again].T, ".", color="C3", ms=4)
    ax.set(title=title, aspect="equal", xticks=[], yticks=[])
plt.show()
