# SPDX-License-Identifier: Apache-2.0
"""cadt-terrain: what the program cadt hands LAS, LAZ, GIS files and GeoTIFF to. Every outcome is an exit code.

NumPy and all that takes long to import come after `main` has seen to signals.
"""

from __future__ import annotations

import logging
import os
import signal
import sys
import time
import warnings
from collections.abc import Sequence
from types import FrameType

from . import errors
from ._say import tell, write_out

TOGETHER = 0.5  # seconds after a signal in which others say the same
_stopped: float | None = None  # when the first signal came


def _explain(error: BaseException) -> int:
    """Says what happened on standard error; the exit code."""
    code, advice = (
        errors.EXIT_INTERNAL,
        "This is a defect of cadt: please report it with the command line and the input.",
    )
    # Whatever a library makes of a signal.
    if _stopped is not None or isinstance(error, (KeyboardInterrupt, errors.Cancelled)):
        tell("cadt: interrupted")
        return errors.EXIT_INTERRUPTED
    if isinstance(error, errors.TerrainError):
        code, advice = error.code, ""
    elif isinstance(error, MemoryError):
        code, advice = (
            errors.EXIT_MEMORY,
            "Use fewer points, a larger --res, or close other programs; cadt raster needs less with --scratch.",
        )
    elif (known := errors.code_of(error)) is not None:
        code, advice = known
    text = str(error) or type(error).__name__
    tell(f"cadt: error: {text if code != errors.EXIT_INTERNAL else f'internal: {type(error).__name__}: {text}'}")
    if advice:
        tell(f"  {advice}")
    return code


def _stop(number: int, frame: FrameType | None) -> None:
    """The first signal stops the work, which cleans up; a later one ends the process at once. Those that come with the
    first are the same wish: timeout signals its child, and then the group."""
    global _stopped  # noqa: PLW0603
    now = time.monotonic()
    if _stopped is None:
        _stopped = now
        raise KeyboardInterrupt
    if now - _stopped >= TOGETHER:
        signal.signal(number, signal.SIG_DFL)
        signal.raise_signal(number)


def run(command: str, words: Sequence[str]) -> int:
    from . import _options
    from ._progress import ProgressLine

    options = _options.parse(command, words)
    if options.threads:
        os.environ.setdefault("RAYON_NUM_THREADS", str(options.threads))  # of lazrs
    line = ProgressLine(options.quiet)
    try:
        if command == "raster":
            from .raster import raster_command as work
        elif command == "contour":
            from .contour import contour_command as work
        else:
            from .tin import tin_command as work
        summary = work(options, line)
    finally:
        line.clear()
    if not options.quiet:
        for key, value in summary.items():
            tell(f"{key:<12}{value}")
    return errors.EXIT_DONE


def _open_standard_streams() -> None:
    """Those that the caller has closed: else the next file would get the number of one, and what is written there."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free


def _forget_what_cannot_be_written() -> None:
    """Python would try it again when it ends, and change the exit code."""
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def command(words: Sequence[str]) -> int:
    """One command line; the exit code. Every error is a message on standard error."""
    try:
        from . import _options

        if not words or words[0] in ("-h", "--help"):
            write_out(_options.main_help())
            return errors.EXIT_DONE if words else errors.EXIT_USAGE
        if words[0] == "--version":
            import cadt

            write_out(f"cadt {cadt.__version__}\n")
            return errors.EXIT_DONE
        if words[0] not in _options.SUMMARIES:
            near = _options.suggestion(words[0], _options.SUMMARIES) or f"; there are: {', '.join(_options.SUMMARIES)}"
            raise errors.UsageError(f"there is no command '{words[0]}'{near}")
        return run(words[0], words[1:])
    except SystemExit as done:  # --help
        return int(done.code or 0)
    except BaseException as error:  # noqa: BLE001  an exit code and a message for each
        return _explain(error)


def main() -> int:
    _open_standard_streams()
    for number in (signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)):
        if signal.getsignal(number) is not signal.SIG_IGN:  # nohup stays nohup
            signal.signal(number, _stop)
    # What libraries have to say about a file becomes one error of ours, or nothing.
    logging.getLogger("laspy").addHandler(logging.NullHandler())
    warnings.simplefilter("ignore")
    code = command(sys.argv[1:])
    _forget_what_cannot_be_written()
    if _stopped is not None:
        os._exit(code)  # a library's call that takes no notice may still run
    return code


if __name__ == "__main__":
    sys.exit(main())
