"""Queries and pictures over many processes or machines: the functions of `Scene` with a `client`.

A client is a `distributed.Client` of Dask, or any executor of `concurrent.futures` (a process pool, mpi4py's, Dask's own).
The scene is sent to each worker once and built there; rays go out in pieces, pictures in bands of rows, and answers are put
together in order: they are the same bits as on one machine. With Dask a worker may die: its pieces are done again by others.

Clusters come from Dask's own deployers; on SLURM, say::

    from dask_jobqueue import SLURMCluster
    cluster = SLURMCluster(cores=32, processes=1, memory="64GB", walltime="01:00:00")
    cluster.scale(jobs=20)
    hits = durer.distributed.closest(scene, rays, client=cluster.get_client())

and on Kubernetes with ``dask_kubernetes.operator.KubeCluster`` in the same way. Workers need durer installed; a scene that was
loaded from a file needs the file at the same path.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, wait
from typing import Any, Literal, overload

import numpy as np
import numpy.typing as npt

from . import _render
from ._arrays import Bools, rays, table
from ._camera import Camera
from ._render import Picture
from ._results import AllHits, Hits, ObjectSpans, Spans, _restored
from ._scene import Scene, Watch

__all__ = ["all", "any", "closest", "contains", "render", "spans"]

#: Rays of one task.
CHUNK = 65536
#: How often a piece is tried whose worker died.
TRIES = 10

#: Scenes that this process has built, the last few of them.
_SCENES: dict[str, Scene] = {}
_KEPT = 4


class _Missing:
    """What a worker of an executor says that does not know the scene yet."""


def _scene_of(token: str, payload: bytes) -> Scene:
    """The scene, built once in each process."""
    scene = _SCENES.get(token)
    if scene is None:
        scene = pickle.loads(payload)
        while len(_SCENES) >= _KEPT:
            _SCENES.pop(next(iter(_SCENES)))
        _SCENES[token] = scene
    return scene


def _work(scene: Scene, query: str, arguments: tuple[Any, ...], options: dict[str, Any]) -> Any:
    """One task; pure: it gives the same bits wherever and however often it runs."""
    if query == "render":
        _, top, _, bottom = options["region"]
        return np.asarray(_render.render(scene, *arguments, **options))[top:bottom]
    answer = getattr(scene, query)(*arguments, **options)
    if isinstance(answer, (Hits, AllHits, Spans)):
        return answer.to_dict(), answer.invalid
    return answer, 0


def _work_cached(token: str, payload: bytes | None, *rest: Any) -> Any:
    if payload is None and token not in _SCENES:
        return _Missing()
    return _work(_scene_of(token, payload or b""), *rest)


def _run(
    client: Any,
    scene: Scene,
    query: str,
    pieces: list[tuple[tuple[Any, ...], dict[str, Any]]],
    told: Callable[[int], None],
) -> list[Any]:
    """The answers to all pieces, in order."""
    payload = pickle.dumps(scene, protocol=pickle.HIGHEST_PROTOCOL)
    token = "durer-" + hashlib.sha256(payload).hexdigest()[:32]
    answers: list[Any] = [None] * len(pieces)
    if isinstance(client, Executor):
        source = _over_executor(client, token, payload, query, pieces)
    else:
        source = _over_dask(client, token, payload, query, pieces)
    for index, answer in source:
        answers[index] = answer
        told(index)
    return answers


def _over_executor(
    executor: Executor, token: str, payload: bytes, query: str, pieces: list[Any]
) -> Iterator[tuple[int, Any]]:
    most = 2 * int(getattr(executor, "_max_workers", 0) or 8)
    waiting = list(range(len(pieces)))[::-1]
    running: dict[Any, int] = {}
    # A worker that does not know the scene says so, and the piece comes back with it.
    while waiting or running:
        while waiting and len(running) < most:
            index = waiting.pop()
            running[executor.submit(_work_cached, token, None, query, *pieces[index])] = index
        done, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in done:
            index = running.pop(future)
            answer = future.result()
            if isinstance(answer, _Missing):
                running[executor.submit(_work_cached, token, payload, query, *pieces[index])] = index
            else:
                yield index, answer


def _over_dask(
    client: Any, token: str, payload: bytes, query: str, pieces: list[Any]
) -> Iterator[tuple[int, Any]]:
    import distributed

    # Made by a task: if all its holders die it is made again, which scattered data are not.
    scene = client.submit(_scene_of, token, payload, key=token, pure=True)
    most = 2 * max(1, sum(client.nthreads().values())) + 2
    waiting = list(range(len(pieces)))[::-1]
    tried: dict[int, int] = {}
    running: dict[Any, int] = {}
    completed: Any = getattr(distributed, "as_completed")(with_results=True, raise_errors=False)

    def submit(index: int) -> None:
        tried[index] = tried.get(index, 0) + 1
        digest = hashlib.sha256(pickle.dumps(pieces[index])).hexdigest()[:24]
        key = f"{token}-{query}-{index}-{tried[index]}-{digest}"
        future = client.submit(_work, scene, query, *pieces[index], key=key, pure=True, retries=3)
        running[future] = index
        completed.add(future)

    while waiting and len(running) < most:
        submit(waiting.pop())
    # Each answer is taken and released as it comes, so that it is not lost with its worker.
    for future, answer in completed:
        index = running.pop(future)
        status = future.status
        if status == "finished":
            future.release()
            if waiting:
                submit(waiting.pop())
            yield index, answer
        elif status in ("lost", "cancelled") or _was_killed(future):
            if tried[index] >= TRIES:
                raise RuntimeError(f"{query}: workers died {TRIES} times under one piece")
            future.release()
            if scene.status in ("lost", "cancelled", "error"):
                scene = client.submit(_scene_of, token, payload, key=f"{token}-{tried[index]}", pure=True)
            submit(index)
        else:
            future.result()
            raise RuntimeError(f"{query}: a piece ended as '{status}'")


def _was_killed(future: Any) -> bool:
    from distributed.scheduler import KilledWorker

    try:
        return future.status == "error" and isinstance(future.exception(), KilledWorker)
    except Exception:
        return False


class _Told:
    """Adds up finished rows for a bar or a callable."""

    def __init__(self, wanted: Watch, sizes: list[int], unit: str) -> None:
        self.sizes, self.done, self.total = sizes, 0, sum(sizes)
        self.bar: Any = None
        self.wanted = wanted if callable(wanted) else None
        if wanted and not callable(wanted):
            try:
                from tqdm.auto import tqdm  # type: ignore[import-untyped, unused-ignore]

                self.bar = tqdm(total=self.total, unit=unit, unit_scale=True)
            except ImportError:
                pass

    def __call__(self, index: int) -> None:
        self.done += self.sizes[index]
        if self.wanted is not None:
            self.wanted(self.done, self.total)
        if self.bar is not None:
            self.bar.update(self.sizes[index])

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()


def _rays(
    client: Any,
    scene: Scene,
    query: str,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None,
    t_min: npt.ArrayLike | None,
    t_max: npt.ArrayLike | None,
    chunk: int,
    threads: int | None,
    progress: Watch,
    **options: Any,
) -> list[Any]:
    start, along, ranges = rays(origins, directions, t_min, t_max)
    columns = [start, along] if ranges is None else [start, along, ranges]
    whole = np.hstack(columns)
    return _rows(client, scene, query, whole, chunk, threads, progress, **options)


def _rows(
    client: Any,
    scene: Scene,
    query: str,
    whole: Any,
    chunk: int,
    threads: int | None,
    progress: Watch,
    **options: Any,
) -> list[Any]:
    if chunk < 1:
        raise ValueError(f"chunk: at least 1 is needed, got {chunk}")
    parts = [whole[i : i + chunk] for i in range(0, max(1, len(whole)), chunk)]
    told = _Told(progress, [len(part) for part in parts], "ray")
    try:
        return _run(client, scene, query, [((part,), {"threads": threads, **options}) for part in parts], told)
    finally:
        told.close()


def _joined(answers: list[Any], has_offsets: bool) -> tuple[dict[str, Any], int]:
    tables = [table for table, _ in answers]
    joined = {name: np.concatenate([t[name] for t in tables]) for name in tables[0] if name != "offsets"}
    if has_offsets:
        counts = np.concatenate([np.diff(t["offsets"]) for t in tables])
        joined["offsets"] = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        if "ray" in joined:
            joined["ray"] = np.repeat(np.arange(len(counts)), counts)
    return joined, sum(invalid for _, invalid in answers)


def closest(
    scene: Scene,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None = None,
    *,
    client: Any,
    t_min: npt.ArrayLike | None = None,
    t_max: npt.ArrayLike | None = None,
    chunk: int = CHUNK,
    threads: int | None = None,
    progress: Watch = False,
) -> Hits:
    """`Scene.closest` over a client's workers; `chunk` rays are one task, and each task has so many threads.

    Examples
    --------
    >>> import durer, durer.distributed, concurrent.futures
    >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1)])
    >>> with concurrent.futures.ThreadPoolExecutor(2) as pool:
    ...     durer.distributed.closest(scene, [[0, 0, 5]], [[0, 0, -1]], client=pool).t
    array([4.])
    """
    answers = _rays(client, scene, "closest", origins, directions, t_min, t_max, chunk, threads, progress)
    joined, invalid = _joined(answers, False)
    return _restored(Hits, joined, invalid, len(joined["t"]))  # type: ignore[no-any-return]


def all(
    scene: Scene,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None = None,
    *,
    client: Any,
    t_min: npt.ArrayLike | None = None,
    t_max: npt.ArrayLike | None = None,
    chunk: int = CHUNK,
    threads: int | None = None,
    progress: Watch = False,
) -> AllHits:
    """`Scene.all` over a client's workers. Arguments are those of `closest`."""
    answers = _rays(client, scene, "all", origins, directions, t_min, t_max, chunk, threads, progress)
    joined, invalid = _joined(answers, True)
    return _restored(AllHits, joined, invalid, len(joined["t"]))  # type: ignore[no-any-return]


