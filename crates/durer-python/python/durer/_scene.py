"""Scenes: what rays are asked about."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, final, overload

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Bools, Floats, Ints, Progress, Vector, rays, table, thread_count, vector
from ._camera import Camera
from ._objects import Object
from ._native import Scene as NativeScene
from ._results import AllHits, Hits, ObjectSpans, Spans

Watch = bool | Callable[[int, int], object]


@final
class Light:
    """A point that shines.

    Examples
    --------
    >>> import durer
    >>> durer.Light((0, 10, 0))
    Light((0.0, 10.0, 0.0), (1.0, 1.0, 1.0))
    """

    __slots__ = ("location", "colour")
    location: Vector
    colour: Vector

    def __init__(self, location: npt.ArrayLike, colour: npt.ArrayLike = (1.0, 1.0, 1.0)) -> None:
        object.__setattr__(self, "location", vector(location, "location"))
        object.__setattr__(self, "colour", vector(colour, "colour"))

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("Light objects cannot be changed")

    def __reduce__(self) -> tuple[Any, ...]:
        return (Light, (self.location, self.colour))

    def __repr__(self) -> str:
        return f"Light({self.location!r}, {self.colour!r})"


@final
class Scene:
    """Objects, built for queries; immutable, and safe to use from several threads at once.

    Parameters
    ----------
    objects : iterable of Object
        Object i of a hit is the i-th of them.
    camera : Camera, optional
        Who looks; pictures need it, rays do not.
    lights : iterable of Light
        What shines. Pictures of scenes without lights have one at the camera.
    background : three numbers
        What is seen where nothing is.
    max_trace_level : int
        How deep rays may follow each other in pictures.

    Raises
    ------
    ValueError
        If an object cannot exist; the text says why.

    Examples
    --------
    >>> import durer, numpy as np
    >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1), durer.Plane((0, 0, 1), -1)])
    >>> scene
    <Scene of 2 objects>
    >>> scene.closest(np.array([[0.0, 0.0, 5.0, 0.0, 0.0, -1.0]])).t
    array([4.])
    >>> scene.contains([[0, 0, 0.5], [0, 0, 3]])
    array([ True, False])
    """

    __slots__ = ("_native", "_recipe", "__weakref__")
    _native: NativeScene
    _recipe: tuple[Any, ...]

    def __init__(
        self,
        objects: Iterable[Object] = (),
        *,
        camera: Camera | None = None,
        lights: Iterable[Light] = (),
        background: npt.ArrayLike = (0.0, 0.0, 0.0),
        max_trace_level: int = 5,
    ) -> None:
        if isinstance(objects, Object):
            objects = (objects,)
        parts, lamps, behind = tuple(objects), tuple(lights), vector(background, "background")
        for part in parts:
            if not isinstance(part, Object):
                raise TypeError(f"objects: a surface or a solid is needed, got {type(part).__name__}")
        native = _native.scene(
            [part._native for part in parts],
            None if camera is None else camera._native,
            [(lamp.location, lamp.colour) for lamp in lamps],
            behind,
            int(max_trace_level),
        )
        self._set(native, ("objects", parts, camera, lamps, behind, int(max_trace_level)))

    def _set(self, native: NativeScene, recipe: tuple[Any, ...]) -> None:
        object.__setattr__(self, "_native", native)
        object.__setattr__(self, "_recipe", recipe)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("Scene objects cannot be changed")

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuilt, self._recipe)

    def __copy__(self) -> Scene:
        return self

    def __deepcopy__(self, memo: object) -> Scene:
        return self

    def __repr__(self) -> str:
        count = self._native.object_count
        source = f" from {self._recipe[1]!r}" if self._recipe[0] == "file" else ""
        return f"<Scene of {count} object{'' if count == 1 else 's'}{source}>"

    # -- what it is

    @property
    def object_count(self) -> int:
        """How many objects there are."""
        return self._native.object_count

    @property
    def primitive_count(self) -> int:
        """How many primitives rays can meet: each face of a mesh, each surface of a solid, once for each placement."""
        return self._native.primitive_count

    @property
    def bounds(self) -> Floats:
        """The least and the greatest corner of a box around everything, (2, 3); infinite if something has no end."""
        return self._native.bounds

    @property
    def memory(self) -> int:
        """Bytes of surfaces and trees."""
        return self._native.byte_count

    @property
    def warnings(self) -> list[str]:
        """What a reader of the scene should know: it is used all the same."""
        return self._native.warnings

    @property
    def camera(self) -> Camera | None:
        """The scene's camera, in the size it was made or loaded for."""
        if self._recipe[0] == "objects":
            camera: Camera | None = self._recipe[2]
            return camera
        native = self._native.camera
        if native is None:
            return None
        width, height = self._recipe[2][:2]
        return Camera.from_vectors(
            native.location,
            native.direction,
            native.right,
            native.up,
            width,
            height,
            native.is_orthographic,
        )

    # -- queries

    def closest(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike | None = None,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int | None = None,
        progress: Watch = False,
    ) -> Hits:
        """The first hit of each ray.

        Parameters
        ----------
        origins, directions : arrays (n, 3), or one array (n, 6)
            float64; other real types and layouts are converted. (n, 8) has t_min and t_max in its last columns.
            Directions have any length but zero. Rays that are not finite miss, and are counted in ``invalid``.
        t_min, t_max : float or array (n,), optional
            The closed range of t, in units of the direction; from 0 to infinity by default.
        threads : int, optional
            How many threads work; by default one for each processor. Answers do not depend on it.
        progress : bool or callable
            True for a bar (if tqdm is installed), or a function of the number of finished rays and of all.

        Returns
        -------
        Hits

        Raises
        ------
        ValueError
            If an array has the wrong shape or dtype; the text says which.

        Examples
        --------
        >>> import durer
        >>> scene = durer.Scene([durer.Box((-1, -1, -1), (1, 1, 1))])
        >>> hits = scene.closest([[0, 0, 5]], [[0, 0, -1]])
        >>> float(hits.t[0]), bool(hits.t_lo[0] <= 4.0 <= hits.t_hi[0]), hits.normal.tolist()
        (4.0, True, [[0.0, 0.0, 1.0]])
        """
        native, count = self._query(_native.closest, origins, directions, t_min, t_max, threads, progress)
        return Hits(native, count)

    def any(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike | None = None,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int | None = None,
        progress: Watch = False,
    ) -> Bools:
        """Whether each ray hits anything: bool, (n,). Arguments are those of `closest`.

        Examples
        --------
        >>> import durer
        >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1)])
        >>> scene.any([[0, 0, -5], [0, 0, -5]], [[0, 0, 1], [0, 0, 1]], t_max=[3.0, 5.0])
        array([False,  True])
        """
        (hit, _), _ = self._query(_native.any, origins, directions, t_min, t_max, threads, progress)
        return hit  # type: ignore[no-any-return]

    def all(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike | None = None,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int | None = None,
        progress: Watch = False,
    ) -> AllHits:
        """Every hit of each ray, once, ascending. Arguments are those of `closest`.

        Examples
        --------
        >>> import durer
        >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1), durer.Sphere((0, 0, 0), 2)])
        >>> hits = scene.all([[0, 0, 5], [9, 9, 9]], [[0, 0, -1], [0, 0, -1]])
        >>> hits.t, hits.object, hits.counts
        (array([3., 4., 6., 7.]), array([1, 0, 0, 1]), array([4, 0]))
        """
        native, count = self._query(_native.all, origins, directions, t_min, t_max, threads, progress)
        return AllHits(native, count)

    @overload
    def spans(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike | None = None,
        *,
        by: None = None,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int | None = None,
        progress: Watch = False,
    ) -> Spans: ...
    @overload
    def spans(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike | None = None,
        *,
        by: Literal["object"],
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int | None = None,
        progress: Watch = False,
    ) -> ObjectSpans: ...
    def spans(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike | None = None,
        *,
        by: Literal["object"] | None = None,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int | None = None,
        progress: Watch = False,
    ) -> Spans:
        """Where each ray is inside solids; open surfaces do not count. Other arguments are those of `closest`.

        Parameters
        ----------
        by : "object", optional
            By default the answer is about the union of all solids. By object, each has its own spans, also where objects
            overlap: which solid a ray is in, from where to where.

        Returns
        -------
        Spans, or ObjectSpans by object

        Examples
        --------
        >>> import durer
        >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1), durer.Sphere((1, 0, 0), 1)])
        >>> scene.spans([[-5, 0, 0]], [[1, 0, 0]]).lengths, scene.spans([[-5, 0, 0]], [[1, 0, 0]], by="object").lengths
        (array([3.]), array([2., 2.]))
        """
        if by not in (None, "object"):
            raise ValueError(f"by: None or 'object' is needed, got {by!r}")
        kind = Spans if by is None else ObjectSpans

        def ask(native: Any, start: Any, along: Any, ranges: Any, count: int, watch: Any) -> Any:
            return _native.spans(native, start, along, ranges, by is not None, count, watch)

        native, _ = self._query(ask, origins, directions, t_min, t_max, threads, progress)
        return kind({name: getattr(native, name)() for name in kind._names}, native.invalid)

    def contains(
        self, points: npt.ArrayLike, *, threads: int | None = None, progress: Watch = False
    ) -> Bools:
        """Whether each point (n, 3) lies inside or on a solid, exactly: bool, (n,). Points that are not finite do not.

        Examples
        --------
        >>> import durer
        >>> durer.Scene([durer.Box((0, 0, 0), (1, 1, 1))]).contains([[0.5, 0.5, 0.5], [1, 1, 1], [1, 1, 1.0000000000000002]])
        array([ True,  True, False])
        """
        rows = table(points, 3, "points")
        with Progress(progress, len(rows)) as watch:
            return _native.contains(self._native, rows, thread_count(threads), watch.call)

    def _query(
        self,
        query: Callable[..., Any],
        origins: npt.ArrayLike,
        directions: npt.ArrayLike | None,
        t_min: npt.ArrayLike | None,
        t_max: npt.ArrayLike | None,
        threads: int | None,
        progress: Watch,
    ) -> tuple[Any, int]:
        start, along, ranges = rays(origins, directions, t_min, t_max)
        count = thread_count(threads)
        with Progress(progress, len(start)) as watch:
            return query(self._native, start, along, ranges, count, watch.call), count

    def _closest_ids(
        self, origins: Floats, directions: Floats, threads: int | None = None
    ) -> tuple[Ints, Ints, bool]:
        """Object and primitive of each ray's first hit, -1 for none, and whether any is a touch: less work than `closest`."""
        start, along, ranges = rays(origins, directions)
        return _native.closest_ids(self._native, start, along, ranges, thread_count(threads), None)

    def _parts(self) -> list[Scene]:
        """A scene for each object, with that alone."""
        if self._recipe[0] != "objects":
            raise ValueError("objects one by one are known of scenes that were made of objects, not of loaded ones")
        return [Scene([part]) for part in self._recipe[1]]

    def _repr_png_(self) -> bytes | None:
        """A small picture for notebooks."""
        from ._render import render

        camera = self.camera or self.view(width=400, height=300)
        if camera is None:
            return None
        high = max(1, round(400 * camera.height / camera.width))
        return render(self, camera.sized(400, high))._repr_png_()

    def view(
        self,
        direction: npt.ArrayLike = (-0.45, -0.35, -1.0),
        up: npt.ArrayLike = (0.0, 1.0, 0.0),
        width: int = 640,
        height: int = 480,
    ) -> Camera | None:
        """A camera that frames everything, looking along a direction; None if something has no end or nothing is there.

        Examples
        --------
        >>> import durer
        >>> camera = durer.Scene([durer.Box((0, 0, 0), (1, 1, 1))]).view(width=40, height=30)
        >>> camera.width, camera.height, durer.Scene([durer.Plane((0, 0, 1))]).view()
        (40, 30, None)
        """
        bounds = self.bounds
        if not np.isfinite(bounds).all() or (bounds[0] > bounds[1]).any():
            return None
        centre = bounds.mean(axis=0)
        radius = float(np.linalg.norm(bounds[1] - bounds[0])) / 2 or 1.0
        along = np.asarray(vector(direction, "direction"))
        along = along / np.linalg.norm(along)
        slope = 0.364
        angle = 2 * np.arctan(slope * max(1.0, width / height))
        distance = radius / np.sin(np.arctan(slope))
        return Camera(centre - along * distance, centre, up, float(angle), width, height)


