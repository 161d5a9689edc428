"""Patches: Bezier patches, surfaces of NURBS, and subdivision surfaces."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any, final

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


_Trim = tuple[str, tuple[tuple[float, ...], ...], int, tuple[float, ...]]


def _trim(trim: Any) -> _Trim:
    """A closed curve in the parameters: its kind, points with weights, degree and knots."""
    kind, points, degree = "polygon", trim, 0
    knots: tuple[float, ...] = ()
    if len(trim) > 0 and isinstance(trim[0], str):
        kind, points = trim[0], trim[1]
        degree = int(trim[2]) if len(trim) > 2 else 0
        knots = tuple(real_array(trim[3], "knots").ravel().tolist()) if len(trim) > 3 else ()
    rows = real_array(points, "trims")
    if rows.ndim != 2 or rows.shape[1] not in (2, 3):
        raise ValueError(f"trims: points of shape (n, 2), or (n, 3) with weights, are needed, got {rows.shape}")
    if rows.shape[1] == 2:
        rows = np.concatenate([rows, np.ones((len(rows), 1))], axis=1)
    return kind, tuple(tuple(row) for row in rows.tolist()), degree, knots


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
class TriangularPatch(Object):
    """The Bezier patch over a triangle, of degree 1 to 8: rows of control points, each one point shorter than the one before.

    `rows` is a list of rows of points (x, y, z), or (x, y, z, w) with weights: the first row has one point more than the
    degree, the last has one point; u runs along a row. `uv` has the texture coordinates at (u, v) = (0, 0), (1, 0) and
    (0, 1). An open surface.

    Examples
    --------
    >>> import durer
    >>> sheet = durer.TriangularPatch([[(0, 0, 0), (1, 0, 0)], [(0, 1, 0)]])
    >>> durer.Scene([sheet]).all([[0.25, 0.25, 3]], [[0, 0, -1]]).t
    array([3.])
    """

    __slots__ = ()

    def __init__(
        self, rows: Sequence[npt.ArrayLike], uv: npt.ArrayLike = ((0, 0), (1, 0), (0, 1))
    ) -> None:
        triangle = []
        for number, row in enumerate(rows):
            points = real_array(row, "rows")
            if points.ndim != 2 or points.shape[1] not in (3, 4) or len(points) != len(rows) - number:
                raise ValueError(
                    f"rows: row {number} needs {len(rows) - number} points of 3 or 4 numbers, got shape {points.shape}"
                )
            if points.shape[1] == 3:
                points = np.concatenate([points, np.ones((len(points), 1))], axis=1)
            triangle.append(tuple(tuple(point) for point in points.tolist()))
        corners = row_tuples(uv, 2, "uv")
        if len(corners) != 3:
            raise ValueError(f"uv: 3 rows are needed, got {len(corners)}")
        points_in_order = tuple(point for row in triangle for point in row)
        native = _native.triangular_patch(points_in_order, len(triangle), corners)
        self._set(native, (tuple(triangle), corners))


@final
class Nurbs(Object):
    """A surface of non-uniform rational B-splines: a net of points (rows, columns, 3), or 4 with weights, and degrees 1 to 9.

    `knots` are two lists, along u (the columns) and along v; without them they are uniform, with the surface's ends at
    the outer points. What is periodic has one knot more than points, and its points go round. An open surface.

    `trims` are closed curves in (u, v), as the knots count them: what lies to the left of each stays, so an outer loop runs
    counter-clockwise and a hole clockwise. A trim is an array of points (n, 2), a polygon; or ``("bezier", points)``, four
    points for each piece; or ``("nurbs", points, degree, knots)`` with points (n, 2), or (n, 3) with weights.

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
        trims: Sequence[Any] = (),
    ) -> None:
        net = _net(points)
        lists = ((), ()) if knots is None else knots
        u, v = (tuple(real_array(values, "knots").ravel().tolist()) for values in lists)
        degrees, both = (int(degree[0]), int(degree[1])), (u, v)
        closed = (bool(periodic[0]), bool(periodic[1]))
        loops = tuple(_trim(trim) for trim in trims)
        native = _native.nurbs(*_flat(net), degrees, both, closed, loops)
        self._set(native, (net, degrees, both, closed, loops) if loops else (net, degrees, both, closed))


