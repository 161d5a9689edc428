"""Flat surfaces, quadrics, tori and polynomials."""

from __future__ import annotations

from collections.abc import Iterable
from typing import final

import numpy.typing as npt

from . import _native
from ._arrays import number, real_array, row_tuples, vector
from ._objects import Object


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
    """An axis-aligned box between two opposite corners.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Box((0, 0, 0), (1, 2, 3))]).all([[0.5, 0.5, -1]], [[0, 0, 1]]).t
    array([1., 4.])
    """

    __slots__ = ()

    def __init__(self, a: npt.ArrayLike, b: npt.ArrayLike) -> None:
        arguments = (vector(a, "a"), vector(b, "b"))
        self._set(_native.axis_box(*arguments), arguments)


@final
class Cylinder(Object):
    """A closed circular cylinder between the middles of its ends.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Cylinder((0, 0, 0), (0, 0, 2), 1)]).all([[-5, 0, 1]], [[1, 0, 0]]).t
    array([4., 6.])
    """

    __slots__ = ()

    def __init__(self, base: npt.ArrayLike, cap: npt.ArrayLike, radius: float) -> None:
        arguments = (vector(base, "base"), vector(cap, "cap"), number(radius, "radius"))
        self._set(_native.cylinder(*arguments), arguments)


@final
class Cone(Object):
    """A closed circular cone or frustum between the middles of its ends, with a radius at each.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Cone((0, 0, 0), 1, (0, 0, 2))]).all([[-5, 0, 1]], [[1, 0, 0]]).t
    array([4.5, 5.5])
    """

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
    """The points p with ``p . normal == distance * |normal|``; a solid whose inside is behind the normal.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Plane((0, 0, 2), 1)]).closest([[0, 0, 5]], [[0, 0, -1]]).t
    array([4.])
    """

    __slots__ = ()

    def __init__(self, normal: npt.ArrayLike, distance: float = 0.0) -> None:
        arguments = (vector(normal, "normal"), number(distance, "distance"))
        self._set(_native.plane(*arguments), arguments)


@final
class Disc(Object):
    """A flat disc; with a hole if `hole`, its radius, is positive.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Disc((0, 0, 0), (0, 0, 1), 2, hole=1)]).any([[0, 0, 5], [1.5, 0, 5]], [[0, 0, -1], [0, 0, -1]])
    array([False,  True])
    """

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
    """The points ``corner + a u + b v`` with a and b from 0 to 1.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Parallelogram((0, 0, 0), (2, 0, 0), (0, 2, 0))]).closest([[1, 0.5, 3]], [[0, 0, -1]]).uv
    array([[0.5 , 0.25]])
    """

    __slots__ = ()

    def __init__(self, corner: npt.ArrayLike, u: npt.ArrayLike, v: npt.ArrayLike) -> None:
        arguments = (vector(corner, "corner"), vector(u, "u"), vector(v, "v"))
        self._set(_native.parallelogram(*arguments), arguments)


@final
class Triangle(Object):
    """A triangle by its vertices (3, 3), with normals for shading at them if they are given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Triangle([[0, 0, 0], [1, 0, 0], [0, 1, 0]])]).closest([[0.25, 0.5, 2]], [[0, 0, -1]]).parameters
    array([[0.25, 0.5 ]])
    """

    __slots__ = ()

    def __init__(self, vertices: npt.ArrayLike, normals: npt.ArrayLike | None = None) -> None:
        corners = row_tuples(vertices, 3, "vertices")
        shading = None if normals is None else row_tuples(normals, 3, "normals")
        for name, rows in (("vertices", corners), ("normals", shading)):
            if rows is not None and len(rows) != 3:
                raise ValueError(f"{name}: shape (3, 3) is needed, got ({len(rows)}, 3)")
        self._set(_native.triangle(corners, shading), (corners, shading))


@final
class Polygon(Object):
    """A plane polygon: one or more loops of points (n, 3). Inside is what they go round an odd number of times, or any.

    Examples
    --------
    >>> import durer
    >>> frame = durer.Polygon([[[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]], [[1, 1, 0], [3, 1, 0], [3, 3, 0], [1, 3, 0]]])
    >>> durer.Scene([frame]).any([[2, 2, 5], [0.5, 2, 5]], [[0, 0, -1], [0, 0, -1]])
    array([False,  True])
    """

    __slots__ = ()

    def __init__(self, loops: Iterable[npt.ArrayLike], even_odd: bool = True) -> None:
        outlines = tuple(row_tuples(loop, 3, "loops") for loop in loops)
        self._set(_native.polygon(outlines, bool(even_odd)), (outlines, bool(even_odd)))


