# SPDX-License-Identifier: Apache-2.0
"""Progress bars: tqdm's where it is installed, else a line on a terminal, and nothing in a pipe."""

from __future__ import annotations

import contextlib
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@contextlib.contextmanager
def reporter(progress: Any) -> Iterator[Callable[[str, float], object] | None]:
    """What a call of the library reports to, from `Delaunay(progress=...)`."""
    if progress is None or progress is False:
        yield None
    elif callable(progress):
        yield progress
    elif progress is not True:
        raise TypeError("progress must be True, False or a callable(phase, fraction)")
    elif sys.stderr is None:  # nobody would see it
        yield None
    else:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            yield from _line()
            return
        with tqdm(total=100, unit="%", leave=False, bar_format="{l_bar}{bar}| {postfix}") as bar:

            def report(phase: str, fraction: float) -> None:
                bar.set_postfix_str(phase, refresh=False)
                bar.update(100 * fraction - bar.n)

            yield report


def _line() -> Iterator[Callable[[str, float], object] | None]:
    if not sys.stderr.isatty():
        yield None
        return

    def write(text: str) -> None:
        with contextlib.suppress(OSError):  # of a terminal that is gone
            sys.stderr.write(text)
            sys.stderr.flush()

    try:
        yield lambda phase, fraction: write(f"\r\033[Kcadt: {phase} {fraction:4.0%}")
    finally:
        write("\r\033[K")
