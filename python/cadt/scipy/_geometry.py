# SPDX-License-Identifier: Apache-2.0
"""Qhull's numbers of a triangulation: paraboloid, planes, barycentric transforms."""

from __future__ import annotations

import numpy as np


def paraboloid(points: np.ndarray, scaled: bool, at_infinity: bool) -> tuple[float, float]:
    """Scale and shift of the paraboloid. Qbb: so that its heights span as much as the largest coordinate; Qz: Qhull's
    point at infinity is 1.1 times as high as the highest."""
    if not scaled:
        return 1.0, 0.0
    heights = np.einsum("ij,ij->i", points, points)
    low, high = float(heights.min()), float(heights.max()) * (1.1 if at_infinity else 1.0)
    if not high > low:
        return 1.0, 0.0
    scale = max(float(np.abs(points).max()), np.finfo(np.double).tiny) / (high - low)
    return scale, -low * scale


def equations(points: np.ndarray, simplices: np.ndarray, scale: float, shift: float) -> np.ndarray:
    """(t, 4): unit normal, away from the paraboloid's inside, and offset of the plane of each lifted triangle."""
    a, b, c = (points[simplices[:, k]] for k in range(3))
    ab, ac = b - a, c - a
    # Differences of heights as products of differences and sums, which lose less than differences of squares.
    up_b, up_c = (scale * np.einsum("ij,ij->i", d, a + e) for d, e in ((ab, b), (ac, c)))
    result = np.empty((len(simplices), 4))
    result[:, 0] = up_b * ac[:, 1] - ab[:, 1] * up_c
    result[:, 1] = ab[:, 0] * up_c - up_b * ac[:, 0]
    result[:, 2] = ab[:, 1] * ac[:, 0] - ab[:, 0] * ac[:, 1]
    length = np.sqrt(np.einsum("ij,ij->i", result[:, :3], result[:, :3]))
    with np.errstate(divide="ignore", invalid="ignore"):
        result[:, :3] /= length[:, None]
    height = scale * np.einsum("ij,ij->i", a, a) + shift
    result[:, 3] = -(result[:, 0] * a[:, 0] + result[:, 1] * a[:, 1] + result[:, 2] * height)
    return result


def transforms(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """(t, 3, 2): the inverse of T = [a - c, b - c] and c; NaN where T's reciprocal condition number is below 1000 eps."""
    a, b, c = (points[simplices[:, k]] for k in range(3))
    with np.errstate(all="ignore"):
        u, v = a - c, b - c
        determinant = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        result = np.empty((len(simplices), 3, 2))
        result[:, 0, 0], result[:, 0, 1] = v[:, 1], -v[:, 0]
        result[:, 1, 0], result[:, 1, 1] = -u[:, 1], u[:, 0]
        result[:, :2] /= determinant[:, None, None]
        norm = np.maximum(np.abs(u).sum(axis=1), np.abs(v).sum(axis=1))
        norm_of_inverse = np.abs(result[:, :2]).sum(axis=1).max(axis=1)
        good = 1 / (norm * norm_of_inverse) >= 1000 * np.finfo(np.double).eps
    result[:, 2] = c
    result[~good] = np.nan
    return result
