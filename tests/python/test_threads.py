"""Threads of Python: the GIL, and contexts."""

import os
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import scenes
from scenes import ball, pill

import pellicle


def beats_during(function):
    """How often another thread has run during function()."""
    count, stop, started = [0], threading.Event(), threading.Event()

    def beat():
        while not stop.is_set():
            count[0] += 1
            started.set()
            time.sleep(0.001)

    thread = threading.Thread(target=beat)
    thread.start()
    started.wait()
    before = count[0]
    function()
    beats = count[0] - before
    stop.set()
    thread.join()
    return beats


def test_other_threads_run_during_long_calls():
    image = ball(56, 22)
    surface = pellicle.extract(image, 0.5, mesh="uniform")  # more vertices: longer calls
    volume = pellicle.Volume(image)
    pyramid = pellicle.Pyramid(volume, 0.5, levels=0)
    mesh = (surface.vertices, surface.faces)
    calls = {
        "extract": lambda: pellicle.extract(image, 0.5, levels=0, mesh="uniform"),
        "finish": lambda: pellicle.Run(pyramid, mesh="uniform").finish(),
        "geodesic": lambda: pellicle.geodesic(mesh, 0),
        "distance": lambda: pellicle.distance(mesh, mesh),
    }
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)  # no thread has to give the GIL away: with it held, no beats
    try:
        for name, call in calls.items():
            # On a busy machine the other thread may come too late many times.
            assert any(beats_during(call) > 0 for _ in range(200)), name
    finally:
        sys.setswitchinterval(interval)


def test_contexts_in_several_threads():
    image = pill()
    expected = pellicle.extract(image, 100).hash

    def work(threads):
        context = pellicle.Context(threads=threads)
        return [pellicle.extract(image, 100, context=context).hash for _ in range(3)]

    with ThreadPoolExecutor(4) as pool:
        for hashes in pool.map(work, [1, 2, 1, 2]):
            assert hashes == [expected] * 3


def test_one_context_in_several_threads_takes_one_after_the_other():
    image = pill()
    context = pellicle.Context()
    expected = pellicle.extract(image, 100).hash
    lengths = []

    def work(_):
        surface = pellicle.extract(image, 100, context=context, progress=lambda p: None)
        lengths.append(len(surface.vertices))
        return surface.hash

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(work, range(8))) == [expected] * 8
    assert len(set(lengths)) == 1


def test_runs_of_one_pyramid_in_several_threads():
    pyramid = pellicle.Pyramid(pellicle.Volume(pill()), 100)
    expected = pellicle.Run(pyramid).finish().hash
    with ThreadPoolExecutor(3) as pool:
        runs = pool.map(
            lambda _: pellicle.Run(pyramid, context=pellicle.Context(threads=1)).finish().hash,
            range(6),
        )
        assert list(runs) == [expected] * 6


def test_a_process_may_end_while_daemon_threads_compute():
    program = """
import sys, threading, time
sys.path.insert(0, sys.argv[1])
import pellicle, scenes
started = threading.Event()
def compute(progress):
    pellicle.extract(scenes.ball(), 0.5, levels=0, progress=progress, **scenes.endless())
for progress in (None, lambda p: started.set()):
    threading.Thread(target=compute, args=[progress], daemon=True).start()
started.wait()
time.sleep(0.1)
"""
    folder = os.path.dirname(scenes.__file__)
    command = [sys.executable, "-c", program, folder]
    # At once, so that threads are late where Python ends.
    processes = [
        subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for _ in range(6)
    ]
    for process in processes:
        errors = process.communicate(timeout=60)[1]
        assert (process.returncode, errors) == (0, "")


def test_handles_that_go_in_other_threads():
    context = pellicle.Context()
    before = context.memory.now
    stop = threading.Event()

    def churn():
        while not stop.is_set():
            for _ in range(5):
                pellicle.Volume(np.zeros((8, 8, 8), np.uint8), copy=True, context=context)

    threads = [threading.Thread(target=churn) for _ in range(2)]
    for thread in threads:
        thread.start()
    for _ in range(5):
        assert pellicle.extract(ball(), 0.5, context=context).vertex_count > 0
    stop.set()
    for thread in threads:
        thread.join()
    assert context.memory.now == before


@pytest.mark.parametrize("simd", ["scalar", "auto"])
def test_threads_and_targets_do_not_matter(simd):
    context = pellicle.Context(threads=1, simd=simd)
    assert context.threads == 1
    assert context.simd == simd or simd == "auto"
    assert pellicle.extract(pill(), 100, context=context).hash == pellicle.extract(pill(), 100).hash
