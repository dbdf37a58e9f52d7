# SPDX-License-Identifier: Apache-2.0
"""Outputs appear under their names when they are complete."""

from __future__ import annotations

import contextlib
import os
import pathlib
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from .errors import FileError, UsageError

# Arrays for the next n points of a source, (n, 2) and (n,), to be filled before it asks again.
Room = Callable[[int], tuple[NDArray[np.float64], NDArray[np.float64]]]


def suffix_of(path: str) -> str:
    """The suffix in lower case, without the dot."""
    return pathlib.PurePath(path).suffix.lower()[1:]


def why(error: BaseException) -> str:
    """The reason alone: messages of libraries repeat the name, which may be that of a temporary file."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    text = str(error).strip().splitlines()
    return text[0] if text else type(error).__name__


def check_utf8(path: str) -> None:
    """Raises FileError if GDAL cannot be told the name."""
    try:
        path.encode()
    except UnicodeEncodeError as error:
        raise FileError(path, "GDAL takes no name that is not UTF-8; rename it") from error


def rasterio_errors() -> tuple[type[Exception], ...]:
    """All that rasterio raises. Those of GDAL come as they are where it has no name of its own for them."""
    from rasterio.errors import RasterioError

    try:
        from rasterio._err import CPLE_BaseError
    except ImportError:
        return (RasterioError,)
    return RasterioError, CPLE_BaseError


def from_root(path: str, file: str) -> str:
    """The name `file` from the root on; that of a file that messages call `path`."""
    try:
        return file if os.path.isabs(file) else os.path.join(os.getcwd(), file)
    except OSError as error:
        raise FileError(path, f"the working directory is not there any more: {why(error)}") from error


def check_input(path: str) -> None:
    """Raises FileError if there is no file of this name to be read."""
    try:
        if os.path.isdir(path):
            raise FileError(path, "is a folder; name a file in it")
        with open(path, "rb"):
            pass
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(path, f"cannot be opened: {why(error)}") from error


def check_output(path: str, formats: Sequence[str], inputs: Sequence[str]) -> str:
    """The format of an output, from its suffix. Whatever can be known to be wrong about it is found here, before any
    work: an unknown suffix and an input of the same name (UsageError), a folder that is missing or closed (FileError).
    """
    suffix = suffix_of(path)
    if suffix not in formats:
        said = f"unknown suffix '.{suffix}'" if suffix else "no suffix"
        raise UsageError(f"{path}: {said}; end the output's name in one of: {', '.join(formats)}")
    from_root(path, path)
    if os.path.isdir(path):
        raise FileError(path, "is a folder; name a file in it")
    for name in inputs:
        if os.path.exists(path) and os.path.exists(name) and os.path.samefile(path, name):
            raise UsageError(f"{path}: this is an input, which would be lost; give the output another name")
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder):
        raise FileError(path, f"cannot be written: there is no folder '{folder}'; create it first")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(path, f"cannot be written: the folder '{folder}' is closed to writing")
    return suffix


@contextlib.contextmanager
def complete_file(path: str) -> Iterator[str]:
    """The name of a temporary file beside `path`, with the same suffix. It gets the name `path` at the end of the block,
    and is removed if the block raises, with what libraries put beside it."""
    target = pathlib.Path(os.path.realpath(path))  # a link is followed: the link stays
    temporary = target.with_name(f".{target.stem}.{os.getpid()}.tmp{target.suffix}")
    try:
        yield str(temporary)
        os.replace(temporary, target)
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(path, f"cannot be written: {why(error)}") from error
    finally:
        for left in target.parent.glob(f".{_escaped(target.stem)}.{os.getpid()}.tmp*"):
            with contextlib.suppress(OSError):
                left.unlink()


def _escaped(text: str) -> str:
    return "".join(f"[{c}]" if c in "*?[" else c for c in text)
