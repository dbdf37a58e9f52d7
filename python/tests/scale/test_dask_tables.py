# SPDX-License-Identifier: Apache-2.0
"""Tables of text are read as the program reads them."""

from __future__ import annotations

import json
import os
import pathlib
import subprocess

import cadt
import cadt.dask
import numpy as np
import pytest
from cadt import _tables
from cadt.dask import _sources

FOUR = [[0, 0], [4, 0], [0, 3], [5, 7]]
# Name, contents, and the points; None: it is an error.
FILES: list[tuple[str, bytes, list | None]] = [
    ("plain.xy", b"0 0\n4 0\n0 3\n5 7", FOUR),
    ("blanks.txt", b"\n# four\n  0   0\n\t4 0 \n\n0\t3\n5 7 # last\n", FOUR),
    ("tabs.txt", b"0\t0\n4\t0\n0\t3\n5\t7\t\t\n", FOUR),
    ("aligned.txt", b"0\t\t0\n4\t\t0\n0\t3\n5\t\t\t7\n", FOUR),
    ("cells.txt", b"0\t0\t1\n4\t\t0\n0\t3\t1\n", None),
    ("words.txt", b"name\tx\ty\na b\t0\t0\n\t4\t0\nc\t0\t3\nd\t5\t7\n", FOUR),
    ("comments.xyz", b"> segment\n0 0 1\n// note\n4 0 1 // two\n  # three\n0 3 1#\n5 7 1\n", FOUR),
    ("windows.csv", b"\xef\xbb\xbfx,y\r\n0,0\r\n4,0\r\n0,3\r\n5,7\r\n", FOUR),
    ("mark.csv", b"\xef\xbb\xbf0,0\n4,0\n0,3\n5,7\n", FOUR),
    ("wider.csv", b"x,y\n0,0,8,9\n4,0,8,9\n0,3,8,9\n5,7,8,9\n", FOUR),
    ("units.csv", b"X [m] Y [m]\n0 0\n4 0\n0 3\n5 7\n", None),  # four names, two columns
    ("metres.csv", b"X[m] Y[m]\n0 0\n4 0\n0 3\n5 7\n", FOUR),
    ("mirrored.csv", b"y,x\n0,0\n0,4\n3,0\n7,5\n", FOUR),
    ("geographic.csv", b"id;Lat;LON;depth\n1;0;0;9\n2;0;4;9\n3;3;0;9\n4;7;5;9\n", FOUR),
    ("survey.csv", b'"north","east"\n0,0\n0,4\n3,0\n7,5\n', FOUR),
    ("semicolons.csv", b"a;b,c;d\n0;0;n,5\n4;0;1,5\n0;3;1,5\n5;7;1,5\n", FOUR),
    ("quoted.csv", b'a,x,y\n"one, two",0,"0"\n"with ""q""",4,0\n"over\n\n#two",0,3\n,5,7,\n', FOUR),
    ("latin.csv", b"nom,x,y\n\xe9t\xe9,0,0\n,4,0\n,0,3\n,5,7\n", FOUR),
    ("forms.xy", b"+0 -0.\n4e0 .0E-3\n0. 3.0\n5. +7\n", FOUR),
    ("small.xy", b"1e-400 0\n4 0\n0 3\n5 7\n", FOUR),
    ("street.csv", b"x,y,street\n0,0,#1 DRIVE\n4,0,//\n0,3,>\n5,7,\n", FOUR),
    ("ends.csv", b"0,0,\n4,0,\n0,3\n5,7,\n", FOUR),
    ("empty.csv", b"", None),
    ("header.csv", b"x,y\n", None),
    ("notes.xy", b"# nothing\n\n", None),
    ("hexadecimal.xy", b"0x10 0\n4 0\n0 3\n5 7\n", None),
    ("grouped.xy", b"1_0 0\n4 0\n0 3\n5 7\n", None),
    ("later.xy", b"0 0\n4 0\n0 1_0\n5 7\n", None),
    ("third.xy", b"0 0\n4 0 1\n0 3\n5 7\n", None),
    ("fewer.csv", b"x,y,z\n0,0,1\n4,0\n0,3,1\n", None),
    ("height.xyz", b"0 0 1\n4 0 one\n0 3 1\n", None),
    ("word.csv", b"0,n/a\n4,0\n0,3\n5,7\n", None),
    ("infinite.csv", b"0,0\n4,inf\n0,3\n", None),
    ("large.csv", b"0,0\n4,1e999\n0,3\n", None),
    ("open.csv", b'0,0,"\n4,0,1\n0,3,1\n', None),
    ("one.csv", b"x\n1\n2\n", None),
    ("utf16.csv", "x,y\n0,0\n".encode("utf-16"), None),
    ("space.csv", "0,\xa00\n4,0\n0,3\n".encode(), None),
    ("return.csv", b"0,0\r4,0\r0,3\r", None),
]


