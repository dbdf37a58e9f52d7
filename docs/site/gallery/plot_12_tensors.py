# SPDX-License-Identifier: Apache-2.0
"""
A mesh on tensors
=================

Points can be tensors of torch, JAX or CuPy; they are taken by DLPack, without a copy where the
device can read them. On a graphics card the arrays of the mesh are tensors too and nothing passes
through the host; else they are NumPy's, which ``torch.from_numpy`` and ``jax.numpy.asarray`` take
over.

Here a thousand points push each other apart along the edges of their mesh, which is made anew after
each twenty steps.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np

try:
    import torch

    device = "cuda" if torch.cuda.is_available() else "cpu"
    tensor = lambda array: torch.as_tensor(array, device=device)
    add_rows = lambda n, index, rows: torch.zeros(
        (n, 2), dtype=rows.dtype, device=device
    ).index_add_(0, index.long(), rows)
    norm = lambda rows: torch.linalg.norm(rows, dim=1, keepdim=True)
    kind = f"torch {torch.__version__} on {device}"
except ImportError:
    import jax

    jax.config.update("jax_enable_x64", True)
    tensor = jax.numpy.asarray
    add_rows = lambda n, index, rows: jax.numpy.zeros((n, 2)).at[index].add(rows)
    norm = lambda rows: jax.numpy.linalg.norm(rows, axis=1, keepdims=True)
    kind = f"JAX {jax.__version__} on {jax.default_backend()}"

rng = np.random.default_rng(13)
angle = rng.random(1000) * 2 * np.pi
start = np.stack([np.cos(angle), np.sin(angle)], 1) * (rng.random(1000) ** 0.5)[:, None]
n = len(start)
points = tensor(start)
rest = np.sqrt(np.pi / n) * 1.15

for step in range(100):
    if step % 20 == 0:
        edges = tensor(cadt.Delaunay(points).edges)
    along = points[edges[:, 1]] - points[edges[:, 0]]
    length = norm(along)
    force = (rest - length).clip(0) * along / length  # springs that push
    points = points + 0.2 * (add_rows(n, edges[:, 1], force) - add_rows(n, edges[:, 0], force))
    points = points / norm(points).clip(1.0)  # stay in the disk
tri = cadt.Delaunay(points)
print(kind, "-", tri)

last = np.asarray(points.cpu() if hasattr(points, "cpu") else points)
triangles = np.asarray(tri.simplices.cpu() if hasattr(tri.simplices, "cpu") else tri.simplices)
fig, axes = plt.subplots(1, 2, figsize=(10, 5), layout="constrained")
for ax, p, t, title in (
    (axes[0], start, cadt.Delaunay(start).simplices, "before"),
    (axes[1], last, triangles, "after 100 steps"),
):
    corner = p[t]
    sides = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2)
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    quality = (
        2 * np.sqrt(3) * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / (sides**2).sum(axis=1)
    )
    drawn = ax.tripcolor(
        *p.T, t, facecolors=quality, cmap="RdYlGn", vmin=0, vmax=1, edgecolors="k", linewidth=0.2
    )
    ax.set(title=title, aspect="equal", xticks=[], yticks=[])
fig.colorbar(drawn, ax=axes, label="quality of a triangle (1: equilateral)", shrink=0.8)
plt.show()
