# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os

# SciPy solves systems of two equations with OpenBLAS, whose threads then wait for each other: on two busy cores tests take
# seventeen times as long. It reads this when it is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pytest

FAMILIES = ("random", "float32", "lattice", "duplicates", "far", "circle")


def family(name: str) -> np.ndarray:
    """Sets of points that differ in what is hard about them."""
    rng = np.random.default_rng(7)
    if name == "random":
        return rng.random((300, 2))
    if name == "float32":
        return rng.random((200, 2), dtype=np.float32)
    if name == "lattice":
        return np.stack(np.meshgrid(np.arange(12.0), np.arange(9.0)), axis=-1).reshape(-1, 2)
    if name == "duplicates":
        return rng.permutation(np.repeat(rng.random((60, 2)), 3, axis=0))
    if name == "far":  # UTM coordinates in millimetres
        return np.round(rng.random((200, 2)) * 100, 3) + [500_000, 5_300_000]
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    return np.concatenate([np.stack([np.cos(angle), np.sin(angle)], axis=1), rng.random((40, 2)) - 0.5])


@pytest.fixture(params=FAMILIES)
def points(request: pytest.FixtureRequest) -> np.ndarray:
    return family(request.param)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(1)


@pytest.fixture
def general(rng: np.random.Generator) -> np.ndarray:
    """Points in general position, which have one triangulation."""
    return rng.random((300, 2)) * [3, 2] + 10
