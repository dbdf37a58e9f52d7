# SPDX-License-Identifier: Apache-2.0
"""What can go wrong, and the exit codes of the program cadt (docs/cli.md)."""

from __future__ import annotations

from cadt._errors import (
    BackendUnavailable,
    Cancelled,
    DeviceError,
    Error,
    InputError,
    KernelBuildError,
    LimitError,
    OptionError,
)

EXIT_DONE = 0
EXIT_INTERNAL = 1
EXIT_USAGE = 2
EXIT_FILE = 3
EXIT_UNAVAILABLE = 5
EXIT_MEMORY = 6
EXIT_INTERRUPTED = 130


class TerrainError(Error):
    """Base of the errors of cadt.terrain; `code` is the exit code of the program."""

    code = EXIT_INTERNAL


class UsageError(TerrainError, ValueError):
    """An option has a value that makes no sense, or two of them contradict each other."""

    code = EXIT_USAGE


class FileError(TerrainError, OSError):
    """A file cannot be read, is malformed, holds nothing of use, or cannot be written."""

    code = EXIT_FILE

    def __init__(self, path: object, why: str) -> None:
        super().__init__(f"{path}: {why}")
        self.path = str(path)


class CrsError(FileError):
    """A coordinate reference system is missing, not understood, or not that of the other files."""


class Unavailable(TerrainError, ImportError):
    """A package that is needed is not installed."""

    code = EXIT_UNAVAILABLE

    def __init__(self, what: str, package: str, install: str = "cadt[terrain]") -> None:
        super().__init__(f'{what} needs the Python package {package}, which is not installed: pip install "{install}"')
        self.package = package


_ADVICE = (
    (OptionError, EXIT_USAGE, ""),
    (InputError, EXIT_FILE, ""),
    (LimitError, EXIT_FILE, "Split the input into tiles."),
    (
        BackendUnavailable,
        EXIT_UNAVAILABLE,
        "See what there is with: cadt devices. `--backend auto` takes the best one.",
    ),
    (KernelBuildError, EXIT_UNAVAILABLE, "Update the driver of this device, or use --backend host."),
    (DeviceError, EXIT_UNAVAILABLE, "Run it again, choose another device (see: cadt devices), or use --backend host."),
)


def code_of(error: BaseException) -> tuple[int, str] | None:
    """Exit code of an error of the library, and what to do; None if it is none that a user could do anything about."""
    return next(((code, advice) for kind, code, advice in _ADVICE if isinstance(error, kind)), None)


__all__ = ["Cancelled", "CrsError", "FileError", "TerrainError", "Unavailable", "UsageError", "code_of"]
