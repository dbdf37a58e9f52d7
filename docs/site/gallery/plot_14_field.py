# SPDX-License-Identifier: Apache-2.0
"""
Vectors between stations, and paths through them
================================================

Values need not be single numbers: ``interpolate`` takes any number of columns. Here 300 stations
have measured the wind; natural neighbours give it in between, and particles follow it.
"""

import cadt
import matplotlib.pyplot as plt
import numpy as np

rng = np.random.default_rng(15)
stations = rng.random((300, 2)) * 2 - 1
x, y = stations.T
wind = np.stack([-y - 0.6 * x * (x**2 + y**2 - 0.4), x - 0.6 * y * (x**2 + y**2 - 0.4)], axis=1)
wind += rng.normal(0, 0.03, wind.shape)

tri = cadt.Delaunay(stations)
particles = np.concatenate([rng.normal(0, 0.05, (40, 2)), rng.random((60, 2)) * 1.6 - 0.8])
paths = [particles]
for _ in range(120):
    particles = particles + 0.04 * tri.interpolate(
        wind, particles, method="natural", outside="nearest"
    )
    paths.append(particles)
paths = np.array(paths)

speed = tri.rasterize(
    np.linalg.norm(wind, axis=1), bounds=(-1, -1, 1, 1), shape=(300, 300), method="natural"
)
fig, ax = plt.subplots(figsize=(7, 6), layout="constrained")
image = ax.imshow(speed, extent=(-1, 1, -1, 1), cmap="PuBu")
ax.plot(paths[:, :, 0], paths[:, :, 1], color="C1", lw=0.8, alpha=0.8)
ax.quiver(x, y, *wind.T, scale=30, width=0.002)
ax.set(aspect="equal", xlim=(-1, 1), ylim=(-1, 1), title="wind at 300 stations, and 100 paths")
fig.colorbar(image, ax=ax, label="speed")
plt.show()
