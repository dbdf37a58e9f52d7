# SPDX-License-Identifier: Apache-2.0
"""What queries read and write, and Voronoi cells by brute force."""
import ast
import struct
import zipfile


def plane(x, y):
    return 2 * x - 3 * y + 5


def xyz_text(points, height=plane):
    return "".join(f"{x} {y} {height(x, y)}\n" for x, y in points)


def read_npy(data):
    """Shape and flat list of an array."""
    assert data[:6] == b"\x93NUMPY", data[:6]
    length = struct.unpack("<H", data[8:10])[0]
    header = ast.literal_eval(data[10:10 + length].decode())
    assert not header["fortran_order"]
    kind = {"<f8": "d", "<i4": "i", "<u4": "I"}[header["descr"]]
    body = data[10 + length:]
    return header["shape"], list(struct.unpack(f"<{len(body) // struct.calcsize(kind)}{kind}", body))


def npy_bytes(descr, shape, kind, numbers):
    header = repr({"descr": descr, "fortran_order": False, "shape": shape}).encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + struct.pack(f"<{len(numbers)}{kind}", *numbers)


def read_npz(path):
    with zipfile.ZipFile(path) as archive:
        return {name[:-4]: read_npy(archive.read(name)) for name in archive.namelist()}


def read_asc(text):
    """Header and rows."""
    lines = text.splitlines()
    header = {key.lower(): float(value) for key, value in (line.split() for line in lines[:6])}
    return header, [[float(word) for word in line.split()] for line in lines[6:]]


def clipped(polygon, p, q):
    """The part of a convex polygon that is nearer to p than to q."""
    a, b = 2 * (q[0] - p[0]), 2 * (q[1] - p[1])
    c = q[0] ** 2 + q[1] ** 2 - p[0] ** 2 - p[1] ** 2
    side = [a * x + b * y - c for x, y in polygon]
    result = []
    for i, (point, s) in enumerate(zip(polygon, side)):
        other, t = polygon[i - 1], side[i - 1]
        if (s <= 0) != (t <= 0):
            f = t / (t - s)
            result.append((other[0] + f * (point[0] - other[0]), other[1] + f * (point[1] - other[1])))
        if s <= 0:
            result.append(point)
    return result


def area(polygon):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(polygon, polygon[1:] + polygon[:1])) / 2


def cell(points, p, box):
    """Voronoi cell of p within the box."""
    x0, y0, x1, y1 = box
    polygon = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    for q in points:
        if q != p:
            polygon = clipped(polygon, p, q)
    return polygon


def sibson(points, values, q, box):
    """Natural neighbours: shares of the cell that q would take from each point."""
    own = cell(points, q, box)
    shares = [area(clipped_all(own, p, points)) for p in points]
    return sum(s * v for s, v in zip(shares, values)) / sum(shares)


def clipped_all(polygon, p, points):
    for other in points:
        if other != p and polygon:
            polygon = clipped(polygon, p, other)
    return polygon