def read(path: pathlib.Path) -> np.ndarray:
    file = _sources.open_file(path)
    return _sources.read(file, 0, file.count)


@pytest.mark.parametrize("together", [True, False])
@pytest.mark.parametrize(("name", "data", "points"), FILES, ids=[name for name, *_ in FILES])
def test_tables(
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    data: bytes,
    points: list | None,
    together: bool,
) -> None:
    """All further lines at once, as far as NumPy reads them as the program does, and in pieces of two."""
    if not together:
        monkeypatch.setattr(_tables, "CHUNK", 2)
    path = tmp_path / name
    path.write_bytes(data)
    if points is None:
        with pytest.raises(cadt.FileError) as caught:
            cadt.dask.triangulate([path])
        assert caught.value.path == str(path)
    else:
        assert read(path).tolist() == points


@pytest.mark.parametrize(("name", "data", "points"), FILES, ids=[name for name, *_ in FILES])
def test_the_program_reads_the_same(tmp_path: pathlib.Path, name: str, data: bytes, points: list | None) -> None:
    program = os.environ.get("CADT_PROGRAM", "")
    if not program:
        pytest.skip("CADT_PROGRAM does not name the program cadt, which reads the same files")
    path = tmp_path / name
    path.write_bytes(data)
    command = [program, "triangulate", path, "--backend", "host", "--quiet", "--stats=-"]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=400)
    assert done.returncode == (3 if points is None else 0), done.stderr
    if points is not None:
        mesh = json.loads(done.stdout)["mesh"]
        assert (mesh["points"], mesh["hash"]) == (len(points), cadt.Delaunay(points).hash)


def test_what_numpy_reads_is_what_is_read_row_by_row(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    xy = np.random.default_rng(0).random((1000, 2)) * 10.0 ** np.random.default_rng(1).integers(-9, 9, (1000, 1))
    for mark in " \t,;":
        (tmp_path / "a.txt").write_text("".join(f"{x!r}{mark}{y!r}{mark}7\n" for x, y in xy.tolist()))
        at_once = read(tmp_path / "a.txt")
        with monkeypatch.context() as m:
            m.setattr(_tables._Rows, "_at_once", lambda *_: None)
            assert np.array_equal(read(tmp_path / "a.txt"), at_once)
        assert np.array_equal(at_once, xy)


@pytest.mark.parametrize("shape", [(2, 5), (5, 1), (0, 2), (6,), (3, 2, 2)])
def test_arrays_that_are_no_points(tmp_path: pathlib.Path, shape: tuple[int, ...]) -> None:
    np.save(tmp_path / "a.npy", np.zeros(shape))
    with pytest.raises(cadt.FileError, match="a.npy"):
        cadt.dask.triangulate([tmp_path / "a.npy"])


def test_whole_numbers_without_a_double(tmp_path: pathlib.Path) -> None:
    np.save(tmp_path / "a.npy", np.array(FOUR))
    assert read(tmp_path / "a.npy").tolist() == FOUR
    np.save(tmp_path / "a.npy", np.array([*FOUR, [2**53 + 1, 0]]))
    with pytest.raises(cadt.FileError, match=r"row 4 .* is no double"):
        read(tmp_path / "a.npy")