@overload
def spans(
    scene: Scene,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None = None,
    *,
    client: Any,
    by: None = None,
    t_min: npt.ArrayLike | None = None,
    t_max: npt.ArrayLike | None = None,
    chunk: int = CHUNK,
    threads: int | None = None,
    progress: Watch = False,
) -> Spans: ...
@overload
def spans(
    scene: Scene,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None = None,
    *,
    client: Any,
    by: Literal["object"],
    t_min: npt.ArrayLike | None = None,
    t_max: npt.ArrayLike | None = None,
    chunk: int = CHUNK,
    threads: int | None = None,
    progress: Watch = False,
) -> ObjectSpans: ...
def spans(
    scene: Scene,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None = None,
    *,
    client: Any,
    by: Literal["object"] | None = None,
    t_min: npt.ArrayLike | None = None,
    t_max: npt.ArrayLike | None = None,
    chunk: int = CHUNK,
    threads: int | None = None,
    progress: Watch = False,
) -> Spans:
    """`Scene.spans` over a client's workers. Arguments are those of `closest`, and `by` as there."""
    answers = _rays(client, scene, "spans", origins, directions, t_min, t_max, chunk, threads, progress, by=by)
    kind = Spans if by is None else ObjectSpans
    return kind(*_joined(answers, True))


