# SPDX-License-Identifier: Apache-2.0
"""What is said: one line of progress on a terminal; none in a pipe, and none with --quiet."""

from __future__ import annotations

import contextlib
import shutil
import sys
import time

from ._files import why
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
        raise FileError("standard output", f"cannot be written: {why(error)}") from error


class ProgressLine:
    """Shows what runs. Every message clears it first, so that lines start at the left edge."""

    def __init__(self, quiet: bool = False) -> None:
        self.quiet = quiet
        self._shown = not quiet and sys.stderr is not None and sys.stderr.isatty()
        self._length = 0
        self._last = 0.0

    def step(self, text: str) -> None:
        if not self._shown:
            return
        cut = text[: max(shutil.get_terminal_size().columns - 1, 10)]
        tell("\r" + cut.ljust(self._length), end="")
        self._length = max(self._length, len(cut))
        self._last = time.monotonic()

    def update(self, text: str, fraction: float) -> None:
        """At most ten lines a second are drawn."""
        if self._shown and time.monotonic() - self._last >= 0.1:
            self.step(f"{text:<10} {100 * fraction:3.0f} %")

    def clear(self) -> None:
        if self._length:
            tell("\r" + " " * self._length + "\r", end="")
            self._length = 0

    def say(self, text: str) -> None:
        """A line that stays; not with --quiet."""
        self.clear()
        if not self.quiet:
            tell(text)

    def warn(self, text: str) -> None:
        self.say(f"cadt: warning: {text}")
