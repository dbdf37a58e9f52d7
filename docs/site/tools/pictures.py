# SPDX-License-Identifier: Apache-2.0
"""Whether two PNG files show the same. Compression, and the last bits of colours, differ between machines. Standard library only."""

import pathlib
import struct
import zlib


def pixels(path: pathlib.Path) -> tuple[int, int, int, bytearray]:
    """Width, height, channels and bytes of a PNG with 8 bits a channel, not interlaced."""
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{path} is no PNG")
    at, packed = 8, b""
    width = height = channels = 0
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        kind, chunk = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        at += length + 12
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", chunk)
            channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
            if depth != 8 or interlaced:
                raise ValueError(f"{path}: {depth} bits, interlaced: {interlaced}")
        elif kind == b"IDAT":
            packed += chunk
    rows = zlib.decompress(packed)
    stride = width * channels
    image, above = bytearray(), bytearray(stride)
    for begin in range(0, height * (stride + 1), stride + 1):
        kind_of_row, row = rows[begin], bytearray(rows[begin + 1 : begin + 1 + stride])
        for i in range(stride) if kind_of_row else ():
            left, up = row[i - channels] if i >= channels else 0, above[i]
            corner = above[i - channels] if i >= channels else 0
            if kind_of_row == 4:  # Paeth: the neighbour nearest to left + up - corner
                p = left + up - corner
                guess = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
            else:
                guess = (0, left, up, (left + up) // 2)[kind_of_row]
            row[i] = (row[i] + guess) & 255
        image += row
        above = row
    return width, height, channels, image


def difference(one: pathlib.Path, other: pathlib.Path) -> float:
    """The mean difference of the channels, 0 to 255; infinite if the sizes differ."""
    *size, a = pixels(one)
    *size_of_other, b = pixels(other)
    if size != size_of_other:
        return float("inf")
    return sum(abs(x - y) for x, y in zip(a, b, strict=True)) / len(a)
