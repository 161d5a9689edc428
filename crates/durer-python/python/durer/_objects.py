"""Surfaces and solids: frozen values that are moved, combined and given a look by making new ones.

Lengths are in the units of the scene, angles in radians, points and vectors are three numbers (x, y, z).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, final

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import Object as NativeObject
from ._arrays import Floats, Vector, matrix, number, real_array, vector


class Object:
    """A surface or a solid with its placement and its look. It cannot be changed: methods return new objects.

    ``a | b`` is the solid of what is in either, ``a & b`` of what is in both, ``a - b`` of what is in a and not in b, and
    ``~a`` exchanges inside and outside.

    Examples
    --------
    >>> import durer
    >>> lens = durer.Sphere((0, 0, -3), 4) & durer.Sphere((0, 0, 3), 4)
    >>> lens
    Intersection(Sphere((0.0, 0.0, -3.0), 4.0), Sphere((0.0, 0.0, 3.0), 4.0))
    >>> durer.Torus(2, 0.5).translated((0, 0, 1))
    Torus(2.0, 0.5).placed([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
    """

    __slots__ = ("_native", "_arguments")
    _native: NativeObject
    _arguments: tuple[Any, ...]

    def _set(self, native: NativeObject, arguments: tuple[Any, ...]) -> None:
        object.__setattr__(self, "_native", native)
        object.__setattr__(self, "_arguments", arguments)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} objects cannot be changed")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__} objects cannot be changed")

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), self._arguments)

    def __copy__(self) -> Object:
        return self

    def __deepcopy__(self, memo: object) -> Object:
        return self

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self._arguments))})"

    # -- placement

    def placed(self, matrix: npt.ArrayLike) -> Placed:
        """The object, moved by the affine map of shape (3, 4) or (4, 4): ``p -> M[:, :3] @ p + M[:, 3]``."""
        return Placed(self, matrix)

    def translated(self, offset: npt.ArrayLike) -> Placed:
        """The object, moved by (x, y, z)."""
        rows = np.eye(3, 4)
        rows[:, 3] = vector(offset, "offset")
        return Placed(self, rows)

    def scaled(self, factor: npt.ArrayLike) -> Placed:
        """The object, scaled about the origin by one factor or by three along the axes; none is zero."""
        factors = real_array(factor, "factor")
        if factors.shape not in ((), (3,)):
            raise ValueError(f"factor: one number or three are needed, got shape {factors.shape}")
        if not factors.all():
            raise ValueError(f"factor: none may be zero, got {factors.tolist()}")
        rows = np.zeros((3, 4))
        rows[[0, 1, 2], [0, 1, 2]] = factors
        return Placed(self, rows)

    def rotated(self, axis: npt.ArrayLike, angle: float) -> Placed:
        """The object, turned about an axis through the origin by an angle in radians, counter-clockwise as seen from the axis' tip."""
        rows = np.zeros((3, 4))
        rows[:, :3] = rotation(axis, angle)
        return Placed(self, rows)

    # -- solids

    def __or__(self, other: Object) -> Merge:
        return Merge(self, other) if isinstance(other, Object) else NotImplemented

    def __and__(self, other: Object) -> Intersection:
        return Intersection(self, other) if isinstance(other, Object) else NotImplemented

    def __sub__(self, other: Object) -> Difference:
        return Difference(self, other) if isinstance(other, Object) else NotImplemented

    def __invert__(self) -> Complement:
        return Complement(self)

    def without_caps(self) -> WithoutCaps:
        """The open surface without the flat ends that close it (cylinders, cones, prisms, cut quadrics, formulas)."""
        return WithoutCaps(self)

    def clipped(self, *solids: Object) -> Clipped:
        """The part of the surface that lies in all of these convex solids, not closed where it is cut."""
        return Clipped(self, solids)

    def twisted(self, axis: npt.ArrayLike, angle: float, start: float, end: float) -> Deformed:
        """The solid, turned about an axis by an angle (radians) that grows evenly between two heights along it."""
        return Deformed(self, [("twist", vector(axis, "axis"), math.degrees(angle), (start, end), (0.0, 0.0, 0.0))])

    def tapered(self, axis: npt.ArrayLike, factor: float, start: float, end: float) -> Deformed:
        """The solid, scaled across an axis by a factor that goes evenly from 1 to `factor` between two heights."""
        return Deformed(self, [("taper", vector(axis, "axis"), float(factor), (start, end), (0.0, 0.0, 0.0))])

    def bent(
        self, axis: npt.ArrayLike, toward: npt.ArrayLike, angle: float, start: float, end: float
    ) -> Deformed:
        """The solid, bent by an angle (radians) between two heights along an axis, to the side of `toward`."""
        side = vector(toward, "toward")
        return Deformed(self, [("bend", vector(axis, "axis"), math.degrees(angle), (start, end), side)])

    def in_lattice(
        self,
        low: npt.ArrayLike,
        high: npt.ArrayLike,
        size: tuple[int, int, int],
        moves: Mapping[tuple[int, int, int], npt.ArrayLike],
    ) -> Latticed:
        """A patch, NURBS or sewn surface whose points in a box move with a lattice of `size` control points.

        `moves` says by how much control points move, each named by its place along the three axes, from 0 on.
        """
        return Latticed(self, low, high, size, moves)

    # -- look

    def with_texture(self, texture: Texture) -> Textured:
        """The object with a look for pictures."""
        return Textured(self, texture)


def rotation(axis: npt.ArrayLike, angle: float) -> Floats:
    """The matrix (3, 3) of a rotation by an angle in radians, counter-clockwise as seen from the axis' tip.

    Right angles about an axis of coordinates are exact.

    Examples
    --------
    >>> import durer
    >>> import numpy as np
    >>> durer.rotation((0, 0, 1), np.pi / 2)
    array([[ 0., -1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0.,  1.]])
    """
    x, y, z = vector(axis, "axis")
    length = math.sqrt(x * x + y * y + z * z)
    if not 0.0 < length < math.inf:
        raise ValueError(f"axis: it must be finite and not zero, got ({x}, {y}, {z})")
    x, y, z = x / length, y / length, z / length
    angle = number(angle, "angle")
    s, c = math.sin(angle), math.cos(angle)
    quarter = angle / (math.pi / 2)
    if quarter == round(quarter):
        s, c = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][round(quarter) % 4]
    k = 1.0 - c
    return np.array(
        [
            [c + x * x * k, x * y * k - z * s, x * z * k + y * s],
            [y * x * k + z * s, c + y * y * k, y * z * k - x * s],
            [z * x * k - y * s, z * y * k + x * s, c + z * z * k],
        ]
    )


@final
class Placed(Object):
    """An object, moved by an affine map; made by `Object.placed`, `translated`, `scaled` and `rotated`.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Sphere((0, 0, 0), 1).scaled((1, 1, 3)).translated((0, 0, 1))]).all([[0, 0, 9]], [[0, 0, -1]]).t
    array([ 5., 11.])
    """

    __slots__ = ()

    def __init__(self, object: Object, matrix: npt.ArrayLike) -> None:
        rows = _matrix_rows(matrix)
        self._set(_native.placed(object._native, rows), (object, rows))

    def __repr__(self) -> str:
        return f"{self._arguments[0]!r}.placed({[list(row) for row in self._arguments[1]]!r})"


def _matrix_rows(value: npt.ArrayLike) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in matrix(value).tolist())


