"""What queries answer with: arrays by name, each computed when it is first asked for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, final

import numpy as np
import numpy.typing as npt

from . import _native as native
from ._arrays import Bools, Floats, Ints

#: `kind` of a hit: a plain crossing, a touch, crossings that cannot be told apart; and of a ray that misses.
SIMPLE, GRAZING, CLUSTER, MISS = 0, 1, 2, 255


class _Columns:
    """Arrays of equal length by name."""

    __slots__ = ()
    _names: tuple[str, ...] = ()

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def keys(self) -> tuple[str, ...]:
        """The names of the arrays."""
        return self._names

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        if name not in self._names:
            raise KeyError(name)
        array: npt.NDArray[Any] = getattr(self, name)
        return array

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} cannot be changed")

    def _columns(self) -> dict[str, npt.NDArray[Any]]:
        """The arrays with one row for each answer."""
        return {name: self[name] for name in self._names if name != "offsets"}

    def to_dict(self) -> dict[str, npt.NDArray[Any]]:
        """All arrays by name."""
        return {name: self[name] for name in self._names}

    def to_structured(self) -> npt.NDArray[np.void]:
        """A structured array with one row for each answer (`offsets` is left out)."""
        columns = self._columns()
        rows = len(next(iter(columns.values())))
        kinds = [(name, array.dtype, array.shape[1:]) for name, array in columns.items()]
        result = np.empty(rows, dtype=kinds)
        for name, array in columns.items():
            result[name] = array
        return result

    def to_dataframe(self) -> Any:
        """A pandas DataFrame with one row for each answer; vectors become columns such as `position_x`."""
        import pandas  # type: ignore[import-untyped, unused-ignore]

        flat: dict[str, npt.NDArray[Any]] = {}
        for name, array in self._columns().items():
            if array.ndim == 1:
                flat[name] = array
            else:
                ends = "xyz" if array.shape[1] == 3 else "uv"
                flat.update({f"{name}_{end}": array[:, i] for i, end in enumerate(ends)})
        return pandas.DataFrame(flat)


class _HitColumns(_Columns):
    __slots__ = ("_native", "_cache", "_threads")
    _native: native.Hits
    _cache: dict[str, npt.NDArray[Any]]
    _threads: int

    def __init__(self, hits: native.Hits, threads: int = 0) -> None:
        object.__setattr__(self, "_native", hits)
        object.__setattr__(self, "_cache", {})
        object.__setattr__(self, "_threads", threads)

    def _column(self, name: str) -> Any:
        array = self._cache.get(name)
        if array is None:
            array = getattr(self._native, name)()
            self._cache[name] = array
        return array

    def _point(self, name: str) -> Any:
        if name not in self._cache:
            names = ("position", "position_error", "normal", "shading_normal", "uv")
            self._cache.update(zip(names, self._native.points(self._threads), strict=True))
        return self._cache[name]

    @property
    def t(self) -> Floats:
        """The parameter of each hit, in units of the ray's direction; inf on a miss. float64, (n,)."""
        return self._column("t")  # type: ignore[no-any-return]

    @property
    def t_lo(self) -> Floats:
        """The exact parameter is not below this. float64, (n,)."""
        return self._column("t_lo")  # type: ignore[no-any-return]

    @property
    def t_hi(self) -> Floats:
        """The exact parameter is not above this. float64, (n,)."""
        return self._column("t_hi")  # type: ignore[no-any-return]

    @property
    def object(self) -> Ints:
        """The number of the object in the scene; -1 on a miss. int64, (n,)."""
        return self._column("object")  # type: ignore[no-any-return]

    @property
    def primitive(self) -> Ints:
        """The number of the primitive within the object: of a mesh, the face; -1 on a miss. int64, (n,)."""
        return self._column("primitive")  # type: ignore[no-any-return]

    @property
    def kind(self) -> npt.NDArray[np.uint8]:
        """0 for a plain crossing, 1 for a touch, 2 for crossings that cannot be told apart; 255 on a miss. uint8, (n,)."""
        return self._column("kind")  # type: ignore[no-any-return]

    @property
    def sign(self) -> npt.NDArray[np.int8]:
        """-1 entering, 1 leaving, 0 touching or a miss; of open surfaces, against and along the stored normal. int8, (n,)."""
        return self._column("sign")  # type: ignore[no-any-return]

    @property
    def parameters(self) -> Floats:
        """The surface's own parameters: of a triangle its barycentric b1 and b2. NaN on a miss. float64, (n, 2)."""
        return self._column("parameters")  # type: ignore[no-any-return]

    @property
    def position(self) -> Floats:
        """The points; NaN on a miss. float64, (n, 3)."""
        if "position" not in self._cache:
            self._cache["position"] = self._native.positions(self._threads)
        return self._cache["position"]

    @property
    def position_error(self) -> Floats:
        """How far the exact points are away at most, along each axis; NaN on a miss. float64, (n, 3)."""
        return self._point("position_error")  # type: ignore[no-any-return]

    @property
    def normal(self) -> Floats:
        """Unit normals, out of solids (of triangles: cross(v1 - v0, v2 - v0)); NaN on a miss. float64, (n, 3)."""
        return self._point("normal")  # type: ignore[no-any-return]

    @property
    def shading_normal(self) -> Floats:
        """Unit normals for shading, interpolated where a mesh has some; NaN on a miss. float64, (n, 3)."""
        return self._point("shading_normal")  # type: ignore[no-any-return]

    @property
    def uv(self) -> Floats:
        """Texture coordinates; NaN on a miss. float64, (n, 2)."""
        return self._point("uv")  # type: ignore[no-any-return]

    @property
    def invalid(self) -> int:
        """How many rays were not finite, had no direction or an empty range: they miss."""
        return self._native.invalid

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), self.to_dict(), self.invalid, len(self)))

    def __len__(self) -> int:
        return self._native.count


