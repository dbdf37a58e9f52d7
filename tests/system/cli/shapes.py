# SPDX-License-Identifier: Apache-2.0
"""Polygons, GeoJSON and areas, which the tests of segments and of polygons share."""
import json

from harness import read_off, twice_area

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
HOLE = [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]
BOW_TIE = [[0, 0], [4, 4], [4, 0], [0, 4], [0, 0]]


def geojson(*geometries):
    return json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": str(i)}, "geometry": geometry} for i, geometry in enumerate(geometries)]})


def polygon(*rings):
    return {"type": "Polygon", "coordinates": rings}


def area_of(points, triangles):
    """Twice the area; every triangle must be counterclockwise."""
    areas = [twice_area(*(points[i] for i in triangle)) for triangle in triangles]
    assert all(area > 0 for area in areas), areas
    return sum(areas)


class ConstraintTest:
    def off(self, name):
        vertices, triangles = read_off(self.path(name).read_text())
        return [(float(x), float(y)) for x, y, _ in vertices], triangles

    def edges(self, triangles):
        return {tuple(sorted(pair)) for a, b, c in triangles for pair in ((a, b), (b, c), (c, a))}