class _Combined(Object):
    __slots__ = ()
    _operation = ""

    def __init__(self, *solids: Object) -> None:
        _objects(solids)
        self._set(_native.csg(self._operation, [solid._native for solid in solids]), solids)


def _objects(objects: Sequence[object]) -> None:
    for item in objects:
        if not isinstance(item, Object):
            raise TypeError(f"a surface or a solid is needed, got {type(item).__name__}")


@final
class Merge(_Combined):
    """The solid of what is in any of some solids, without surfaces inside: ``a | b``.

    Examples
    --------
    >>> import durer
    >>> both = durer.Sphere((0, 0, 0), 1) | durer.Sphere((1, 0, 0), 1)
    >>> durer.Scene([both]).all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([4., 7.])
    """

    __slots__ = ()
    _operation = "merge"


@final
class Intersection(_Combined):
    """The solid of what is in all of some solids: ``a & b``.

    Examples
    --------
    >>> import durer
    >>> lens = durer.Sphere((0, 0, -3), 4) & durer.Sphere((0, 0, 3), 4)
    >>> durer.Scene([lens]).all([[0, 0, 9]], [[0, 0, -1]]).t
    array([ 8., 10.])
    """

    __slots__ = ()
    _operation = "intersection"


@final
class Difference(_Combined):
    """The solid of what is in the first and in none of the others: ``a - b``.

    Examples
    --------
    >>> import durer
    >>> shell = durer.Sphere((0, 0, 0), 2) - durer.Sphere((0, 0, 0), 1)
    >>> durer.Scene([shell]).all([[0, 0, 5]], [[0, 0, -1]]).t
    array([3., 4., 6., 7.])
    """

    __slots__ = ()
    _operation = "difference"