class _Arrays:
    """Stands in for the native answers in a copy that came through pickle."""

    def __init__(self, arrays: dict[str, npt.NDArray[Any]], invalid: int, count: int) -> None:
        self.invalid, self.count = invalid, count
        offsets = arrays.get("offsets")
        self.ray_count = count if offsets is None else len(offsets) - 1


def _restored(kind: Any, arrays: dict[str, npt.NDArray[Any]], invalid: int, count: int) -> Any:
    result = kind(_Arrays(arrays, invalid, count))
    result._cache.update(arrays)
    return result


_POINTS = ("t", "t_lo", "t_hi", "object", "primitive", "kind", "sign", "parameters")
_RESOLVED = ("position", "position_error", "normal", "shading_normal", "uv")


@final
class Hits(_HitColumns):
    """The first hit of each ray: arrays of n rows for n rays. A ray that misses has t inf, object and primitive -1, kind 255, and NaN.

    Examples
    --------
    >>> import durer
    >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1)])
    >>> hits = scene.closest([[0, 0, -5], [0, 9, -5]], [[0, 0, 2], [0, 0, 2]])
    >>> hits.t
    array([ 2., inf])
    >>> hits.hit
    array([ True, False])
    >>> hits.position[0]
    array([ 0.,  0., -1.])
    >>> sorted(hits.to_dict())[:3]
    ['kind', 'normal', 'object']
    """

    __slots__ = ()
    _names = (*_POINTS, *_RESOLVED)

    @property
    def hit(self) -> Bools:
        """Whether each ray hits anything. bool, (n,)."""
        return np.isfinite(self.t)

    def __repr__(self) -> str:
        return f"<Hits of {len(self)} rays: {int(self.hit.sum())} hit>"


@final
class AllHits(_HitColumns):
    """All hits of each ray, ascending: those of ray i are the rows ``offsets[i]:offsets[i + 1]``.

    Examples
    --------
    >>> import durer
    >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1)])
    >>> hits = scene.all([[0, 0, -5], [0, 9, -5]], [[0, 0, 2], [0, 0, 2]])
    >>> hits.t, hits.offsets, hits.sign
    (array([2., 3.]), array([0, 2, 2]), array([-1,  1], dtype=int8))
    """

    __slots__ = ()
    _names = ("offsets", "ray", *_POINTS, *_RESOLVED)

    @property
    def offsets(self) -> Ints:
        """Where each ray's hits begin and end. int64, (rays + 1,)."""
        return self._column("offsets")  # type: ignore[no-any-return]

    @property
    def ray(self) -> Ints:
        """The number of each hit's ray. int64, (n,)."""
        return self._cache["ray"] if "ray" in self._cache else self._column("ray_index")

    @property
    def counts(self) -> Ints:
        """How many hits each ray has. int64, (rays,)."""
        return np.diff(self.offsets)

    def crossings(self) -> Ints:
        """How many times each ray passes from one side of a surface to the other: touches do not count. int64, (rays,)."""
        before = np.concatenate([[0], np.cumsum(self.sign != 0)]).astype(np.int64)
        return np.diff(before[self.offsets])

    def __repr__(self) -> str:
        return f"<AllHits of {self._native.ray_count} rays: {len(self)} hits>"


