"""Surfaces and solids: frozen values that are moved, combined and given a look by making new ones.

Lengths are in the units of the scene, angles in radians, points and vectors are three numbers (x, y, z).
"""

from __future__ import annotations

import math
import operator
import os
from collections.abc import Iterable, Sequence
from typing import Any, final

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import Object as NativeObject
from ._arrays import Floats, Ints, Vector, index_table, matrix, number, read_only, real_array, table, vector


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

    # -- look

    def with_texture(self, texture: Texture) -> Textured:
        """The object with a look for pictures."""
        return Textured(self, texture)


def rotation(axis: npt.ArrayLike, angle: float) -> Floats:
    """The matrix (3, 3) of a rotation by an angle in radians, counter-clockwise as seen from the axis' tip.

    Right angles about an axis of coordinates are exact.
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
class Sphere(Object):
    """All points at a distance from a centre.

    Examples
    --------
    >>> import durer
    >>> durer.Sphere((0, 0, 0), 1)
    Sphere((0.0, 0.0, 0.0), 1.0)
    """

    __slots__ = ()

    def __init__(self, centre: npt.ArrayLike, radius: float) -> None:
        arguments = (vector(centre, "centre"), number(radius, "radius"))
        self._set(_native.sphere(*arguments), arguments)


@final
class Box(Object):
    """An axis-aligned box between two opposite corners."""

    __slots__ = ()

    def __init__(self, a: npt.ArrayLike, b: npt.ArrayLike) -> None:
        arguments = (vector(a, "a"), vector(b, "b"))
        self._set(_native.axis_box(*arguments), arguments)


@final
class Cylinder(Object):
    """A closed circular cylinder between the middles of its ends."""

    __slots__ = ()

    def __init__(self, base: npt.ArrayLike, cap: npt.ArrayLike, radius: float) -> None:
        arguments = (vector(base, "base"), vector(cap, "cap"), number(radius, "radius"))
        self._set(_native.cylinder(*arguments), arguments)


@final
class Cone(Object):
    """A closed circular cone or frustum between the middles of its ends, with a radius at each."""

    __slots__ = ()

    def __init__(
        self, base: npt.ArrayLike, base_radius: float, cap: npt.ArrayLike, cap_radius: float = 0.0
    ) -> None:
        arguments = (
            vector(base, "base"),
            number(base_radius, "base_radius"),
            vector(cap, "cap"),
            number(cap_radius, "cap_radius"),
        )
        self._set(_native.cone(*arguments), arguments)


@final
class Plane(Object):
    """The points p with ``p . normal == distance * |normal|``; a solid whose inside is behind the normal."""

    __slots__ = ()

    def __init__(self, normal: npt.ArrayLike, distance: float = 0.0) -> None:
        arguments = (vector(normal, "normal"), number(distance, "distance"))
        self._set(_native.plane(*arguments), arguments)


@final
class Disc(Object):
    """A flat disc; with a hole if `hole`, its radius, is positive."""

    __slots__ = ()

    def __init__(
        self, centre: npt.ArrayLike, normal: npt.ArrayLike, radius: float, hole: float = 0.0
    ) -> None:
        arguments = (
            vector(centre, "centre"),
            vector(normal, "normal"),
            number(radius, "radius"),
            number(hole, "hole"),
        )
        self._set(_native.disc(*arguments), arguments)


@final
class Parallelogram(Object):
    """The points ``corner + a u + b v`` with a and b from 0 to 1."""

    __slots__ = ()

    def __init__(self, corner: npt.ArrayLike, u: npt.ArrayLike, v: npt.ArrayLike) -> None:
        arguments = (vector(corner, "corner"), vector(u, "u"), vector(v, "v"))
        self._set(_native.parallelogram(*arguments), arguments)


def _rows(value: npt.ArrayLike, columns: int, name: str) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in table(value, columns, name).tolist())


@final
class Triangle(Object):
    """A triangle by its vertices (3, 3), with normals for shading at them if they are given."""

    __slots__ = ()

    def __init__(self, vertices: npt.ArrayLike, normals: npt.ArrayLike | None = None) -> None:
        corners = _rows(vertices, 3, "vertices")
        shading = None if normals is None else _rows(normals, 3, "normals")
        for name, rows in (("vertices", corners), ("normals", shading)):
            if rows is not None and len(rows) != 3:
                raise ValueError(f"{name}: shape (3, 3) is needed, got ({len(rows)}, 3)")
        self._set(_native.triangle(corners, shading), (corners, shading))


@final
class Polygon(Object):
    """A plane polygon: one or more loops of points (n, 3). Inside is what they go round an odd number of times, or any."""

    __slots__ = ()

    def __init__(self, loops: Iterable[npt.ArrayLike], even_odd: bool = True) -> None:
        outlines = tuple(_rows(loop, 3, "loops") for loop in loops)
        self._set(_native.polygon(outlines, bool(even_odd)), (outlines, bool(even_odd)))


@final
class Quadric(Object):
    """``A x^2 + B y^2 + C z^2 + D xy + E xz + F yz + G x + H y + I z + J = 0``: the ten coefficients in this order."""

    __slots__ = ()

    def __init__(self, coefficients: npt.ArrayLike) -> None:
        values = real_array(coefficients, "coefficients")
        if values.shape != (10,):
            raise ValueError(f"coefficients: shape (10,) is needed, got {values.shape}")
        arguments = (tuple(values.tolist()),)
        self._set(_native.quadric(*arguments), arguments)


class _Named(Object):
    __slots__ = ()
    _kind = ""

    def __init__(self, semi_axes: npt.ArrayLike, extent: npt.ArrayLike | None = None) -> None:
        axes = vector(semi_axes, "semi_axes")
        ends: tuple[float, float] | None = None
        if extent is not None:
            both = real_array(extent, "extent")
            if both.shape != (2,):
                raise ValueError(f"extent: shape (2,) is needed, got {both.shape}")
            ends = (float(both[0]), float(both[1]))
        self._set(_native.named_quadric(self._kind, axes, ends), (axes, ends))

    def __repr__(self) -> str:
        axes, ends = self._arguments
        return f"{type(self).__name__}({axes!r})" if ends is None else f"{type(self).__name__}({axes!r}, {ends!r})"


@final
class Ellipsoid(_Named):
    """``x^2/a^2 + y^2/b^2 + z^2/c^2 = 1`` with semi-axes (a, b, c), or its part between two planes ``z = extent``."""

    __slots__ = ()
    _kind = "ellipsoid"


@final
class EllipticParaboloid(_Named):
    """``x^2/a^2 + y^2/b^2 = z/c``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "elliptic_paraboloid"


