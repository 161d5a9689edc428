"""Python without its global lock: loading the package does not bring it back, and threads share scenes and answers."""

import sys
import sysconfig
import threading

import numpy as np
import pytest

import durer


@pytest.mark.skipif(not sysconfig.get_config_var("Py_GIL_DISABLED"), reason="this Python has its global lock")
def test_the_global_lock_stays_off():
    assert not sys._is_gil_enabled()


def in_threads(work, count=4):
    """What `work` returns in several threads that start together."""
    start, found, failed = threading.Barrier(count), [], []

    def run():
        start.wait()
        try:
            found.append(work())
        except Exception as error:
            failed.append(error)

    threads = [threading.Thread(target=run) for _ in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed, failed
    return found


def test_threads_share_scenes_and_lazy_answers():
    rng = np.random.default_rng(2)
    origins = rng.uniform(-4, 4, (3000, 3))
    corners = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]]
    mesh = durer.Mesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    # Rays at vertices: the first of them finds out which faces meet there, for all threads.
    rays = np.hstack([origins, np.asarray(corners)[rng.integers(4, size=3000)] - origins])
    expected = durer.Scene([mesh]).all(rays)
    scene = durer.Scene([mesh])
    answers = in_threads(lambda: scene.all(rays))
    for answer in answers:
        for name in expected:
            assert np.array_equal(answer[name], expected[name], equal_nan=True), name
    # One answer whose columns are computed when they are first asked for, by several threads at once.
    shared = scene.closest(rays)
    columns = in_threads(lambda: (shared.t, shared.position, shared.normal, shared.object))
    for others in columns[1:]:
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(columns[0], others))


def test_objects_and_scenes_are_made_in_several_threads():
    def work():
        lens = durer.Sphere((0, 0, -3), 4) & durer.Sphere((0, 0, 3), 4)
        scene = durer.Scene([lens, durer.formula("x*x + y*y - 1", ball=((9, 0, 0), 2))])
        return scene.closest([[0, 0, 9]], [[0, 0, -1]]).t.tolist()

    assert in_threads(work) == [[8.0]] * 4