@final
class Quadric(Object):
    """``A x^2 + B y^2 + C z^2 + D xy + E xz + F yz + G x + H y + I z + J = 0``: the ten coefficients in this order.

    Examples
    --------
    >>> import durer
    >>> ball = durer.Quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -4])
    >>> durer.Scene([ball]).all([[0, 0, 5]], [[0, 0, -1]]).t
    array([3., 7.])
    """

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
    """``x^2/a^2 + y^2/b^2 + z^2/c^2 = 1`` with semi-axes (a, b, c), or its part between two planes ``z = extent``.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Ellipsoid((1, 2, 3))]).all([[0, 0, 5]], [[0, 0, -1]]).t
    array([2., 8.])
    """

    __slots__ = ()
    _kind = "ellipsoid"


@final
class EllipticParaboloid(_Named):
    """``x^2/a^2 + y^2/b^2 = z/c``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.EllipticParaboloid((1, 2, 1))]).closest([[0, 0, -3]], [[0, 0, 1]]).t
    array([3.])
    """

    __slots__ = ()
    _kind = "elliptic_paraboloid"


@final
class HyperbolicParaboloid(_Named):
    """``x^2/a^2 - y^2/b^2 = z/c``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.HyperbolicParaboloid((1, 1, 1))]).all([[1, 0, 5]], [[0, 0, -1]]).t
    array([4.])
    """

    __slots__ = ()
    _kind = "hyperbolic_paraboloid"


@final
class HyperboloidOneSheet(_Named):
    """``x^2/a^2 + y^2/b^2 - z^2/c^2 = 1``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.HyperboloidOneSheet((1, 2, 3))]).all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([4., 6.])
    """

    __slots__ = ()
    _kind = "hyperboloid_one_sheet"


@final
class HyperboloidTwoSheets(_Named):
    """``z^2/c^2 - x^2/a^2 - y^2/b^2 = 1``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.HyperboloidTwoSheets((1, 2, 3))]).all([[0, 0, -5]], [[0, 0, 1]]).t
    array([2., 8.])
    """

    __slots__ = ()
    _kind = "hyperboloid_two_sheets"


@final
class EllipticCone(_Named):
    """``x^2/a^2 + y^2/b^2 = z^2/c^2``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.EllipticCone((1, 2, 1), (0, 2))]).all([[-5, 0, 1]], [[1, 0, 0]]).t
    array([4., 6.])
    """

    __slots__ = ()
    _kind = "elliptic_cone"


@final
class EllipticCylinder(_Named):
    """``x^2/a^2 + y^2/b^2 = 1``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.EllipticCylinder((1, 2, 1))]).all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([4., 6.])
    """

    __slots__ = ()
    _kind = "elliptic_cylinder"


@final
class HyperbolicCylinder(_Named):
    """``x^2/a^2 - y^2/b^2 = 1``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.HyperbolicCylinder((1, 2, 1))]).all([[-5, 0, 0]], [[1, 0, 0]]).t
    array([4., 6.])
    """

    __slots__ = ()
    _kind = "hyperbolic_cylinder"


@final
class ParabolicCylinder(_Named):
    """``x^2/a^2 = y/b``, cut at ``z = extent`` if that is given.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.ParabolicCylinder((1, 1, 1))]).all([[2, 0, 0]], [[0, 1, 0]]).t
    array([4.])
    """

    __slots__ = ()
    _kind = "parabolic_cylinder"


@final
class Polynomial(Object):
    """The zero set of a polynomial of an order up to 35; its coefficients by falling powers of x, then of y, then of z.

    Examples
    --------
    >>> import durer
    >>> saddle = durer.Polynomial(2, [1, 0, 0, 0, -1, 0, 0, 0, -1, 0])
    >>> durer.Scene([saddle]).all([[2, 0, 9]], [[0, 0, -1]]).t
    array([5.])
    """

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
    """A Dupin cyclide: swept by a sphere of mean radius d whose centre goes round an ellipse in the xz plane, of semi-axis a along x and foci at distance c.

    Examples
    --------
    >>> import durer
    >>> durer.Scene([durer.Cyclide(3, 1, 1.5)]).all([[-9, 0, 0]], [[1, 0, 0]]).counts
    array([4])
    """

    __slots__ = ()

    def __init__(self, a: float, c: float, d: float) -> None:
        arguments = (number(a, "a"), number(c, "c"), number(d, "d"))
        self._set(_native.cyclide(*arguments), arguments)
