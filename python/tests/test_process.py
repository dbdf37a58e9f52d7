# SPDX-License-Identifier: Apache-2.0
"""Threads, forks, signals, subinterpreters and the end of a process, each in a process of its own."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

START = """
import gc, os, signal, sys, threading, time, weakref
import numpy as np, cadt
rng = np.random.default_rng(0)
def slow(points, **how):  # long enough for reports and signals, also where there is a GPU
    return cadt.Delaunay(points, backend="host", threads=1, **how)
def wait(pid, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        done, status = os.waitpid(pid, os.WNOHANG)
        if done: return status
        time.sleep(0.02)
    os.kill(pid, signal.SIGKILL); os.waitpid(pid, 0)
    return "hangs"
def run(work, count):
    threads = [threading.Thread(target=work, args=(k,)) for k in range(count)]
    for t in threads: t.start()
    for t in threads: t.join()
"""


def run(script: str, *options: str) -> str:
    """Runs a script, in which any warning is an error, and what is left at exit is an error too."""
    command = [sys.executable, "-X", "dev", "-W", "error", *options, "-c", START + textwrap.dedent(script)]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "leak" not in done.stderr and "Fatal" not in done.stderr, done.stderr
    assert done.stdout.strip().endswith("done"), done.stdout + done.stderr
    return done.stderr


def test_threads_share_a_mesh() -> None:
    run("""
        p = rng.random((20_000, 2)); q = rng.random((20_000, 2))
        wanted = cadt.Delaunay(p); found = wanted.find_simplex(q); wrong = []
        mesh = cadt.Delaunay(p); barrier = threading.Barrier(8)
        def work(k):
            barrier.wait()  # all ask for the first time at once
            for _ in range(3):
                if (mesh.find_simplex(q) != found).any(): wrong.append("find_simplex")
                if (mesh.edges != wanted.edges).any(): wrong.append("edges")
                if cadt.Delaunay(p).hash != mesh.hash: wrong.append("triangulate")
                if cadt.triangulate_batch(p[:900], range(0, 901, 9))[7].n_points != 9: wrong.append("batch")
        run(work, 8)
        assert not wrong, wrong
        print("done")
    """)


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="no fork here")
def test_threads_that_ask_first_after_a_fork() -> None:
    run("""
        p = rng.random((50_000, 2)); mesh = cadt.Delaunay(p); expected = mesh.find_simplex(p)
        pid = os.fork()
        if pid == 0:
            try:
                wrong = []; barrier = threading.Barrier(4)
                def work(k):
                    barrier.wait()
                    for _ in range(3):
                        if (mesh.find_simplex(p) != expected).any(): wrong.append(k)
                run(work, 4); os._exit(3 if wrong else 0)
            except BaseException as e:
                print(repr(e), flush=True); os._exit(4)
        status = wait(pid, 60)
        assert status == 0, status
        print("done")
    """)


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="no fork here")
def test_fork_while_another_thread_computes() -> None:
    run("""
        p = rng.random((300_000, 2)); mesh = cadt.Delaunay(p); expected = mesh.find_simplex(p[:100])
        small = cadt.Delaunay(p[:1000]).hash; stop = []
        def ask():
            while not stop: mesh.find_simplex(p)
        def make():
            while not stop: cadt.Delaunay(p)
        busy = [threading.Thread(target=f) for f in (ask, make)]
        for t in busy: t.start()
        time.sleep(0.3)
        import warnings; warnings.simplefilter("ignore")  # Python 3.12 warns of forks with threads
        for _ in range(5):
            pid = os.fork()
            if pid == 0:
                try:
                    good = (mesh.find_simplex(p[:100]) == expected).all() and cadt.Delaunay(p[:1000]).hash == small
                    good = good and cadt.Delaunay(p[:1000], threads=2).hash == small
                    del mesh; gc.collect()
                    os._exit(0 if good else 3)
                except BaseException as e:
                    print(repr(e), flush=True); os._exit(4)
            status = wait(pid, 60)
            assert status == 0, status
        stop.append(1)
        for t in busy: t.join()
        print("done")
    """)


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="no fork here")
def test_drivers_are_refused_after_a_fork() -> None:
    """They would wait for ever for threads that a child does not have."""
    run("""
        import warnings; warnings.simplefilter("ignore")  # Python 3.12 warns of forks with threads
        p = rng.random((300, 2)); square = [[0, 0], [1, 0], [1, 1], [0, 1]]; many = np.arange(0, 301, 30)
        opencl = {"backend": "opencl"}
        def child(work):
            pid = os.fork()
            if pid == 0:
                try: os._exit(0 if work() else 3)
                except BaseException as e:
                    print(repr(e), flush=True); os._exit(4)
            return wait(pid, 60)
        def mesh(): return cadt.Delaunay(p, **opencl)
        def batch(): cadt.triangulate_batch(p, many, **opencl)
        def polygons(): cadt.polygons(square, [0, 4], **opencl)
        def released():
            mesh(); cadt.release_memory()
        def is_refused(work):
            try: work()
            except cadt.BackendUnavailable as e: return "fork" in str(e)
        def parent(before, after):  # in a process that has opened nothing
            before()
            return child(lambda: is_refused(after)) == 0
        pairs = ((cadt.devices, mesh), (released, mesh), (batch, batch), (batch, mesh), (mesh, batch), (mesh, polygons),
                 (polygons, polygons), (mesh, cadt.devices))
        if child(lambda: any(d.usable for d in cadt.devices() if d.backend == "opencl")) == 0:
            for before, after in pairs:
                status = child(lambda: parent(before, after))
                assert status == 0, (before, after, status)
            expected = cadt.Delaunay(p, backend="host").find_simplex(p)
            def asks_in_a_child(ask_before):
                mine = mesh()
                if ask_before: mine.find_simplex(p)
                return child(lambda: (mine.find_simplex(p) == expected).all()) == 0
            for ask_before in (False, True):
                status = child(lambda: asks_in_a_child(ask_before))
                assert status == 0, (ask_before, status)
        print("done")
    """)


@pytest.mark.parametrize(
    "call",
    [
        "cadt.Delaunay(p, backend='host', threads=1)",
        "cadt.Delaunay(p, backend='host', threads=1, progress=lambda phase, fraction: None)",
        "mesh.find_simplex(q)",
        "cadt.Delaunay(p[:1000], backend='host')",
    ],
)
def test_the_process_ends_while_a_thread_is_in_a_call(call: str) -> None:
    script = f"""
        import sys, threading, time, numpy as np, cadt
        q = np.random.default_rng(0).random((2_000_000, 2)); p = q[:200_000]
        mesh = cadt.Delaunay(p, backend="host"); mesh.find_simplex(p[:1])
        def loop():
            while True: {call}
        threading.Thread(target=loop, daemon=True).start()
        time.sleep(float(sys.argv[1]))
    """
    for k in range(4):
        command = [sys.executable, "-c", textwrap.dedent(script), str(0.1 + 0.06 * k)]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=400)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr


def test_a_signal_handler_asks_the_mesh_that_is_asked() -> None:
    run("""
        p = rng.random((2_000_000, 2)); mesh = slow(p[:100_000]); expected = mesh.find_simplex(p[:10]); answers = []
        import warnings; warnings.simplefilter("ignore")  # Python 3.12 warns of forks with threads
        def handler(number, frame): answers.append(mesh.find_simplex(p[:10]))
        signal.signal(signal.SIGALRM, handler)
        pid = os.fork()  # a child, as a thread that waits for itself hears nothing
        if pid == 0:
            signal.setitimer(signal.ITIMER_REAL, 0.1)
            mesh.find_simplex(p)
            os._exit(0 if len(answers) == 1 and (answers[0] == expected).all() else 3)
        status = wait(pid, 60)
        assert status == 0, status
        print("done")
    """)


def test_interrupt_while_another_thread_asks() -> None:
    run("""
        p = rng.random((8_000_000, 2)); mesh = slow(p[:200_000]); mesh.find_simplex(p[:1]); ended = []
        def ask():
            mesh.find_simplex(p); ended.append(1)
        other = threading.Thread(target=ask); other.start(); time.sleep(0.5)
        threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
        try: mesh.find_simplex(p[:1])
        except KeyboardInterrupt: assert not ended
        else: raise AssertionError("not interrupted")
        other.join()
        print("done")
    """)


def test_subinterpreters_are_refused(tmp_path: Path) -> None:
    said = tmp_path / "said"
    run(f"""
        try: import _xxsubinterpreters as interpreters
        except ImportError: import _interpreters as interpreters
        script = '''if True:
            import sys
            sys.path[:] = PATH
            try:
                import cadt
                reason = cadt.__version__
            except ImportError as e:
                reason = str(e)
            with open({str(said)!r}, "w") as f:
                f.write(reason)
        '''
        interpreters.run_string(interpreters.create(), script.replace("PATH", repr(sys.path)))
        print("done")
    """)
    assert "interpreter" in said.read_text()


def test_interrupt() -> None:
    run("""
        p = rng.random((5_000_000, 2)); mesh = slow(p[:200_000]); mesh.find_simplex(p[:1])
        begin = time.monotonic(); mesh.find_simplex(p); whole = time.monotonic() - begin
        for call in (lambda: slow(p), lambda: mesh.find_simplex(np.concatenate([p] * 4))):
            threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
            try: call()
            except KeyboardInterrupt: pass
            else: raise AssertionError("not interrupted")
        assert mesh.find_simplex(p[:10]).min() >= -1 and cadt.Delaunay(p[:100]).verify()
        print("done")
    """)


def test_interrupt_while_segments_cross() -> None:
    run("""
        p = rng.random((3000, 2)); s = np.arange(3000).reshape(-1, 2); times = []
        for _ in range(5):  # other processes run beside it
            begin = time.monotonic(); cadt.ConstrainedDelaunay(p, s, crossing="exact", backend="host")
            whole = time.monotonic() - begin; begin = time.monotonic()
            timer = threading.Timer(whole / 8, os.kill, (os.getpid(), signal.SIGINT)); timer.start()
            try: cadt.ConstrainedDelaunay(p, s, crossing="exact", backend="host"); timer.join(); time.sleep(1)
            except KeyboardInterrupt: times.append((time.monotonic() - begin) / whole)
            if times and times[-1] < 0.5: break
        assert times and times[-1] < 0.5, times
        p = rng.random((4000, 2)); s = np.arange(4000).reshape(-1, 2); times = []
        for _ in range(5):
            begin = time.monotonic(); cadt.find_crossings(p, s); whole = time.monotonic() - begin; begin = time.monotonic()
            timer = threading.Timer(whole / 8, os.kill, (os.getpid(), signal.SIGINT)); timer.start()
            try: cadt.find_crossings(p, s); timer.join(); time.sleep(1)
            except KeyboardInterrupt: times.append((time.monotonic() - begin) / whole)
            if times and times[-1] < 0.5: break
        assert times and times[-1] < 0.5, times
        print("done")
    """)


def test_progress_that_raises() -> None:
    run("""
        p = rng.random((400_000, 2)); calls = []
        class Mine(Exception): pass
        def stop(phase, fraction):
            calls.append(phase); raise Mine(phase)
        for progress, error in ((stop, Mine), (lambda: 0, TypeError), (lambda p, f: sys.exit(3), SystemExit)):
            try: slow(p, progress=progress)
            except error: pass
            else: raise AssertionError("did not end")
        assert len(calls) == 1, calls
        inner = slow(p, progress=lambda p_, f: cadt.Delaunay(p[:100]))
        assert inner.hash == cadt.Delaunay(p).hash
        print("done")
    """)


def test_points_that_go_during_the_call() -> None:
    run("""
        p = rng.random((400_000, 2)); expected = cadt.Delaunay(p).hash; seen = []
        def drop(phase, fraction):
            global p
            p = None; gc.collect(); seen.append(phase)
        mesh = slow(p, progress=drop)
        assert seen and mesh.hash == expected
        q = rng.random((400_000, 2)); refused = []
        def shrink(phase, fraction):
            try: q.resize((10, 2))
            except ValueError: refused.append(phase)
        slow(q, progress=shrink)
        assert refused and len(q) == 400_000
        print("done")
    """)


def test_cycles_are_collected_and_nothing_is_left_at_exit() -> None:
    run("""
        import builtins
        class Mine(cadt.Delaunay): pass
        mesh = Mine(rng.random((100, 2))); mesh.find_simplex([[0.5, 0.5]]); mesh.me = mesh
        gone = weakref.ref(mesh); del mesh; gc.collect(); assert gone() is None
        def progress(phase, fraction): pass
        progress.mesh = cadt.Delaunay(rng.random((1000, 2)), progress=progress)
        gone = weakref.ref(progress.mesh); del progress; gc.collect(); assert gone() is None
        builtins.kept = cadt.Delaunay(rng.random((100, 2))); builtins.rows = kept.vertex_neighbors
        kept.find_simplex([[0.5, 0.5]])
        print("done")
    """)


def test_import_is_quick() -> None:
    """60 ms at most, which NumPy alone would exceed: it is imported by the first call."""
    run("""
        import subprocess
        # Of the processor, as other tests may have it meanwhile.
        code = ("import time; b = time.process_time(); import cadt; e = time.process_time(); import sys; "
                "assert 'numpy' not in sys.modules and 'cadt._cadt' not in sys.modules; print(e - b)")
        best = min(float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True).stdout) for _ in range(5))
        assert best < 0.06, best
        print("done")
    """)
