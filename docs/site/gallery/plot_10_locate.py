# SPDX-License-Identifier: Apache-2.0
"""
Point location beside SciPy
===========================

Which triangle contains each of a million points? Queries of one call are sorted along a curve, so
that neighbours walk through the same triangles, on all cores. SciPy walks from each query to the
next, however far that is; for one outside of the hull it looks at all triangles, so here all are
inside.
"""

import time

import cadt
import matplotlib.pyplot as plt
import numpy as np
import scipy.spatial

rng = np.random.default_rng(9)
points = rng.random((20_000, 2)) * 1.02 - 0.01
ours, theirs = cadt.Delaunay(points), scipy.spatial.Delaunay(points)


def seconds(find_simplex, where, repeat):
    best = np.inf
    for _ in range(repeat):
        start = time.perf_counter()
        result = find_simplex(where)
        best = min(best, time.perf_counter() - start)
    return best, result


counts = np.array([100, 1_000, 10_000, 100_000, 1_000_000])
times = np.full((2, len(counts)), np.nan)
theirs.find_simplex(points[:10])  # what it prepares for its first call
for i, n in enumerate(counts):
    where = rng.random((n, 2))
    times[0, i], found = seconds(ours.find_simplex, where, 3)
    if n <= 100_000:
        times[1, i], expected = seconds(theirs.find_simplex, where, 1)
        assert np.array_equal(np.sort(ours.simplices[found]), np.sort(theirs.simplices[expected]))
    print(f"{n:9,} queries: cadt {1e3 * times[0, i]:8.2f} ms, SciPy {1e3 * times[1, i]:8.1f} ms")

fig, ax = plt.subplots(figsize=(7, 4.5), layout="constrained")
ax.loglog(counts, times[1] / counts * 1e9, "o-", label="scipy.spatial.Delaunay.find_simplex")
ax.loglog(counts, times[0] / counts * 1e9, "o-", label="cadt.Delaunay.find_simplex")
ax.set(
    xlabel="queries in one call",
    ylabel="nanoseconds a query",
    title="20,000 points, queries in random order",
    ylim=(50, None),
)
ax.grid(alpha=0.3)
ax.legend()
plt.show()
