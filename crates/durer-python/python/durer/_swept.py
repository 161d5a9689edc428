"""Outlines and profiles that are swept along lines and turned about axes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import final

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import number, real_array, row_tuples, vector
from ._objects import Object


@final
class Prism(Object):
    """Closed outlines, arrays (n, 2) of x and z, swept along y between two heights.

    `spline` says how an outline goes through its points: "linear", "quadratic", "cubic" or "bezier". A conic prism is y
    times as large at the height y.

    Examples
    --------
    >>> import durer
    >>> wedge = durer.Prism([[[0, 0], [2, 0], [0, 2]]], (0, 1))
    >>> durer.Scene([wedge]).all([[0.5, 0.5, -3]], [[0, 0, 1]]).t
    array([3. , 4.5])
    """

    __slots__ = ()

    def __init__(
        self,
        outlines: Iterable[npt.ArrayLike],
        heights: npt.ArrayLike,
        spline: str = "linear",
        conic: bool = False,
    ) -> None:
        loops = tuple(row_tuples(outline, 2, "outlines") for outline in outlines)
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

    Examples
    --------
    >>> import durer
    >>> bar = durer.Sweep([[[0, 0], [1, 0], [1, 1], [0, 1]]], [[0, 0, 0], [0, 0, 5]])
    >>> durer.Scene([bar]).all([[0.5, 0.5, -3]], [[0, 0, 1]]).t
    array([3., 8.])
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
        loops = tuple(row_tuples(outline, 2, "outlines") for outline in outlines)
        points = row_tuples(path, 3, "path")
        given = np.ones(len(points)) if sizes is None else real_array(sizes, "sizes")
        if given.shape != (len(points),):
            raise ValueError(f"sizes: shape ({len(points)},) is needed, got {given.shape}")
        side = None if up is None else vector(up, "up")
        all_sizes = tuple(float(size) for size in given)
        arguments = (loops, points, all_sizes, side, str(spline), str(path_spline), number(twist, "twist"))
        self._set(_native.sweep(*arguments), arguments)


@final
class Capsule(Object):
    """All points within `radius` of the line from `base` to `cap`.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Capsule((0, 0, 0), (4, 0, 0), 1)]).all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([ 4., 10.])
    """

    __slots__ = ()

    def __init__(self, base: npt.ArrayLike, cap: npt.ArrayLike, radius: float) -> None:
        arguments = (vector(base, "base"), vector(cap, "cap"), float(radius))
        if not arguments[2] > 0.0:
            raise ValueError(f"capsule: the radius must be finite and positive, got {arguments[2]}")
        ends = tuple((*end, arguments[2]) for end in arguments[:2])
        self._set(_native.sphere_sweep(ends, "linear"), arguments)


@final
class SphereSweep(Object):
    """All balls whose centres and radii follow a spline of `spheres`, an array (n, 4) of x, y, z and radius.

    `spline` is "linear", "b" (the uniform cubic B-spline, which passes near its control points) or "cubic" (through all
    spheres but the first and the last, which only tell slopes).

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.SphereSweep([[0, 0, 0, 1], [4, 0, 0, 1]])]).all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([ 4., 10.])
    """

    __slots__ = ()

    def __init__(self, spheres: npt.ArrayLike, spline: str = "linear") -> None:
        arguments = (row_tuples(spheres, 4, "spheres"), str(spline))
        self._set(_native.sphere_sweep(*arguments), arguments)


@final
class SurfaceOfRevolution(Object):
    """A smooth curve through points (n, 2), a radius and a height each, turned about the y axis; the first and the last only tell slopes.

    Examples
    --------
    >>> import durer
    >>> vase = durer.SurfaceOfRevolution([[1, -1], [1, 0], [1.5, 1], [1, 2], [1, 3]])
    >>> durer.Scene([vase]).all([[-5, 1, 0]], [[1, 0, 0]]).t
    array([3.5, 6.5])
    """

    __slots__ = ()

    def __init__(self, points: npt.ArrayLike) -> None:
        arguments = (row_tuples(points, 2, "points"),)
        self._set(_native.surface_of_revolution(*arguments), arguments)


@final
class Lathe(Object):
    """A profile through points (n, 2), a radius and a height each, turned about the y axis.

    `spline` says how it goes through its points: "linear", "quadratic" (the first point only tells a slope), "cubic"
    (the first and the last one do) or "bezier" (four points for each piece). Closed, or with both ends on the axis, it
    is a solid.

    Examples
    --------
    >>> import durer
    >>> cup = durer.Lathe([[0, 0], [1, 0], [1, 2]])
    >>> durer.Scene([cup]).all([[-5, 1, 0]], [[1, 0, 0]]).t
    array([4., 6.])
    """

    __slots__ = ()

    def __init__(self, points: npt.ArrayLike, spline: str = "linear") -> None:
        arguments = (row_tuples(points, 2, "points"), str(spline))
        self._set(_native.lathe(*arguments), arguments)


@final
class Ovus(Object):
    """An egg about the y axis: a sphere about the origin and one about the point `bottom` above it, with these radii.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Ovus(1, 0.5)]).closest([[0, -5, 0]], [[0, 1, 0]]).t
    array([4.])
    """

    __slots__ = ()

    def __init__(self, bottom: float, top: float) -> None:
        arguments = (number(bottom, "bottom"), number(top, "top"))
        self._set(_native.ovus(*arguments), arguments)


@final
class Lemon(Object):
    """A spindle between two points with a radius at each; the arc between them has the inner radius.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Lemon((0, -1, 0), 0, (0, 1, 0), 0, 2)]).all([[-5, 0, 0]], [[1, 0, 0]]).counts
    array([2])
    """

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
    """The part of a ball within an angle (radians) of an axis through its centre.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.SphericalSector((0, 0, 0), 2, (0, 0, 1), 0.5)]).all([[0, 0, 5]], [[0, 0, -1]]).t
    array([3., 5.])
    """

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
