# SPDX-License-Identifier: Apache-2.0
"""What ranks say to each other: arrays of any size, and errors, which are those of all ranks."""

from __future__ import annotations

import contextlib
import pickle
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from cadt._errors import Error

if TYPE_CHECKING:
    from collections.abc import Callable

    from mpi4py import MPI

    Result = TypeVar("Result")

# Elements of a message at most: counts of MPI are ints, before version 4.
MOST_ELEMENTS = 2**30


class Group:
    """The ranks of a communicator. All of its functions are collective."""

    def __init__(self, comm: MPI.Intracomm) -> None:
        self.comm = comm
        self.rank: int = comm.rank
        self.size: int = comm.size

    def together(self, work: Callable[[], Result]) -> Result:
        """Runs `work` on each rank. An exception of one is raised on all: that of the lowest rank, with its number in
        `rank`. The work itself must not be collective."""
        from mpi4py import MPI

        result, error = None, None
        try:
            result = work()
        except BaseException as e:  # Ctrl-C too: the others must not wait for ever
            error = e
        failed = self.comm.allreduce(self.size if error is None else self.rank, op=MPI.MIN)
        if failed == self.size:
            return result  # type: ignore[return-value]
        raised = self.comm.bcast(_portable(error) if self.rank == failed else None, root=failed)
        if self.rank == failed and error is not None:
            raised = error
        with contextlib.suppress(AttributeError, TypeError):  # an exception of a user's, which does not take it
            raised.rank = failed
        if raised is not error and hasattr(raised, "add_note"):  # Python 3.11
            raised.add_note(f"raised by rank {failed} of {self.size}")
        raise raised

    def gather_rows(self, rows: np.ndarray) -> np.ndarray:
        """The rows of all ranks, in their order, on all ranks."""
        counts = self.comm.allgather(len(rows))
        whole = self.together(lambda: np.empty((sum(counts), *rows.shape[1:]), rows.dtype))
        begin, step = 0, _step(rows)
        for rank, count in enumerate(counts):
            if rank == self.rank:
                whole[begin : begin + count] = rows
            for first in range(begin, begin + count, step):
                self.comm.Bcast(whole[first : min(first + step, begin + count)], root=rank)
            begin += count
        return whole

    def exchange(self, rows: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Sends the first ``counts[0]`` rows to rank 0, the next ones to rank 1, and so on. Returns what all ranks sent
        to this one, in their order, and how many rows of each. O(ranks) messages, and more for more elements."""
        from mpi4py import MPI

        received = np.array(self.comm.alltoall([int(c) for c in counts]), np.int64)
        whole = self.together(lambda: np.empty((int(received.sum()), *rows.shape[1:]), rows.dtype))
        to_ends, from_ends = np.cumsum(counts), np.cumsum(received)
        step = _step(rows)
        for shift in range(self.size):
            to, source = (self.rank + shift) % self.size, (self.rank - shift) % self.size
            sent = rows[to_ends[to] - counts[to] : to_ends[to]]
            taken = whole[from_ends[source] - received[source] : from_ends[source]]
            if shift == 0:
                taken[:] = sent
                continue
            requests = [self.comm.Irecv(taken[i : i + step], source) for i in range(0, len(taken), step)]
            requests += [self.comm.Isend(sent[i : i + step], to) for i in range(0, len(sent), step)]
            MPI.Request.Waitall(requests)
        return whole, received

    def sum(self, numbers: np.ndarray) -> np.ndarray:
        """Elementwise over all ranks; unsigned numbers wrap around."""
        from mpi4py import MPI

        return self._reduce(numbers, MPI.SUM)

    def minimum(self, numbers: np.ndarray) -> np.ndarray:
        from mpi4py import MPI

        return self._reduce(numbers, MPI.MIN)

    def _reduce(self, numbers: np.ndarray, op: MPI.Op) -> np.ndarray:
        result = np.empty_like(numbers)
        step = _step(numbers)
        for i in range(0, len(numbers), step):
            self.comm.Allreduce(numbers[i : i + step], result[i : i + step], op)
        return result


def _step(rows: np.ndarray) -> int:
    return max(1, MOST_ELEMENTS // max(1, int(np.prod(rows.shape[1:]))))


def _portable(error: BaseException | None) -> BaseException:
    """The exception, or what can be sent of it."""
    try:
        copy = pickle.loads(pickle.dumps(error))
        if isinstance(copy, BaseException):
            return copy
    except Exception:  # an exception of a user's, which cannot be pickled
        pass
    return Error(f"{type(error).__name__}: {error}")