def any(
    scene: Scene,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None = None,
    *,
    client: Any,
    t_min: npt.ArrayLike | None = None,
    t_max: npt.ArrayLike | None = None,
    chunk: int = CHUNK,
    threads: int | None = None,
    progress: Watch = False,
) -> Bools:
    """`Scene.any` over a client's workers. Arguments are those of `closest`."""
    answers = _rays(client, scene, "any", origins, directions, t_min, t_max, chunk, threads, progress)
    return np.concatenate([answer for answer, _ in answers])


def contains(
    scene: Scene,
    points: npt.ArrayLike,
    *,
    client: Any,
    chunk: int = CHUNK,
    threads: int | None = None,
    progress: Watch = False,
) -> Bools:
    """`Scene.contains` over a client's workers."""
    answers = _rows(client, scene, "contains", table(points, 3, "points"), chunk, threads, progress)
    return np.concatenate([answer for answer, _ in answers])


def render(
    scene: Scene,
    camera: Camera | None = None,
    *,
    client: Any,
    rows: int = 32,
    anti_aliasing: str = "off",
    threshold: float = 0.3,
    depth: int = 3,
    threads: int | None = None,
    progress: Watch = False,
) -> Picture:
    """`durer.render` over a client's workers; so many rows are one task."""
    view = camera or scene.camera or scene.view()
    if view is None:
        raise ValueError("the scene has no camera, and none can frame what has no end or is not there")
    if rows < 1:
        raise ValueError(f"rows: at least 1 is needed, got {rows}")
    bands = [(top, min(top + rows, view.height)) for top in range(0, view.height, rows)]
    options = {"anti_aliasing": anti_aliasing, "threshold": threshold, "depth": depth, "threads": threads}
    pieces = [((camera,), {**options, "region": (0, a, view.width, b)}) for a, b in bands]
    told = _Told(progress, [(b - a) * view.width for a, b in bands], "pixel")
    picture = np.zeros((view.height, view.width, 3))
    try:
        for (a, b), part in zip(bands, _run(client, scene, "render", pieces, told), strict=True):
            picture[a:b] = part
    finally:
        told.close()
    return picture.view(Picture)
