"""Many processes: the same bits as in one, also when a worker dies."""

import os
import signal
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import durer
import durer.distributed as distributed

CAMERA = durer.Camera((0, 3, 9), (0, 0, 0), width=64, height=48)
SCENE = durer.Scene(
    [durer.Torus(2, 0.5), durer.Box((-1, -1, -1), (1, 1, 1)) - durer.Sphere((0, 0, 0), 1.2)],
    camera=CAMERA,
    lights=[durer.Light((5, 9, 5))],
)


def some_rays(n):
    rng = np.random.default_rng(5)
    origins = rng.uniform(-5, 5, (n, 3))
    return np.hstack([origins, rng.uniform(-1, 1, (n, 3)) - origins])


def same(a, b):
    assert type(a) is type(b) and len(a) == len(b) and a.invalid == b.invalid
    for name in b:
        assert a[name].dtype == b[name].dtype and np.array_equal(a[name], b[name], equal_nan=True), name


@pytest.mark.parametrize("pool", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_executors_give_the_same_bits(pool):
    rays = some_rays(5000)
    rays[17] = np.nan
    with pool(2) as client:
        for query in ("closest", "all", "spans"):
            same(getattr(distributed, query)(SCENE, rays, client=client, chunk=700), getattr(SCENE, query)(rays))
        same(distributed.spans(SCENE, rays, client=client, by="object", chunk=700), SCENE.spans(rays, by="object"))
        assert np.array_equal(distributed.any(SCENE, rays, client=client, chunk=700), SCENE.any(rays))
        points = rays[:, 3:] + rays[:, :3]
        found = distributed.contains(SCENE, points, client=client, chunk=999)
        assert np.array_equal(found, SCENE.contains(points))
        ranged = distributed.any(SCENE, rays, client=client, t_min=0.1, t_max=np.linspace(0, 1, 5000), chunk=700)
        assert np.array_equal(ranged, SCENE.any(rays, t_min=0.1, t_max=np.linspace(0, 1, 5000)))
        told = []
        picture = distributed.render(SCENE, client=client, rows=7, progress=lambda done, total: told.append((done, total)))
        assert np.array_equal(picture, durer.render(SCENE)) and told[-1] == (64 * 48, 64 * 48)
        assert len(distributed.closest(SCENE, [], client=client)) == 0


def test_errors_of_a_piece_are_raised():
    with ThreadPoolExecutor(1) as client:
        with pytest.raises(ValueError, match=r"\(2, 5\)"):
            distributed.closest(SCENE, np.zeros((2, 5)), client=client)
        with pytest.raises(ValueError, match="anti_aliasing"):
            distributed.render(SCENE, client=client, anti_aliasing="much")


def test_a_killed_worker_changes_nothing(tmp_path):
    dask = pytest.importorskip("distributed")
    rays = some_rays(60_000)
    settings = {"processes": True, "threads_per_worker": 1, "dashboard_address": None, "local_directory": str(tmp_path)}
    with dask.LocalCluster(n_workers=2, **settings) as cluster, dask.Client(cluster) as client:
        before = set(client.run(os.getpid).values())
        killed = []

        def kill_half_way(done, total):
            if done >= total // 2 and not killed:
                killed.append(min(before))
                os.kill(killed[0], signal.SIGKILL)

        hits = distributed.all(SCENE, rays, client=client, chunk=1000, threads=1, progress=kill_half_way)
        assert killed
        same(hits, SCENE.all(rays))
        client.wait_for_workers(2, timeout=60)
        killed.clear()
        before = set(client.run(os.getpid).values())
        picture = distributed.render(SCENE, client=client, rows=2, threads=1, progress=kill_half_way)
        assert killed and np.array_equal(picture, durer.render(SCENE))
        same(distributed.closest(SCENE, rays[:3000], client=client, chunk=500), SCENE.closest(rays[:3000]))