@final
class Union(Object):
    """Surfaces together as one object, each with its look; what lies inside is kept.

    Examples
    --------
    >>> import durer
    >>> both = durer.Union(durer.Sphere((0, 0, 0), 1), durer.Sphere((1, 0, 0), 1))
    >>> durer.Scene([both]).all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([4., 5., 6., 7.])
    """

    __slots__ = ()

    def __init__(self, *objects: Object) -> None:
        _objects(objects)
        self._set(_native.union([item._native for item in objects]), objects)


@final
class Complement(Object):
    """A solid with inside and outside exchanged: ``~a``.

    Examples
    --------
    >>> import durer
    >>> ~durer.Sphere((0, 0, 0), 1)
    ~Sphere((0.0, 0.0, 0.0), 1.0)
    >>> durer.Scene([~durer.Sphere((0, 0, 0), 1)]).contains([[0, 0, 0], [0, 0, 2]])
    array([False,  True])
    """

    __slots__ = ()

    def __init__(self, object: Object) -> None:
        self._set(_native.complement(object._native), (object,))

    def __repr__(self) -> str:
        return f"~{self._arguments[0]!r}"


@final
class WithoutCaps(Object):
    """A surface without the flat ends that close it; made by `Object.without_caps`.

    Examples
    --------
    >>> import durer
    >>> tube = durer.Cylinder((0, 0, 0), (0, 0, 2), 1).without_caps()
    >>> durer.Scene([tube]).any([[0, 0, 5]], [[0, 0, -1]])
    array([False])
    """

    __slots__ = ()

    def __init__(self, object: Object) -> None:
        self._set(_native.without_caps(object._native), (object,))

    def __repr__(self) -> str:
        return f"{self._arguments[0]!r}.without_caps()"


@final
class Clipped(Object):
    """The part of a surface that lies in some convex solids; made by `Object.clipped`.

    Examples
    --------
    >>> import durer
    >>> bowl = durer.Sphere((0, 0, 0), 1).clipped(durer.Plane((0, 0, 1), 0))
    >>> durer.Scene([bowl]).all([[0, 0, 3]], [[0, 0, -1]]).t
    array([4.])
    """

    __slots__ = ()

    def __init__(self, object: Object, solids: Sequence[Object]) -> None:
        _objects(solids)
        native = _native.clipped(object._native, [solid._native for solid in solids])
        self._set(native, (object, tuple(solids)))

    def __repr__(self) -> str:
        return f"{self._arguments[0]!r}.clipped({', '.join(map(repr, self._arguments[1]))})"


@final
class Deformed(Object):
    """A solid, deformed; made by `Object.twisted`, `tapered` and `bent`.

    Examples
    --------
    >>> import durer
    >>> drill = durer.Box((-1, -0.5, 0), (1, 0.5, 2)).twisted((0, 0, 1), 1.5, 0, 2)
    >>> durer.Scene([drill]).contains([[0.9, 0, 0.1], [0.9, 0, 1.9]])
    array([ True, False])
    """

    __slots__ = ()

    def __init__(self, object: Object, warps: Sequence[tuple[str, Vector, float, tuple[float, float], Vector]]) -> None:
        native = _native.deformed(object._native, list(warps))
        self._set(native, (object, tuple(warps)))


