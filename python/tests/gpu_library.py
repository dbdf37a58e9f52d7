# SPDX-License-Identifier: Apache-2.0
"""The libraries whose arrays are in the memory of a GPU, for tests that are skipped without CUDA."""
from __future__ import annotations

import cadt
import numpy as np
import pytest

MODULES = ["cupy", "torch", "jax"]


def has_cuda() -> str:
    infos = [d for d in cadt.devices() if d.backend == "cuda"]
    return "" if any(d.usable for d in infos) else infos[0].reason


needs_cuda = pytest.mark.skipif(bool(has_cuda()), reason=f"no CUDA device: {has_cuda()}")


def x64(jax, enabled: bool):
    return (jax.enable_x64 if hasattr(jax, "enable_x64") else jax.experimental.enable_x64)(enabled)


class Library:
    """One array library, in the test's words."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.xp = pytest.importorskip(name)

    def put(self, a: np.ndarray):
        if self.name == "torch":
            return self.xp.from_numpy(np.array(a)).cuda()
        if self.name == "jax":
            with x64(self.xp, True):
                return self.xp.device_put(a, self.xp.devices("gpu")[0])
        return self.xp.asarray(a)

    def get(self, a) -> np.ndarray:
        self.check(a)
        if self.name == "torch":
            return a.cpu().numpy()
        return self.xp.asnumpy(a) if self.name == "cupy" else np.asarray(a)

    def stream(self):
        """A new stream that is current in a `with`; CuPy and PyTorch have them."""
        return self.xp.cuda.stream(self.xp.cuda.Stream()) if self.name == "torch" else self.xp.cuda.Stream(non_blocking=True)

    def keep_busy(self) -> None:
        """Keeps the current stream busy for about 0.1 s."""
        if self.name == "torch":
            return self.xp.cuda._sleep(200_000_000)
        wait = 'extern "C" __global__ void wait() { for (long long b = clock64(); clock64() - b < 200000000;) ; }'
        self.xp.RawKernel(wait, "wait")((1,), (1,), ())

    def check(self, a) -> None:
        if self.name == "torch":
            assert a.is_cuda
        elif self.name == "cupy":
            assert isinstance(a, self.xp.ndarray)
        else:
            assert next(iter(a.devices())).platform in ("gpu", "cuda")


@pytest.fixture(params=MODULES)
def library(request):
    library = Library(request.param)
    if request.param != "jax":
        yield library
        return
    with x64(library.xp, True):
        yield library
