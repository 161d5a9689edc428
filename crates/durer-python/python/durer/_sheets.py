"""Fields of heights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy.typing as npt

from . import _native
from ._arrays import number, real_array
from ._objects import Object


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