@final
class Latticed(Object):
    """A surface in a lattice of control points; made by `Object.in_lattice`.

    Examples
    --------
    >>> import durer
    >>> sheet = durer.BezierPatch([[(-1, -1, 0), (1, -1, 0)], [(-1, 1, 0), (1, 1, 0)]])
    >>> bump = sheet.in_lattice((-1, -1, -1), (1, 1, 1), (3, 3, 2), {(1, 1, 0): (0, 0, 1), (1, 1, 1): (0, 0, 1)})
    >>> float(durer.Scene([bump]).closest([[0, 0, 3]], [[0, 0, -1]]).t[0])
    2.75
    """

    __slots__ = ()

    def __init__(
        self,
        object: Object,
        low: npt.ArrayLike,
        high: npt.ArrayLike,
        size: tuple[int, int, int],
        moves: Mapping[tuple[int, int, int], npt.ArrayLike],
    ) -> None:
        listed = [(place, vector(by, "moves")) for place, by in moves.items()]
        corners = (vector(low, "low"), vector(high, "high"))
        native = _native.latticed(object._native, *corners, size, listed)
        self._set(native, (object, *corners, tuple(size), dict(listed)))


@final
class Texture:
    """A look for pictures: one colour (red, green and blue from 0 to 1) and how light leaves it.

    Parameters
    ----------
    colour : three numbers
    filter, transmit : float
        How much light passes, coloured and not.
    ambient, diffuse : float
        Light that is everywhere, and light from lights.
    phong, phong_size, specular, roughness : float
        Highlights.
    reflection : float
        How much of a mirror it is.
    refraction : float
        The index of refraction of the solid behind it.

    Examples
    --------
    >>> import durer
    >>> durer.Texture((1, 0, 0), phong=0.5)
    Texture((1.0, 0.0, 0.0), phong=0.5)
    """

    __slots__ = (
        "colour", "filter", "transmit", "ambient", "diffuse", "phong", "phong_size",
        "specular", "roughness", "reflection", "refraction",
    )  # fmt: skip

    colour: Vector
    filter: float
    transmit: float
    ambient: float
    diffuse: float
    phong: float
    phong_size: float
    specular: float
    roughness: float
    reflection: float
    refraction: float

    _DEFAULTS = (0.0, 0.0, 0.1, 0.6, 0.0, 40.0, 0.0, 0.05, 0.0, 1.0)

    def __init__(
        self,
        colour: npt.ArrayLike,
        filter: float = 0.0,
        transmit: float = 0.0,
        ambient: float = 0.1,
        diffuse: float = 0.6,
        phong: float = 0.0,
        phong_size: float = 40.0,
        specular: float = 0.0,
        roughness: float = 0.05,
        reflection: float = 0.0,
        refraction: float = 1.0,
    ) -> None:
        values = (filter, transmit, ambient, diffuse, phong, phong_size, specular, roughness, reflection, refraction)
        object.__setattr__(self, "colour", vector(colour, "colour"))
        for name, value in zip(self.__slots__[1:], values, strict=True):
            object.__setattr__(self, name, number(value, name))

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("Texture objects cannot be changed")

    def __reduce__(self) -> tuple[Any, ...]:
        return (Texture, tuple(getattr(self, name) for name in self.__slots__))

    def __repr__(self) -> str:
        others = zip(self.__slots__[1:], self._DEFAULTS, strict=True)
        changed = [f"{name}={getattr(self, name)!r}" for name, usual in others if getattr(self, name) != usual]
        return f"Texture({', '.join([repr(self.colour), *changed])})"


@final
class Textured(Object):
    """An object with a look; made by `Object.with_texture`.

    Examples
    --------
    >>> import durer
    >>> durer.Sphere((0, 0, 0), 1).with_texture(durer.Texture((1, 0, 0)))
    Sphere((0.0, 0.0, 0.0), 1.0).with_texture(Texture((1.0, 0.0, 0.0)))
    """

    __slots__ = ()

    def __init__(self, object: Object, texture: Texture) -> None:
        self._set(_native.with_texture(object._native, texture), (object, texture))

    def __repr__(self) -> str:
        return f"{self._arguments[0]!r}.with_texture({self._arguments[1]!r})"
