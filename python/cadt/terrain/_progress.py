# SPDX-License-Identifier: Apache-2.0
"""One line on a terminal; nothing in a pipe, and nothing with --quiet."""

from __future__ import annotations

import shutil
import sys
import time

from ._say import tell


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
