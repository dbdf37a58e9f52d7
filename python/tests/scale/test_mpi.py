# SPDX-License-Identifier: Apache-2.0
"""cadt.mpi on 1, 2, 3 and 5 ranks. The cases are in mpi_program.py: one start of MPI for all of them."""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from mpi_program import digest, directory_points

HERE = pathlib.Path(__file__).parent
RANKS = (0, 1, 2, 3, 5)  # 0: one process, without mpirun
CASES = (
    "meshes",
    "tree_of_a_sample",
    "work_is_shared",
    "duplicates_across_ranks",
    "small_messages",
    "directory",
    "consumed",
    "not_finite",
    "errors_reach_all",
)


def run(ranks: int, folder: pathlib.Path) -> dict[str, dict]:
    command = [sys.executable, "-m", "mpi4py", str(HERE / "mpi_program.py"), str(folder)]
    if ranks:
        says = subprocess.run(["mpirun", "--version"], check=False, capture_output=True, text=True).stdout
        options = ["--oversubscribe", "--allow-run-as-root"] if "Open MPI" in says or "Open RTE" in says else []
        command = ["mpirun", *options, "-n", str(ranks), *command]
    # A process that has started MPI itself tells its children so.
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_", "PMI_"))}
    environment["OMPI_MCA_mpi_yield_when_idle"] = "1"  # ranks that wait leave the processors to the others
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=400, env=environment)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    return json.loads((folder / "results.json").read_text())


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[int, dict[str, dict]]:
    return {ranks: run(ranks, tmp_path_factory.mktemp(f"ranks{ranks}")) for ranks in RANKS}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("ranks", RANKS)
def test_case(results: dict[int, dict[str, dict]], ranks: int, case: str) -> None:
    assert not results[ranks][case]["wrong"], results[ranks][case]["wrong"]


def test_all_cases_are_run(results: dict[int, dict[str, dict]]) -> None:
    assert all(set(of) == set(CASES) for of in results.values())


def test_the_program_writes_the_same(results: dict[int, dict[str, dict]], tmp_path: pathlib.Path) -> None:
    program = os.environ.get("CADT_PROGRAM", "")
    if not program:
        pytest.skip("CADT_PROGRAM does not name the program cadt, whose directories are compared")
    np.save(tmp_path / "xy.npy", directory_points())
    command = [program, "tiles", tmp_path / "xy.npy", "-o", tmp_path / "mesh.cadt", "--tile-points", "25000"]
    subprocess.run([*command, "--backend", "host"], check=True, capture_output=True, timeout=400)
    assert digest(tmp_path / "mesh.cadt") == results[1]["directory"]["result"]


def test_directories_are_equal_byte_by_byte(results: dict[int, dict[str, dict]]) -> None:
    assert len({of["directory"]["result"] for of in results.values()}) == 1
