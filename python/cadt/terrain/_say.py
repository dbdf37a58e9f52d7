# SPDX-License-Identifier: Apache-2.0
"""Text for standard error and standard output."""

from __future__ import annotations

import contextlib
import sys

from .errors import FileError


def tell(text: str, end: str = "\n") -> None:
    """Text on standard error, if there is one and it takes it: no work fails for what cannot be said."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            print(text, end=end, file=sys.stderr, flush=True)


def write_out(text: str) -> None:
    """Text on standard output. Raises FileError if it cannot be written."""
    try:
        print(text, end="", flush=True)
    except OSError as error:
        raise FileError("standard output", f"cannot be written: {error.strerror or error}") from error
