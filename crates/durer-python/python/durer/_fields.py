"""Superellipsoids, blobs and fractals."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, final

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Vector, number, real_array, row_tuples, vector
from ._basic import Box, Sphere
from ._objects import Object, _matrix_rows


@final
class Superellipsoid(Object):
    """``(|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1``.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Superellipsoid(0.5, 0.5)]).all([[0, 0, 5]], [[0, 0, -1]]).t
    array([4., 6.])
    """

    __slots__ = ()

    def __init__(self, e: float, n: float) -> None:
        arguments = (number(e, "e"), number(n, "n"))
        self._set(_native.superellipsoid(*arguments), arguments)


@final
class Blob(Object):
    """Where the fields of balls and rods add up to a threshold.

    Parameters
    ----------
    components : sequence
        Tuples ``(centre, radius, strength)`` for balls, ``(a, b, radius, strength)`` for rods.
    threshold : float
        Positive.

    Examples
    --------
    >>> import durer
    >>> blob = durer.Blob([((0, 0, 0), 1, 1), ((1, 0, 0), 1, 1)], 0.5)
    >>> durer.Scene([blob]).all([[-3, 0, 0]], [[1, 0, 0]]).counts
    array([2])
    """

    __slots__ = ()

    def __init__(self, components: Iterable[Sequence[Any]], threshold: float) -> None:
        fields: list[tuple[Vector, Vector, float, float]] = []
        for component in components:
            if len(component) not in (3, 4):
                raise ValueError(f"components: 3 or 4 entries are needed, got {len(component)}")
            *ends, radius, strength = component
            a, b = vector(ends[0], "components"), vector(ends[-1], "components")
            fields.append((a, b, number(radius, "radius"), number(strength, "strength")))
        self._set(_native.blob(fields, number(threshold, "threshold")), (tuple(fields), float(threshold)))


@final
class Julia(Object):
    """A slice of the Julia set of the quaternions for ``q -> q^power + c``.

    Examples
    --------
    >>> import durer
    >>> set = durer.Julia((-0.2, 0.7, 0.1, -0.3), iterations=6)
    >>> durer.Scene([set]).any([[0.1, 0, 5], [5, 5, 5]], [[0, 0, -1], [0, 0, -1]])
    array([ True, False])
    """

    __slots__ = ()

    def __init__(
        self,
        c: Sequence[float],
        power: int = 2,
        iterations: int = 8,
        radius: float = 4.0,
        normal: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        distance: float = 0.0,
    ) -> None:
        four: list[tuple[float, ...]] = []
        for name, value in (("c", c), ("normal", normal)):
            array = real_array(value, name)
            if array.shape != (4,):
                raise ValueError(f"{name}: shape (4,) is needed, got {array.shape}")
            four.append(tuple(array.tolist()))
        arguments = (four[0], int(power), int(iterations), float(radius), four[1], float(distance))
        self._set(_native.julia(*arguments), arguments)


def _depth(value: int) -> int:
    if not 0 <= value <= 20 or value != int(value):
        raise ValueError(f"depth: a whole number from 0 to 20 is needed, got {value}")
    return int(value)


@final
class Ifs(Object):
    """An iterated function system: the union of a leaf under all products of `depth` contractions.

    Parameters
    ----------
    leaf : Box, Sphere or array (4, 3)
        What is copied; an array holds the corners of a tetrahedron.
    maps : sequence of arrays (3, 4) or (4, 4)
        The maps ``p -> M[:, :3] @ p + M[:, 3]``; the largest singular value of each is below 1.
    depth : int
        How many maps are multiplied, from 0 to 20. Nothing is stored: copies unfold along each ray.

    Examples
    --------
    >>> import durer
    >>> import numpy as np
    >>> half = 0.5 * np.eye(3, 4)
    >>> right = half + [[0, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0]]
    >>> set = durer.Ifs(durer.Box((0, 0, 0), (1, 1, 1)), [half, right], 12)
    """

    __slots__ = ()

    def __init__(self, leaf: Object | npt.ArrayLike, maps: Sequence[npt.ArrayLike], depth: int) -> None:
        radius = 0.0
        kept: Object | tuple[tuple[float, ...], ...]
        if isinstance(leaf, Box):
            kind, points, kept = "box", leaf._arguments, leaf
        elif isinstance(leaf, Sphere):
            kind, points, radius, kept = "sphere", leaf._arguments[:1], leaf._arguments[1], leaf
        elif isinstance(leaf, Object):
            raise ValueError(f"leaf: a Box, a Sphere or the corners of a tetrahedron is needed, got {type(leaf).__name__}")
        else:
            kind, points = "tetrahedron", row_tuples(leaf, 3, "leaf")
            kept = points
        rows = tuple(_matrix_rows(each) for each in maps)
        count = _depth(depth)
        self._set(_native.ifs(kind, points, radius, rows, count), (kept, rows, count))


@final
class Menger(Object):
    """The sponge of Menger in the cube from -1 to 1, `depth` times refined (0 to 20).

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Menger(3)]).bounds.tolist()
    [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]
    """

    __slots__ = ()

    def __init__(self, depth: int) -> None:
        count = _depth(depth)
        self._set(_native.menger(count), (count,))


@final
class Sierpinski(Object):
    """The tetrahedron of Sierpinski with the corners (1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1): 4**depth tetrahedra (0 to 20).

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Sierpinski(4)]).primitive_count
    1
    """

    __slots__ = ()

    def __init__(self, depth: int) -> None:
        count = _depth(depth)
        self._set(_native.sierpinski(count), (count,))
