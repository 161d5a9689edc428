"""Cameras that make arrays of rays."""

from __future__ import annotations

import math
from typing import Any, final

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import Camera as NativeCamera
from ._arrays import Floats, Vector, number, vector


@final
class Camera:
    """A camera: where it stands, what it looks at, and the size of its picture in pixels.

    Parameters
    ----------
    location, target : three numbers
        The target is seen in the middle.
    up : three numbers
        What is up in the picture.
    field_of_view : float
        The horizontal angle that is seen, in radians, below pi.
    width, height : int
        Columns and rows of pixels.
    orthographic : float, optional
        The width of what is seen, in units of the scene: all rays are parallel then.

    The camera is right-handed: nothing is mirrored. A perspective camera's directions reach a plane at distance 1, so
    that `t` of a hit is its depth along the view; an orthographic one's have length 1.

    Examples
    --------
    >>> import durer
    >>> camera = durer.Camera((0, 0, 5), (0, 0, 0), width=4, height=2)
    >>> camera
    Camera((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), width=4, height=2)
    >>> camera.rays().shape
    (8, 6)
    """

    __slots__ = ("_native", "_arguments", "_size")
    _native: NativeCamera
    _arguments: tuple[Any, ...]
    _size: tuple[int, int]

    def __init__(
        self,
        location: npt.ArrayLike,
        target: npt.ArrayLike,
        up: npt.ArrayLike = (0.0, 1.0, 0.0),
        field_of_view: float = 1.0,
        width: int = 640,
        height: int = 480,
        orthographic: float | None = None,
    ) -> None:
        eye, aim, top = vector(location, "location"), vector(target, "target"), vector(up, "up")
        forward = _unit(np.subtract(aim, eye), "the target must not be at the location")
        right = _unit(np.cross(forward, top), "up must not be along the view")
        above = np.cross(right, forward)
        columns, rows = int(width), int(height)
        if columns < 1 or rows < 1:
            raise ValueError(f"width and height: at least 1 is needed, got {width} and {height}")
        angle = number(field_of_view, "field_of_view")
        if not 0.0 < angle < math.pi:
            raise ValueError(f"field_of_view: an angle between 0 and pi is needed, got {angle}")
        wide = 2.0 * math.tan(angle / 2) if orthographic is None else number(orthographic, "orthographic")
        if not 0.0 < wide < math.inf:
            raise ValueError(f"orthographic: a positive width is needed, got {wide}")
        native = _native.Camera(
            eye,
            tuple(forward.tolist()),
            tuple((right * wide).tolist()),
            tuple((above * (wide * rows / columns)).tolist()),
            orthographic is not None,
        )
        arguments = (eye, aim, top, angle, columns, rows, None if orthographic is None else wide)
        self._set(native, arguments, (columns, rows))

    def _set(self, native: NativeCamera, arguments: tuple[Any, ...], size: tuple[int, int]) -> None:
        object.__setattr__(self, "_native", native)
        object.__setattr__(self, "_arguments", arguments)
        object.__setattr__(self, "_size", size)

    @classmethod
    def from_vectors(
        cls,
        location: npt.ArrayLike,
        direction: npt.ArrayLike,
        right: npt.ArrayLike,
        up: npt.ArrayLike,
        width: int = 640,
        height: int = 480,
        orthographic: bool = False,
    ) -> Camera:
        """The camera of POV-Ray's vectors: `right` and `up` span the whole picture, whose middle is seen along `direction`."""
        vectors = (
            vector(location, "location"),
            vector(direction, "direction"),
            vector(right, "right"),
            vector(up, "up"),
        )
        camera = cls.__new__(cls)
        native = _native.Camera(*vectors, bool(orthographic))
        camera._set(native, (*vectors, int(width), int(height), bool(orthographic), "vectors"), (int(width), int(height)))
        return camera

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("Camera objects cannot be changed")

    def __reduce__(self) -> tuple[Any, ...]:
        if self._arguments[-1] == "vectors":
            return (Camera.from_vectors, self._arguments[:-1])
        return (Camera, self._arguments)

    @property
    def width(self) -> int:
        """Columns of pixels."""
        return self._size[0]

    @property
    def height(self) -> int:
        """Rows of pixels."""
        return self._size[1]

    @property
    def location(self) -> Vector:
        """Where it stands."""
        return tuple(self._native.location)  # type: ignore[return-value]

    @property
    def direction(self) -> Vector:
        """To the middle of the picture."""
        return tuple(self._native.direction)  # type: ignore[return-value]

    @property
    def right(self) -> Vector:
        """Across the whole picture, from left to right."""
        return tuple(self._native.right)  # type: ignore[return-value]

    @property
    def up(self) -> Vector:
        """Along the whole picture, from bottom to top."""
        return tuple(self._native.up)  # type: ignore[return-value]

    def sized(self, width: int, height: int) -> Camera:
        """The same view in another number of pixels."""
        own = self._native
        return Camera.from_vectors(
            own.location, own.direction, own.right, own.up, width, height, own.is_orthographic
        )

    def rays(self) -> Floats:
        """The rays through the middles of all pixels, row by row from the top: float64 (height * width, 6)."""
        return self._native.rays(*self._size)

    def __repr__(self) -> str:
        if self._arguments[-1] == "vectors":
            *vectors, width, height, orthographic, _ = self._arguments
            rest = f"width={width}, height={height}" + (", orthographic=True" if orthographic else "")
            return f"Camera.from_vectors({', '.join(map(repr, vectors))}, {rest})"
        eye, aim, top, angle, width, height, wide = self._arguments
        parts = [repr(eye), repr(aim)]
        if top != (0.0, 1.0, 0.0):
            parts.append(f"up={top!r}")
        if wide is not None:
            parts.append(f"orthographic={wide!r}")
        elif angle != 1.0:
            parts.append(f"field_of_view={angle!r}")
        return f"Camera({', '.join(parts)}, width={width}, height={height})"


def _unit(v: Floats, message: str) -> Floats:
    length = float(np.linalg.norm(v))
    if not 0.0 < length < math.inf:
        raise ValueError(f"camera: {message}")
    unit: Floats = v / length
    return unit
