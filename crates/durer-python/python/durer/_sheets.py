"""Free-form sheets and fields of heights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import number, real_array, row_tuples
from ._objects import Object


_Net = tuple[tuple[tuple[float, ...], ...], ...]


def _net(points: npt.ArrayLike) -> _Net:
    """The rows of a net of points (rows, columns, 3), or 4 with weights, all with weights."""
    net = real_array(points, "points")
    if net.ndim != 3 or net.shape[2] not in (3, 4):
        raise ValueError(f"points: shape (rows, columns, 3) or (rows, columns, 4) is needed, got {net.shape}")
    rows, columns = net.shape[:2]
    if net.shape[2] == 3:
        net = np.concatenate([net, np.ones((rows, columns, 1))], axis=2)
    return tuple(tuple(tuple(point) for point in row) for row in net.tolist())


def _flat(net: _Net) -> tuple[tuple[tuple[float, ...], ...], tuple[int, int]]:
    """The points of a net row by row, and its columns and rows."""
    columns = len(net[0]) if net else 0
    return tuple(point for row in net for point in row), (columns, len(net))


@final
class BezierPatch(Object):
    """The Bezier patch of a net of control points (rows, columns, 3), 2 to 16 of each; u runs along a row, v from row to row.

    With four numbers each, (rows, columns, 4), the last is the point's weight. `uv` has the texture coordinates at
    (u, v) = (0, 0), (1, 0), (1, 1) and (0, 1). An open surface.

    Examples
    --------
    >>> import durer
    >>> sheet = durer.BezierPatch([[[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 1]]])
    >>> durer.Scene([sheet]).all([[0.5, 0.5, 3]], [[0, 0, -1]]).t
    array([2.75])
    """

    __slots__ = ()

    def __init__(self, points: npt.ArrayLike, uv: npt.ArrayLike = ((0, 0), (1, 0), (1, 1), (0, 1))) -> None:
        net = _net(points)
        corners = row_tuples(uv, 2, "uv")
        if len(corners) != 4:
            raise ValueError(f"uv: 4 rows are needed, got {len(corners)}")
        self._set(_native.bezier_patch(*_flat(net), corners), (net, corners))


@final
class Nurbs(Object):
    """A surface of non-uniform rational B-splines: a net of points (rows, columns, 3), or 4 with weights, and degrees 1 to 9.

    `knots` are two lists, along u (the columns) and along v; without them they are uniform, with the surface's ends at
    the outer points. What is periodic has one knot more than points, and its points go round. An open surface.

    Examples
    --------
    >>> import durer
    >>> sheet = durer.Nurbs([[[x, y, 0] for x in range(3)] for y in range(3)], (2, 2))
    >>> durer.Scene([sheet]).closest([[1, 1, 3]], [[0, 0, -1]]).uv
    array([[0.5, 0.5]])
    """

    __slots__ = ()

    def __init__(
        self,
        points: npt.ArrayLike,
        degree: tuple[int, int],
        knots: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
        periodic: tuple[bool, bool] = (False, False),
    ) -> None:
        net = _net(points)
        lists = ((), ()) if knots is None else knots
        u, v = (tuple(real_array(values, "knots").ravel().tolist()) for values in lists)
        degrees, both = (int(degree[0]), int(degree[1])), (u, v)
        closed = (bool(periodic[0]), bool(periodic[1]))
        native = _native.nurbs(*_flat(net), degrees, both, closed)
        self._set(native, (net, degrees, both, closed))


@final
class HeightField(Object):
    """A sheet of triangles over the unit square of x and z, two for each cell of a grid of heights y.

    ``heights[row, column]`` is the height at x = column / (columns - 1); row 0 lies at z = 1, as in a picture. Parts below
    ``water_level`` are left out; ``smooth`` interpolates normals for shading. By itself it is an open sheet; combined with
    solids it is all that lies under it, without end downward.

    Examples
    --------
    >>> import durer
    >>> durer.HeightField([[0.0, 0.5], [0.25, 1.0]])
    HeightField([[0.0, 0.5], [0.25, 1.0]], None, False)
    """

    __slots__ = ()

    def __init__(self, heights: npt.ArrayLike, water_level: float | None = None, smooth: bool = False) -> None:
        array = real_array(heights, "heights")
        if array.ndim != 2:
            raise ValueError(f"heights: two dimensions are needed, got shape {array.shape}")
        level = None if water_level is None else number(water_level, "water_level")
        size = (array.shape[1], array.shape[0])
        native = _native.height_field(size, array.ravel().tolist(), level, bool(smooth))
        self._set(native, (array.tolist(), level, bool(smooth)))


@final
class Terrain(Object):
    """A fractal sheet over the unit square of x and z, with ``2**levels`` cells a side, made on demand.

    Level l moves points by up to ``amplitude * 2**(-roughness * (l - 1))``. ``corners`` are the heights at (0, 0), (1, 0),
    (0, 1) and (1, 1), x first.

    Examples
    --------
    >>> import durer
    >>> hills = durer.Terrain(8, seed=1)
    >>> durer.Scene([hills]).any([[0.5, 9, 0.5]], [[0, -1, 0]])
    array([ True])
    """

    __slots__ = ()

    def __init__(
        self,
        levels: int,
        roughness: float = 0.5,
        amplitude: float = 0.25,
        seed: int = 0,
        corners: Sequence[float] = (0.0, 0.0, 0.0, 0.0),
        water_level: float | None = None,
        smooth: bool = False,
    ) -> None:
        heights = real_array(corners, "corners")
        if heights.shape != (4,):
            raise ValueError(f"corners: shape (4,) is needed, got {heights.shape}")
        for name, value, most in (("levels", levels, 15), ("seed", seed, 2**64 - 1)):
            if not 0 <= value <= most:
                raise ValueError(f"{name}: a whole number from 0 to {most} is needed, got {value}")
        numbers = (number(roughness, "roughness"), number(amplitude, "amplitude"))
        level = None if water_level is None else number(water_level, "water_level")
        four = tuple(heights.tolist())
        native = _native.terrain(int(levels), numbers, int(seed), four, level, bool(smooth))
        self._set(native, (int(levels), *numbers, int(seed), four, level, bool(smooth)))
