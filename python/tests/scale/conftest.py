# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pathlib

import pytest
from scale_needed import MISSING


def pytest_ignore_collect(collection_path: pathlib.Path) -> bool | None:
    """Without the packages, test_scale_packages.py alone is left, and says so."""
    return (MISSING and collection_path.match("test_*.py") and collection_path.name != "test_scale_packages.py") or None


@pytest.fixture
def no_client(monkeypatch: pytest.MonkeyPatch) -> None:
    """cadt.dask works by threads of this process."""

    def default_client() -> None:
        raise ValueError

    monkeypatch.setattr("dask.distributed.default_client", default_client)
    monkeypatch.setattr("distributed.default_client", default_client)