@final
class HyperbolicParaboloid(_Named):
    """``x^2/a^2 - y^2/b^2 = z/c``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "hyperbolic_paraboloid"


@final
class HyperboloidOneSheet(_Named):
    """``x^2/a^2 + y^2/b^2 - z^2/c^2 = 1``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "hyperboloid_one_sheet"


@final
class HyperboloidTwoSheets(_Named):
    """``z^2/c^2 - x^2/a^2 - y^2/b^2 = 1``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "hyperboloid_two_sheets"


@final
class EllipticCone(_Named):
    """``x^2/a^2 + y^2/b^2 = z^2/c^2``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "elliptic_cone"


@final
class EllipticCylinder(_Named):
    """``x^2/a^2 + y^2/b^2 = 1``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "elliptic_cylinder"


@final
class HyperbolicCylinder(_Named):
    """``x^2/a^2 - y^2/b^2 = 1``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "hyperbolic_cylinder"


@final
class ParabolicCylinder(_Named):
    """``x^2/a^2 = y/b``, cut at ``z = extent`` if that is given."""

    __slots__ = ()
    _kind = "parabolic_cylinder"


@final
class Polynomial(Object):
    """The zero set of a polynomial of an order up to 35; its coefficients by falling powers of x, then of y, then of z."""

    __slots__ = ()

    def __init__(self, order: int, coefficients: npt.ArrayLike) -> None:
        values = real_array(coefficients, "coefficients")
        if values.ndim != 1:
            raise ValueError(f"coefficients: shape (n,) is needed, got {values.shape}")
        arguments = (int(order), tuple(values.tolist()))
        self._set(_native.polynomial(*arguments), arguments)


