# SPDX-License-Identifier: Apache-2.0
"""
The mesh as a graph: spanning tree and clusters
===============================================

``vertex_neighbors`` are the rows of a sparse matrix (CSR), so the mesh is a graph for
``scipy.sparse`` without any loop. The Euclidean minimum spanning tree is part of the Delaunay
triangulation; cutting its long edges gives clusters.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree

rng = np.random.default_rng(12)
half = rng.random(700) * np.pi
moons = np.concatenate(
    [np.stack([np.cos(half), np.sin(half)], 1), np.stack([1 - np.cos(half), 0.4 - np.sin(half)], 1)]
)
points = np.concatenate(
    [moons + rng.normal(0, 0.06, moons.shape), rng.normal((2.6, 0.8), 0.12, (300, 2))]
)

tri = cadt.Delaunay(points)
indptr, indices = tri.vertex_neighbors
start = np.repeat(np.arange(len(points)), np.diff(indptr))
length = np.linalg.norm(points[start] - points[indices], axis=1)
graph = csr_matrix((length, indices, indptr), shape=(len(points), len(points)))
tree = minimum_spanning_tree(graph).tocoo()
kept = tree.data < 0.2
count, cluster = connected_components(
    csr_matrix((tree.data[kept], (tree.row[kept], tree.col[kept])), shape=graph.shape),
    directed=False,
)
print("edges of the mesh", graph.nnz // 2, "- of the tree", tree.nnz, "- clusters", count)

fig, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained")
left.triplot(*points.T, tri.simplices, color="0.8", lw=0.4)
left.add_collection(LineCollection(points[np.stack([tree.row, tree.col], 1)], color="C0", lw=1))
left.set(title="Delaunay edges, and the spanning tree", aspect="equal", xticks=[], yticks=[])
right.scatter(*points.T, c=cluster, cmap="tab10", s=6)
right.set(
    title=f"{count} clusters: the tree without edges above 0.2",
    aspect="equal",
    xticks=[],
    yticks=[],
)
plt.show()
