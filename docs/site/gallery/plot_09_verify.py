# SPDX-License-Identifier: Apache-2.0
"""
Verify the mesh of any program
==============================

``from_simplices`` takes a mesh of another program, if it is one: it is checked exactly, with
predicates that share no code with those that build. What is wrong is named, with the first triangle
or edge.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np
import scipy.spatial

rng = np.random.default_rng(8)
points = rng.random((60, 2))
theirs = scipy.spatial.Delaunay(points)
adopted = cadt.Delaunay.from_simplices(points, theirs.simplices)
print("SciPy's mesh:", adopted.verify())

# %%
# Flip one edge: the two triangles stay counterclockwise, but their circles are no longer empty.

ours = cadt.Delaunay(points)
broken = ours.simplices.copy()
area = lambda t: np.linalg.det(points[t[1:]] - points[t[0]])
middle = np.linalg.norm(points[ours.simplices].mean(axis=1) - 0.5, axis=1)
for t, k in sorted(np.argwhere(ours.neighbors >= 0), key=lambda edge: middle[edge[0]]):
    u = ours.neighbors[t, k]
    a, b, c = np.roll(ours.simplices[t], -k)  # the edge b c, opposite a
    d = np.setdiff1d(ours.simplices[u], [b, c])[0]
    flipped = np.array([[a, b, d], [a, d, c]])
    if min(area(flipped[0]), area(flipped[1])) > 0.006:
        broken[[t, u]] = flipped
        break

try:
    cadt.Delaunay.from_simplices(points, broken)
    raise SystemExit("a broken mesh was adopted")
except cadt.InvalidMesh as error:
    refused = error
    print("refused:", error)

# %%
# ``cadt.verify`` gives the whole report, and raises nothing.

for check in cadt.verify(points, broken).checks:
    print("pass" if check.passed else "FAIL", check.name, check.what)

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 5), layout="constrained")
left.triplot(*points.T, ours.simplices, color="C0", lw=0.7)
left.set(title="Delaunay", aspect="equal", xticks=[], yticks=[])
right.triplot(*points.T, broken, color="0.6", lw=0.7)
right.triplot(*points.T, broken[[t, u]], color="C3", lw=1.5)
for corners in points[broken[[t, u]]]:
    (ax_, ay), (bx, by), (cx, cy) = corners
    determinant = 2 * (ax_ * (by - cy) + bx * (cy - ay) + cx * (ay - by))
    s = (corners**2).sum(axis=1)
    centre = (
        np.array([s @ (by - cy, cy - ay, ay - by), s @ (cx - bx, ax_ - cx, bx - ax_)]) / determinant
    )
    right.add_patch(plt.Circle(centre, np.linalg.norm(corners[0] - centre), fill=False, color="C1"))
right.set(
    title=f"refused: {refused.check}",
    aspect="equal",
    xticks=[],
    yticks=[],
    xlim=left.get_xlim(),
    ylim=left.get_ylim(),
)
plt.show()