@final
class Torus(Object):
    """A tube of radius `minor` around a circle of radius `major` about the y axis.

    Examples
    --------
    >>> import durer
    >>> scene = durer.Scene([durer.Torus(2, 0.5)])
    >>> scene.all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([2.5, 3.5, 6.5, 7.5])
    """

    __slots__ = ()

    def __init__(self, major: float, minor: float) -> None:
        arguments = (number(major, "major"), number(minor, "minor"))
        self._set(_native.torus(*arguments), arguments)


@final
class Cyclide(Object):
    """A Dupin cyclide: swept by a sphere of mean radius d whose centre goes round an ellipse in the xz plane, of semi-axis a along x and foci at distance c."""

    __slots__ = ()

    def __init__(self, a: float, c: float, d: float) -> None:
        arguments = (number(a, "a"), number(c, "c"), number(d, "d"))
        self._set(_native.cyclide(*arguments), arguments)


@final
class Prism(Object):
    """Closed outlines, arrays (n, 2) of x and z, swept along y between two heights.

    `spline` says how an outline goes through its points: "linear", "quadratic", "cubic" or "bezier". A conic prism is y
    times as large at the height y.
    """

    __slots__ = ()

    def __init__(
        self,
        outlines: Iterable[npt.ArrayLike],
        heights: npt.ArrayLike,
        spline: str = "linear",
        conic: bool = False,
    ) -> None:
        loops = tuple(_rows(outline, 2, "outlines") for outline in outlines)
        ends = real_array(heights, "heights")
        if ends.shape != (2,):
            raise ValueError(f"heights: shape (2,) is needed, got {ends.shape}")
        arguments = (loops, (float(ends[0]), float(ends[1])), str(spline), bool(conic))
        self._set(_native.prism(*arguments), arguments)


@final
class Sweep(Object):
    """Closed outlines, arrays (n, 2), moved along a path, an array (n, 3) of points.

    `spline` says how an outline goes through its points: "linear" or "bezier" (four points for each piece);
    `path_spline` how the path does: "linear" (with mitred corners), "cubic" (through all points but the first and the
    last), "b" or "bezier". `sizes` has the profile's size at each point, along the same spline; without it, 1. The
    profile's second axis points to the side of `up`; without `up`, the smallest rotation of z onto the path turns x and y
    into its axes, and from there on they turn as little as can be. `twist` is the whole turn about the path in radians.
    A solid with flat caps.
    """

    __slots__ = ()

    def __init__(
        self,
        outlines: Iterable[npt.ArrayLike],
        path: npt.ArrayLike,
        sizes: npt.ArrayLike | None = None,
        up: npt.ArrayLike | None = None,
        spline: str = "linear",
        path_spline: str = "linear",
        twist: float = 0.0,
    ) -> None:
        loops = tuple(_rows(outline, 2, "outlines") for outline in outlines)
        points = _rows(path, 3, "path")
        given = np.ones(len(points)) if sizes is None else real_array(sizes, "sizes")
        if given.shape != (len(points),):
            raise ValueError(f"sizes: shape ({len(points)},) is needed, got {given.shape}")
        side = None if up is None else vector(up, "up")
        all_sizes = tuple(float(size) for size in given)
        arguments = (loops, points, all_sizes, side, str(spline), str(path_spline), number(twist, "twist"))
        self._set(_native.sweep(*arguments), arguments)


@final
class SphereSweep(Object):
    """All balls whose centres and radii follow a spline of `spheres`, an array (n, 4) of x, y, z and radius.

    `spline` is "linear", "b" (the uniform cubic B-spline, which passes near its control points) or "cubic" (through all
    spheres but the first and the last, which only tell slopes).
    """

    __slots__ = ()

    def __init__(self, spheres: npt.ArrayLike, spline: str = "linear") -> None:
        arguments = (_rows(spheres, 4, "spheres"), str(spline))
        self._set(_native.sphere_sweep(*arguments), arguments)


@final
class SurfaceOfRevolution(Object):
    """A smooth curve through points (n, 2), a radius and a height each, turned about the y axis; the first and the last only tell slopes."""

    __slots__ = ()

    def __init__(self, points: npt.ArrayLike) -> None:
        arguments = (_rows(points, 2, "points"),)
        self._set(_native.surface_of_revolution(*arguments), arguments)