def _digest(files: Iterable[str | os.PathLike[str]]) -> str:
    """A hash of the contents of files."""
    digest = hashlib.sha256()
    for file in files:
        with open(file, "rb") as content:
            digest.update(hashlib.sha256(content.read()).digest())
    return digest.hexdigest()


def _rebuilt(kind: str, *recipe: Any) -> Scene:
    if kind == "file":
        path, (width, height, library, declares, clock, limits), digest = recipe
        scene = load(
            path,
            width=width,
            height=height,
            library_paths=library,
            declares=dict(declares),
            clock=clock,
            limits=dict(limits),
        )
        if scene._recipe[3] != digest:
            raise ValueError(f"the scene {path!r} is another one than the one that was pickled: a file has changed")
        return scene
    parts, camera, lamps, behind, level = recipe
    return Scene(parts, camera=camera, lights=lamps, background=behind, max_trace_level=level)


def load(
    path: str | os.PathLike[str],
    *,
    width: int = 800,
    height: int = 600,
    library_paths: Sequence[str | os.PathLike[str]] = (),
    declares: Mapping[str, float] | None = None,
    clock: float = 0.0,
    limits: Mapping[str, int] | None = None,
) -> Scene:
    """The scene in a file: POV-Ray's language (.pov), or a mesh (.obj .ply .stl .gltf .glb) with a camera and a light.

    Parameters
    ----------
    path : path
        The file. A pickled scene names its file and knows a hash of all texts that it was read from: where it is unpickled
        they must be at the same paths, and unchanged.
    width, height : int
        The size of its picture: of the camera, and `image_width` and `image_height` in the language.
    library_paths : paths
        Folders that are searched for include files.
    declares : mapping
        Names declared as numbers before the scene begins.
    clock : float
        The value of `clock`.
    limits : mapping
        Where reading stops, by the names of the command's ``--limit``.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it cannot be read; the text says where, with the line.

    Examples
    --------
    >>> import durer, pathlib
    >>> file = pathlib.Path(getfixture("tmp_path")) / "ball.pov"
    >>> _ = file.write_text("camera { location -5*z } sphere { 0, 1 pigment { rgb 1 } } light_source { -9*z, 1 }")
    >>> scene = durer.load(file)
    >>> scene.closest([[0, 0, -5]], [[0, 0, 1]]).t
    array([4.])
    """
    name = os.fspath(path)
    if not os.path.exists(name):
        raise FileNotFoundError(f"there is no file {name!r}")
    name = os.path.abspath(name)
    ending = os.path.splitext(name)[1].lower()
    if ending not in (".pov", ".obj", ".ply", ".stl", ".gltf", ".glb"):
        raise ValueError(f"the scene must be a .pov, .obj, .ply, .stl, .gltf or .glb file, got {name!r}")
    options = (
        int(width),
        int(height),
        [os.fspath(folder) for folder in library_paths],
        list((declares or {}).items()),
        float(clock),
        list((limits or {}).items()),
    )
    scene = Scene.__new__(Scene)
    native = _native.load(name, *options)
    scene._set(native, ("file", name, options, _digest(native.files)))
    return scene