class Spans(_Columns):
    """Where rays are inside solids: those of ray i are the rows ``offsets[i]:offsets[i + 1]``, ascending and apart.

    ``object_in`` is -1 where the ray's range begins inside, ``object_out`` where it ends inside.

    Examples
    --------
    >>> import durer
    >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 1), durer.Sphere((0, 0, 1), 1)])
    >>> spans = scene.spans([[0, 0, -5]], [[0, 0, 1]])
    >>> spans.t_in, spans.t_out, spans.object_in, spans.object_out
    (array([4.]), array([7.]), array([0]), array([1]))
    """

    __slots__ = ("_cache", "_invalid")
    _names: tuple[str, ...] = ("offsets", "t_in", "t_out", "object_in", "object_out")
    _cache: dict[str, npt.NDArray[Any]]
    _invalid: int

    def __init__(self, arrays: dict[str, npt.NDArray[Any]], invalid: int = 0) -> None:
        object.__setattr__(self, "_cache", arrays)
        object.__setattr__(self, "_invalid", invalid)

    @property
    def offsets(self) -> Ints:
        """Where each ray's spans begin and end. int64, (rays + 1,)."""
        return self._cache["offsets"]

    @property
    def t_in(self) -> Floats:
        """Where each span begins. float64, (n,)."""
        return self._cache["t_in"]

    @property
    def t_out(self) -> Floats:
        """Where each span ends. float64, (n,)."""
        return self._cache["t_out"]

    @property
    def object_in(self) -> Ints:
        """The object that is entered; -1 where the range begins inside. int64, (n,)."""
        return self._cache["object_in"]

    @property
    def object_out(self) -> Ints:
        """The object that is left; -1 where the range ends inside. int64, (n,)."""
        return self._cache["object_out"]

    @property
    def ray(self) -> Ints:
        """The number of each span's ray. int64, (n,)."""
        return np.repeat(np.arange(len(self.offsets) - 1), np.diff(self.offsets))

    @property
    def lengths(self) -> Floats:
        """The length of each span in units of the ray's direction. float64, (n,)."""
        return self.t_out - self.t_in

    @property
    def invalid(self) -> int:
        """How many rays were not finite, had no direction or an empty range: they miss."""
        return self._invalid

    def totals(self) -> Floats:
        """The length inside solids along each ray, in units of its direction. float64, (rays,)."""
        totals = np.zeros(len(self.offsets) - 1)
        np.add.at(totals, self.ray, self.lengths)
        return totals

    def __len__(self) -> int:
        return len(self.t_in)

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.to_dict(), self._invalid))

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {len(self.offsets) - 1} rays: {len(self)} spans>"


@final
class ObjectSpans(Spans):
    """Where rays are inside each object: `Spans` whose rows each belong to one `object`, ascending by t_in, then by object.

    Where objects overlap, each has its own row.

    Examples
    --------
    >>> import durer
    >>> scene = durer.Scene([durer.Sphere((0, 0, 0), 2), durer.Sphere((0, 0, 0), 1)])
    >>> spans = scene.spans([[0, 0, -5]], [[0, 0, 1]], by="object")
    >>> spans.object, spans.t_in, spans.t_out
    (array([0, 1]), array([3., 4.]), array([7., 6.]))
    >>> spans.of(1).lengths
    array([2.])
    """

    __slots__ = ()
    _names = ("offsets", "object", "t_in", "t_out", "object_in", "object_out")

    @property
    def object(self) -> Ints:
        """The object that the ray is in. int64, (n,)."""
        return self._cache["object"]

    def of(self, number: int) -> Spans:
        """The spans inside the object with this number."""
        own = self.object == number
        arrays = {name: self._cache[name][own] for name in Spans._names if name != "offsets"}
        before = np.concatenate([[0], np.cumsum(own)]).astype(np.int64)
        return Spans({"offsets": before[self.offsets], **arrays}, self._invalid)