@final
class Lathe(Object):
    """A profile through points (n, 2), a radius and a height each, turned about the y axis.

    `spline` says how it goes through its points: "linear", "quadratic" (the first point only tells a slope), "cubic"
    (the first and the last one do) or "bezier" (four points for each piece). Closed, or with both ends on the axis, it
    is a solid.
    """

    __slots__ = ()

    def __init__(self, points: npt.ArrayLike, spline: str = "linear") -> None:
        arguments = (_rows(points, 2, "points"), str(spline))
        self._set(_native.lathe(*arguments), arguments)


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
    kind, points, degree, knots = "polygon", trim, 0, ()
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
    """

    __slots__ = ()

    def __init__(self, points: npt.ArrayLike, uv: npt.ArrayLike = ((0, 0), (1, 0), (1, 1), (0, 1))) -> None:
        net = _net(points)
        corners = _rows(uv, 2, "uv")
        if len(corners) != 4:
            raise ValueError(f"uv: 4 rows are needed, got {len(corners)}")
        self._set(_native.bezier_patch(*_flat(net), corners), (net, corners))


@final
class TriangularPatch(Object):
    """The Bezier patch over a triangle, of degree 1 to 8: rows of control points, each one point shorter than the one before.

    `rows` is a list of rows of points (x, y, z), or (x, y, z, w) with weights: the first row has one point more than the
    degree, the last has one point; u runs along a row. `uv` has the texture coordinates at (u, v) = (0, 0), (1, 0) and
    (0, 1). An open surface.
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
        corners = _rows(uv, 2, "uv")
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
    """

    __slots__ = ()

    def __init__(self, surfaces: Sequence[Nurbs], seal: float = 0.0, closed: bool = False) -> None:
        arguments = (tuple(surfaces), number(seal, "seal"), bool(closed))
        self._set(_native.sewn([surface._native for surface in arguments[0]], *arguments[1:]), arguments)


@final
class Subdivision(Object):
    """The limit of Catmull and Clark's subdivision of a control mesh; a solid if the mesh is closed.

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
    ) -> None:
        if boundary not in ("corners", "smooth"):
            raise ValueError(f'boundary: "corners" or "smooth" is needed, got {boundary!r}')
        points = _rows(vertices, 3, "vertices")
        polygons, uv_polygons = _polygons(faces, "faces"), _polygons(uv_faces, "uv_faces")
        coordinates = None if uv is None else _rows(uv, 2, "uv")
        edges = tuple((_index(a, "creases"), _index(b, "creases"), number(s, "creases")) for a, b, s in creases)
        sharp = tuple((_index(v, "corners"), number(s, "corners")) for v, s in corners)
        missing = tuple(_index(face, "holes") for face in holes)
        smooth = boundary == "smooth"
        native = _native.subdivision(points, polygons, coordinates or (), uv_polygons, edges, sharp, missing, smooth)
        self._set(native, (points, polygons, edges, sharp, missing, boundary, coordinates, uv_polygons))


def _index(value: Any, name: str) -> int:
    """One whole number from 0 on that fits 32 bits."""
    index = operator.index(value)
    if not 0 <= index < 2**32:
        raise ValueError(f"{name}: a whole number from 0 on is needed, got {index}")
    return index


def _polygons(faces: Sequence[Sequence[int]], name: str) -> tuple[tuple[int, ...], ...]:
    return tuple(tuple(_index(v, name) for v in face) for face in faces)


@final
class Ovus(Object):
    """An egg about the y axis: a sphere about the origin and one about the point `bottom` above it, with these radii."""

    __slots__ = ()

    def __init__(self, bottom: float, top: float) -> None:
        arguments = (number(bottom, "bottom"), number(top, "top"))
        self._set(_native.ovus(*arguments), arguments)


@final
class Lemon(Object):
    """A spindle between two points with a radius at each; the arc between them has the inner radius."""

    __slots__ = ()

    def __init__(
        self,
        base: npt.ArrayLike,
        base_radius: float,
        apex: npt.ArrayLike,
        apex_radius: float,
        inner_radius: float,
    ) -> None:
        arguments = (
            vector(base, "base"),
            number(base_radius, "base_radius"),
            vector(apex, "apex"),
            number(apex_radius, "apex_radius"),
            number(inner_radius, "inner_radius"),
        )
        self._set(_native.lemon(*arguments), arguments)


