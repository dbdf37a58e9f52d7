# SPDX-License-Identifier: Apache-2.0
"""Tables of numbers in text, as the program cadt reads them: the rules are those of io/points/table*.cpp. What cadt.dask
and cadt.terrain share."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

CHUNK = 1 << 16  # lines that NumPy gets at a time
# Names of x and y that go together, and of heights.
FAMILIES = (
    (("x",), ("y",)),
    (("lon", "longitude", "long", "lng"), ("lat", "latitude")),
    (("easting", "east"), ("northing", "north")),
)
HEIGHTS = ("z", "height", "elevation", "elev", "altitude", "alt", "depth")

_BLANKS = " \t\v\f"
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[+-]?(?:nan(?:\([0-9a-z_]*\))?|inf|infinity)", re.IGNORECASE)
_LIKE_A_NUMBER = re.compile(r"[+-]?\.?(?:[0-9].*|nan|inf|infinity|nan\(.*)", re.IGNORECASE | re.DOTALL)
# A cell between two tabs, or before the first.
_EMPTY_CELL = re.compile(r"\t[ \v\f]*\t|^[ \v\f]*\t", re.MULTILINE)
_COMMENT = re.compile(r"^[ \t]*(?:[#>]|//)", re.MULTILINE)
_OTHER_SPACES = re.compile(r"[\x85\xa0\u1680\u2000-\u200a\u2028\u2029\u202f\u205f\u3000]")


class TableError(ValueError):
    """The table cannot be read; the message lacks the name of the file."""


@dataclass(frozen=True)
class Layout:
    """`columns` are those of x and y and perhaps of heights, counted from 0. Without a header, `third_if_number`: the third
    column is the height if there is a number."""

    columns: list[int]
    has_header: bool
    third_if_number: bool = False


def recognised(names: list[str]) -> list[int] | None:
    """The columns of x and y, and of heights if there are any, by names in small letters."""

    def find(wanted: tuple[str, ...]) -> list[int]:
        return [names.index(name) for name in wanted if name in names][:1]

    for of_x, of_y in FAMILIES:
        x, y = find(of_x), find(of_y)
        if x and y:
            return x + y + find(HEIGHTS)
    return None


def has_names(fields: list[str]) -> bool:
    """Whether the first row is a header: its names are known ones, or none looks like a number."""
    return recognised([field.lower() for field in fields]) is not None or not any(map(looks_like_number, fields))


def plain_layout(fields: list[str]) -> Layout:
    """What the first row says of a table, of which nothing else is known."""
    known = recognised([field.lower() for field in fields])
    if known is None and has_names(fields):
        check_guess(fields)
    return Layout(known or [0, 1], has_names(fields), known is None)


def check_guess(names: list[str]) -> None:
    """Two or three columns with unknown names are x, y and perhaps heights; of more, nobody knows. Raises TableError."""
    if len(names) > 3:
        raise TableError(
            f"of {len(names)} columns with names none are x and y, lon and lat, or easting and northing: choose columns by "
            "number or name, or name two of them x and y"
        )


def looks_like_number(field: str) -> bool:
    """Whether it means a number, be it a valid one or not."""
    return _LIKE_A_NUMBER.fullmatch(field) is not None


def read_table(path: str, layout: Callable[[list[str]], Layout]) -> NDArray[np.float64]:
    """The columns that `layout` chooses by the fields of the first row. Raises TableError and OSError."""
    with open(path, "rb") as raw:
        start = raw.read(2)
    if not start:
        raise TableError("is empty")
    if start in (b"\xff\xfe", b"\xfe\xff"):
        raise TableError("is UTF-16 text or binary; text must be ASCII or UTF-8")
    with open(path, encoding="utf-8-sig", errors="surrogateescape", newline="\n") as file:
        rows = _Rows(file)
        fields = rows.next()
        if fields is None:
            raise TableError("has no points")
        of = layout(fields)
        if of.has_header and (fields := rows.next()) is None:
            raise TableError("has no points, only a header line")
        columns = list(of.columns)
        if of.third_if_number and len(fields) > 2 and looks_like_number(fields[2]):
            columns.append(2)
        # In a table of two columns a third field is a mistake; wider tables may hold anything in the other columns.
        parts = [np.array([rows.numbers(fields, columns, strict := len(fields) == 2)])]
        parts.extend(rows.rest(columns, strict))
    return np.concatenate(parts)


class _Rows:
    """Splits a table into rows of fields. The separator is found in the first row: a semicolon, else a comma, else a tab if
    there are words, else blanks. With a separator fields may be quoted, and then go on in the next line."""

    def __init__(self, file: Iterator[str]) -> None:
        self._file = self._lines = file
        self._number = 0
        self._separator = ""  # blanks are one, too
        self._single_tabs = False  # two tabs in a row mean an empty cell, although blanks separate
        self._line = 0  # where the row starts

    def next(self) -> list[str] | None:
        """The fields of the next row; None at the end."""
        while (line := self._next_line()) is not None:
            start = line.lstrip(_BLANKS)
            if not start or start[0] in "#>" or start.startswith("//"):
                continue
            self._line = self._number
            if not self._separator:
                if "\0" in line:
                    raise TableError("is not text")
                self._find_separator(line)
            if self._separator != " ":
                return self._split_quoted(line) if '"' in line else self._split(line)
            line = line.partition("#")[0].partition("//")[0].rstrip(_BLANKS)
            if self._single_tabs and _EMPTY_CELL.search(line):
                self._fail("there is an empty cell between tabs")
            return _words(line)
        return None

    def numbers(self, fields: list[str], columns: list[int], strict: bool) -> list[float]:
        """Those of a row."""
        if len(fields) <= max(columns) or (strict and len(fields) != 2):
            found = "1 field" if len(fields) == 1 else f"{len(fields)} fields"
            self._fail(f"the line has {found}, {'2 are' if strict else f'column {max(columns) + 1} is'} expected")
        return [self._number_of(fields[column], column) for column in columns]

    def rest(self, columns: list[int], strict: bool) -> Iterator[NDArray[np.float64]]:
        """All further rows in pieces: by NumPy where it reads them in the same way, else one after another."""
        while lines := list(itertools.islice(self._file, CHUNK)):
            table = self._at_once(lines, columns, strict)
            if table is not None:
                self._number += len(lines)
            else:
                end = self._number + len(lines)
                self._lines = itertools.chain(lines, self._file)
                rows = []
                while self._number < end and (fields := self.next()) is not None:
                    rows.append(self.numbers(fields, columns, strict))
                table = np.array(rows, np.float64).reshape(-1, len(columns))
            yield table

    def _at_once(self, lines: list[str], columns: list[int], strict: bool) -> NDArray[np.float64] | None:
        text = "".join(lines)
        blanks = self._separator == " "
        if _is_odd(text) or (self._single_tabs and _EMPTY_CELL.search(text)):
            return None
        if any(mark in text for mark in ("#", ">", "//")) and (blanks or _COMMENT.search(text)):
            return None
        if not text.strip():
            return np.empty((0, len(columns)))
        mark = None if blanks else self._separator
        try:
            if not strict:
                table = np.loadtxt(lines, delimiter=mark, comments=None, usecols=columns, ndmin=2)
            elif (table := np.loadtxt(lines, delimiter=mark, comments=None, ndmin=2)).shape[1] == 2:
                table = table[:, columns]
            else:
                return None
        except ValueError:
            return None  # row by row it is found out where and why
        return table if np.isfinite(table).all() else None

    def _next_line(self) -> str | None:
        line = next(self._lines, None)
        if line is None:
            return None
        self._number += 1
        return line.removesuffix("\n").removesuffix("\r")

    def _find_separator(self, line: str) -> None:
        outside = "".join(line.split('"')[::2])
        self._separator = next((mark for mark in ";," if mark in outside), " ")
        if self._separator == " " and "\t" in outside:
            # Between words tabs separate fields that may hold spaces. Between numbers they are blanks like others, but two
            # in a row mean an empty cell, unless the first row has them as well: then they align the columns.
            numbers = all(_NUMBER.fullmatch(word) or _NOT_FINITE.fullmatch(word) for word in _words(line))
            self._separator = " " if numbers else "\t"
            self._single_tabs = numbers and not _EMPTY_CELL.search(line.rstrip(_BLANKS))

    def _split(self, line: str) -> list[str]:
        *fields, last = (field.strip(_BLANKS) for field in line.split(self._separator))
        return [*fields, last] if last else fields  # some writers put a separator at the end of each line

    def _split_quoted(self, line: str) -> list[str]:
        lines, quotes = [line], line.count('"')
        while quotes % 2:
            further = self._next_line()
            if further is None:
                self._fail("a quoted field is not closed")
            lines.append(further)
            quotes += further.count('"')
        # Every second part is quoted; no text of a file has this half of a surrogate pair.
        parts = "\n".join(lines).split('"')
        parts[::2] = (part.replace(self._separator, "\ud800") for part in parts[::2])
        *fields, last = (field.strip(_BLANKS) for field in '"'.join(parts).split("\ud800"))
        fields += [last] if last else []
        return [f[1:-1].strip(_BLANKS) if len(f) > 1 and f[0] == f[-1] == '"' else f for f in fields]

    def _number_of(self, field: str, column: int) -> float:
        if _NUMBER.fullmatch(field) and np.isfinite(value := float(field)):
            return value
        if not field:
            self._fail(f"column {column + 1} is empty")
        problem = "is not a finite number" if _NOT_FINITE.fullmatch(field) else "is not a decimal number"
        problem = "is too large for a double" if _NUMBER.fullmatch(field) else problem
        self._fail(f"column {column + 1}: {field[:40]!r} {problem}")

    def _fail(self, why: str) -> NoReturn:
        raise TableError(f"cannot be read: line {self._line}: {why}")


def _is_odd(text: str) -> bool:
    """Whether NumPy may take it in another way: quotes, spaces and ends of lines that are none here."""
    if any(char in text for char in '"\0\v\f\x1c\x1d\x1e\x1f') or text.count("\r") != text.count("\r\n"):
        return True
    return not text.isascii() and _OTHER_SPACES.search(text) is not None


def _words(line: str) -> list[str]:
    return re.findall(r"[^ \t\v\f]+", line)