@final
class Sewn(Object):
    """Several `Nurbs` that share edges, as one object; a solid if it is `closed`: then every edge must have a partner.

    Edges are the same if their control points are. `seal` is how far apart edges may be that belong together, as those of
    trimmed surfaces are: gaps up to this width of a closed one are closed.

    Examples
    --------
    >>> import durer
    >>> left = durer.Nurbs([[(0, 0, 0), (1, 0, 0)], [(0, 1, 0), (1, 1, 0)]], (1, 1))
    >>> right = durer.Nurbs([[(1, 0, 0), (2, 0, 0)], [(1, 1, 0), (2, 1, 0)]], (1, 1))
    >>> durer.Scene([durer.Sewn([left, right])]).all([[1, 0.5, 3]], [[0, 0, -1]]).t
    array([3.])
    """

    __slots__ = ()

    def __init__(self, surfaces: Sequence[Nurbs], seal: float = 0.0, closed: bool = False) -> None:
        arguments = (tuple(surfaces), number(seal, "seal"), bool(closed))
        self._set(_native.sewn([surface._native for surface in arguments[0]], *arguments[1:]), arguments)


@final
class Subdivision(Object):
    """The limit of a control mesh under subdivision; a solid if the mesh is closed.

    Parameters
    ----------
    vertices : array (n, 3)
        The control points.
    faces : sequence of sequences of whole numbers
        Polygons of three vertices or more, by their numbers.
    creases : sequence of (a, b, sharpness), optional
        Sharp edges by their two vertices; a sharpness of 10 or more is sharp for ever.
    corners : sequence of (vertex, sharpness), optional
        Sharp vertices.
    holes : sequence of whole numbers, optional
        Faces that take part in the rules and are not there.
    boundary : "corners" or "smooth"
        Whether vertices with one face are sharp.
    uv, uv_faces : array (k, 2) and sequence of sequences, optional
        Texture coordinates, and their numbers at the corners of each face.
    uv_interpolation : "linear" or "smooth"
        Whether they are linear over each face or follow the rules of the surface.
    scheme : "catmull_clark" or "loop"
        Whose rules: Catmull and Clark's for any polygons, or Loop's for triangles.

    Examples
    --------
    >>> import durer
    >>> corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    >>> faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    >>> scene = durer.Scene([durer.Subdivision(corners, faces)])
    >>> round(float(scene.closest([[3, 0, 0, -1, 0, 0]]).t[0]), 9)
    2.160493827
    """

    __slots__ = ()

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: Sequence[Sequence[int]],
        creases: Sequence[tuple[int, int, float]] = (),
        corners: Sequence[tuple[int, float]] = (),
        holes: Sequence[int] = (),
        boundary: str = "corners",
        uv: npt.ArrayLike | None = None,
        uv_faces: Sequence[Sequence[int]] = (),
        scheme: str = "catmull_clark",
        uv_interpolation: str = "linear",
    ) -> None:
        if boundary not in ("corners", "smooth"):
            raise ValueError(f'boundary: "corners" or "smooth" is needed, got {boundary!r}')
        if scheme not in ("catmull_clark", "loop"):
            raise ValueError(f'scheme: "catmull_clark" or "loop" is needed, got {scheme!r}')
        if uv_interpolation not in ("linear", "smooth"):
            raise ValueError(f'uv_interpolation: "linear" or "smooth" is needed, got {uv_interpolation!r}')
        points = row_tuples(vertices, 3, "vertices")
        polygons, uv_polygons = _polygons(faces, "faces"), _polygons(uv_faces, "uv_faces")
        coordinates = None if uv is None else row_tuples(uv, 2, "uv")
        edges = tuple((_index(a, "creases"), _index(b, "creases"), number(s, "creases")) for a, b, s in creases)
        sharp = tuple((_index(v, "corners"), number(s, "corners")) for v, s in corners)
        missing = tuple(_index(face, "holes") for face in holes)
        flags = (boundary == "smooth", scheme == "loop", uv_interpolation == "smooth")
        native = _native.subdivision(points, polygons, coordinates or (), uv_polygons, edges, sharp, missing, *flags)
        lists = (points, polygons, edges, sharp, missing, boundary, coordinates, uv_polygons)
        self._set(native, (*lists, scheme, uv_interpolation))


def _index(value: Any, name: str) -> int:
    """One whole number from 0 on that fits 32 bits."""
    index = operator.index(value)
    if not 0 <= index < 2**32:
        raise ValueError(f"{name}: a whole number from 0 on is needed, got {index}")
    return index


def _polygons(faces: Sequence[Sequence[int]], name: str) -> tuple[tuple[int, ...], ...]:
    return tuple(tuple(_index(v, name) for v in face) for face in faces)