@final
class SphericalSector(Object):
    """The part of a ball within an angle (radians) of an axis through its centre."""

    __slots__ = ()

    def __init__(
        self, centre: npt.ArrayLike, radius: float, axis: npt.ArrayLike, half_angle: float
    ) -> None:
        arguments = (
            vector(centre, "centre"),
            number(radius, "radius"),
            vector(axis, "axis"),
            number(half_angle, "half_angle"),
        )
        self._set(_native.spherical_sector(*arguments), arguments)


@final
class Superellipsoid(Object):
    """``(|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1``."""

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
    """A slice of the Julia set of the quaternions for ``q -> q^power + c``."""

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
            kind, points = "tetrahedron", _rows(leaf, 3, "leaf")
            kept = points
        rows = tuple(_matrix_rows(each) for each in maps)
        count = _depth(depth)
        self._set(_native.ifs(kind, points, radius, rows, count), (kept, rows, count))


@final
class Menger(Object):
    """The sponge of Menger in the cube from -1 to 1, `depth` times refined (0 to 20)."""

    __slots__ = ()

    def __init__(self, depth: int) -> None:
        count = _depth(depth)
        self._set(_native.menger(count), (count,))


@final
class Sierpinski(Object):
    """The tetrahedron of Sierpinski with the corners (1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1): 4**depth tetrahedra (0 to 20)."""

    __slots__ = ()

    def __init__(self, depth: int) -> None:
        count = _depth(depth)
        self._set(_native.sierpinski(count), (count,))


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


@final
class Mesh(Object):
    """Triangles over shared vertices.

    Parameters
    ----------
    vertices : array (n, 3)
        float64; others are converted.
    faces : array (m, 3)
        Whole numbers, the vertices of each face. Its normal is ``cross(v1 - v0, v2 - v0)``.
    normals, normal_faces : arrays (k, 3) and (m, 3), optional
        Normals for shading, and those of each face; without `normal_faces` they go with the vertices.
    uv, uv_faces : arrays (k, 2) and (m, 3), optional
        Texture coordinates, likewise.
    solid : bool, optional
        Whether the mesh bounds a solid (for `spans`, `contains` and solids of solids). By default that of a closed mesh.

    Faces without area, or with a vertex that is not finite, keep their numbers and are never hit.

    Examples
    --------
    >>> import durer
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> mesh = durer.Mesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> mesh
    <Mesh of 4 vertices and 4 faces, a solid>
    """

    __slots__ = ("_is_solid",)
    _is_solid: bool

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        normals: npt.ArrayLike | None = None,
        normal_faces: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        uv_faces: npt.ArrayLike | None = None,
        solid: bool | None = None,
    ) -> None:
        points, corners = table(vertices, 3, "vertices"), index_table(faces, "faces")
        shading = None if normals is None else table(normals, 3, "normals")
        texture = None if uv is None else table(uv, 2, "uv")
        lists: list[Ints | None] = []
        for name, values, given in (("normals", shading, normal_faces), ("uv", texture, uv_faces)):
            if values is None:
                if given is not None:
                    raise ValueError(f"mesh: {name} are missing")
                lists.append(None)
                continue
            if given is None and len(values) != len(points):
                raise ValueError(f"mesh: {len(values)} {name} for {len(points)} vertices")
            of_faces = corners if given is None else index_table(given, f"{name} of faces")
            if len(of_faces) != len(corners):
                raise ValueError(f"mesh: {name} of {len(of_faces)} faces for {len(corners)} faces")
            lists.append(of_faces)
        arguments = (points, corners, shading, lists[0], texture, lists[1])
        native, is_solid = _native.mesh(*arguments, solid)
        # What is kept cannot be changed by others.
        kept = [None if a is None else a.copy() for a in arguments]
        read_only(kept)
        self._set(native, (*kept, is_solid))
        object.__setattr__(self, "_is_solid", is_solid)

    @property
    def vertices(self) -> Floats:
        """The vertices, shape (n, 3); read only."""
        vertices: Floats = self._arguments[0]
        return vertices

    @property
    def faces(self) -> Ints:
        """The vertices of each face, shape (m, 3); read only."""
        faces: Ints = self._arguments[1]
        return faces

    @property
    def is_solid(self) -> bool:
        """Whether the mesh bounds a solid."""
        return self._is_solid

    def __repr__(self) -> str:
        kind = "a solid" if self._is_solid else "a sheet"
        return f"<Mesh of {len(self.vertices)} vertices and {len(self.faces)} faces, {kind}>"


