# SPDX-License-Identifier: Apache-2.0
"""
Point location beside SciPy
===========================

Which triangle contains each of a million points? Queries of one call are sorted along a curve, so that neighbours walk through the
same triangles, on all cores.
"""

import time

import matplotlib.pyplot as plt
import numpy as np
import scipy.spatial

import cadt

rng = np.random.default_rng(9)
points = rng.random((100_000, 2))
ours, theirs = cadt.Delaunay(points), scipy.spatial.Delaunay(points)


def seconds(call, repeat):
    best = np.inf
    for _ in range(repeat):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return best


counts = np.array([1_000, 10_000, 100_000, 1_000_000])
times = np.empty((2, len(counts)))
for i, n in enumerate(counts):
    where = rng.random((n, 2)) * 1.02 - 0.01
    times[:, i] = seconds(lambda: ours.find_simplex(where), 3), seconds(lambda: theirs.find_simplex(where), 1)
same = (ours.find_simplex(where) == -1) == (theirs.find_simplex(where) == -1)
print("inside or outside as in SciPy:", same.mean())
for n, a, b in zip(counts, *times):
    print(f"{n:9,} queries: cadt {1e3 * a:8.2f} ms, SciPy {1e3 * b:8.1f} ms: {b / a:.0f} times")

fig, ax = plt.subplots(figsize=(7, 4.5), layout="constrained")
ax.loglog(counts, times[1] / counts * 1e9, "o-", label="scipy.spatial.Delaunay.find_simplex")
ax.loglog(counts, times[0] / counts * 1e9, "o-", label="cadt.Delaunay.find_simplex")
ax.set(xlabel="queries in one call", ylabel="nanoseconds a query", title="100,000 points, queries in random order", ylim=(10, None))
ax.grid(alpha=0.3)
ax.legend()
plt.show()
