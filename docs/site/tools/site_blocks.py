# SPDX-License-Identifier: Apache-2.0
"""A plug-in of pytest: the Python blocks of documents are tests.

pytest -p site_blocks docs/site README.md      with docs/site/tools on PYTHONPATH
"""

import importlib.util
import pathlib

import pytest
from sybil import Sybil
from sybil.parsers.myst import PythonCodeBlockParser, SkipParser


@pytest.fixture
def in_a_folder(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a block writes goes to a folder of its own; pictures are drawn without a window."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")


def has_gpu() -> bool:
    if importlib.util.find_spec("cupy") is None:
        return False
    import cupy  # type: ignore[import-not-found,unused-ignore]

    return bool(cupy.cuda.is_available())


def prepare(namespace: dict[str, object]) -> None:
    namespace["no_gpu"] = not has_gpu()
    for name, package in (("no_mpi", "mpi4py"), ("no_dask", "distributed")):
        namespace[name] = importlib.util.find_spec(package) is None


pytest_collect_file = Sybil(
    parsers=[PythonCodeBlockParser(), SkipParser()],
    path=str(pathlib.Path(__file__).resolve().parents[3]),  # the repository
    patterns=["*.md"],
    setup=prepare,
    fixtures=["in_a_folder"],
).pytest()