def read_mesh(path: str | os.PathLike[str], solid: bool | None = None) -> Object:
    """The mesh in an .obj, .ply, .stl, .gltf or .glb file: a `Mesh`, or a `Union` of placed ones where the file has several.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it cannot be read; it says where.
    """
    if not os.path.exists(path):
        raise FileNotFoundError(f"there is no file {os.fspath(path)!r}")
    groups, placements, _ = _native.read_mesh(os.fspath(path))
    meshes = []
    for _, vertices, faces, normals, uv in groups:
        n, n_faces = normals or (None, None)
        t, t_faces = uv or (None, None)
        meshes.append(Mesh(vertices, faces, n, n_faces, t, t_faces, solid))
    identity = np.eye(3, 4).tolist()
    objects = [
        meshes[group] if rows == identity else meshes[group].placed(rows) for group, rows in placements
    ]
    return objects[0] if len(objects) == 1 else Union(*objects)


@final
class Placed(Object):
    """An object, moved by an affine map; made by `Object.placed`, `translated`, `scaled` and `rotated`."""

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
    """The solid of what is in any of some solids, without surfaces inside: ``a | b``."""

    __slots__ = ()
    _operation = "merge"


@final
class Intersection(_Combined):
    """The solid of what is in all of some solids: ``a & b``."""

    __slots__ = ()
    _operation = "intersection"


@final
class Difference(_Combined):
    """The solid of what is in the first and in none of the others: ``a - b``."""

    __slots__ = ()
    _operation = "difference"


@final
class Union(Object):
    """Surfaces together as one object, each with its look; what lies inside is kept."""

    __slots__ = ()

    def __init__(self, *objects: Object) -> None:
        _objects(objects)
        self._set(_native.union([item._native for item in objects]), objects)


@final
class Complement(Object):
    """A solid with inside and outside exchanged: ``~a``."""

    __slots__ = ()

    def __init__(self, object: Object) -> None:
        self._set(_native.complement(object._native), (object,))

    def __repr__(self) -> str:
        return f"~{self._arguments[0]!r}"


@final
class WithoutCaps(Object):
    """A surface without the flat ends that close it; made by `Object.without_caps`."""

    __slots__ = ()

    def __init__(self, object: Object) -> None:
        self._set(_native.without_caps(object._native), (object,))

    def __repr__(self) -> str:
        return f"{self._arguments[0]!r}.without_caps()"


@final
class Clipped(Object):
    """The part of a surface that lies in some convex solids; made by `Object.clipped`."""

    __slots__ = ()

    def __init__(self, object: Object, solids: Sequence[Object]) -> None:
        _objects(solids)
        native = _native.clipped(object._native, [solid._native for solid in solids])
        self._set(native, (object, tuple(solids)))

    def __repr__(self) -> str:
        return f"{self._arguments[0]!r}.clipped({', '.join(map(repr, self._arguments[1]))})"


@final
class Deformed(Object):
    """A solid, deformed; made by `Object.twisted`, `tapered` and `bent`."""

    __slots__ = ()

    def __init__(self, object: Object, warps: Sequence[tuple[str, Vector, float, tuple[float, float], Vector]]) -> None:
        native = _native.deformed(object._native, list(warps))
        self._set(native, (object, tuple(warps)))


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
    """An object with a look; made by `Object.with_texture`."""

    __slots__ = ()

    def __init__(self, object: Object, texture: Texture) -> None:
        self._set(_native.with_texture(object._native, texture), (object, texture))

    def __repr__(self) -> str:
        return f"{self._arguments[0]!r}.with_texture({self._arguments[1]!r})"
